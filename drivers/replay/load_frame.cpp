#include "replay/load_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gfp/frame/png.hpp"
#include "replay/fakenect.hpp"
#include "replay/fit_pinhole.hpp"
#include "replay/pcd.hpp"
#include "replay/pclzf.hpp"

namespace gfp {
namespace {

constexpr double kFinestScale_m = 1e-4;
constexpr int kCoarsestScale = 10;  // times the finest

tl::unexpected<Error> pass_on(const Error& error) { return tl::unexpected<Error>(error); }

Result<double> checked_scale(double scale_m, const std::filesystem::path& file) {
  if (scale_m >= 1e-6 && scale_m <= 1.0) return scale_m;
  return failure(ErrorCode::kInvalidArgument, fmt::format("{}: depth_scale = {} m, expected [1e-6, 1]", file.string(), scale_m));
}

Result<double> depth_scale(const ReplayOptions& options, double from_file, const std::filesystem::path& file) {
  if (options.depth_scale_m) return checked_scale(*options.depth_scale_m, file);
  if (options.camera && options.camera->depth_scale_m) return checked_scale(*options.camera->depth_scale_m, file);
  return checked_scale(from_file, file);
}

/// A colour image is extra: what is wrong with it is said, and the depth is used without it.
void add_color(LoadedFrame& loaded, Result<Image<Rgb8>> color) {
  const Image<std::uint16_t>& depth = loaded.frame.depth.pixels;
  if (!color) {
    loaded.report.notes.push_back("no colour: " + color.error().what);
  } else if (color->width != depth.width || color->height != depth.height) {
    loaded.report.notes.push_back(fmt::format("no colour: its image is {} x {}, the depth's {} x {}", color->width, color->height, depth.width, depth.height));
  } else {
    loaded.frame.color = std::move(*color);
  }
}

/// The camera of the options, of the recording, or the assumed one, in this order.
Result<void> choose_camera(LoadedFrame& loaded, const ReplayOptions& options, const std::optional<CameraModel>& recorded) {
  const Image<std::uint16_t>& depth = loaded.frame.depth.pixels;
  const CameraModel assumed = default_kinect_camera(depth.width, depth.height);
  loaded.report.camera_origin = options.camera ? CameraOrigin::kGiven : recorded ? CameraOrigin::kFile : CameraOrigin::kAssumed;
  Result<CameraModel> camera = camera_for_image(options.camera ? options.camera->camera : recorded.value_or(assumed), depth.width, depth.height);
  if (!camera) return failure(camera.error().code, fmt::format("{}: {}", loaded.report.file.string(), camera.error().what));
  loaded.frame.camera = std::move(*camera);
  if (loaded.report.camera_origin == CameraOrigin::kAssumed)
    loaded.report.notes.push_back(fmt::format("no camera is given: assuming a Kinect with f = {} px", assumed.fx));
  return {};
}

Result<void> load_pclzf(const ReplayEntry& entry, const ReplayOptions& options, LoadedFrame& loaded) {
  Result<Image<std::uint16_t>> depth = read_pclzf_depth(entry.depth);
  if (!depth) return pass_on(depth.error());
  loaded.frame.depth.pixels = std::move(*depth);
  std::optional<CameraModel> recorded;
  double recorded_scale_m = entry.depth_scale_m;
  if (!entry.calibration.empty()) {
    const Result<PclzfCalibration> calibration = read_pclzf_calibration(entry.calibration);
    if (!calibration) return pass_on(calibration.error());
    recorded = calibration->camera;
    recorded_scale_m = calibration->depth_scale_m;
  }
  const Result<double> scale = depth_scale(options, recorded_scale_m, entry.calibration.empty() ? entry.depth : entry.calibration);
  if (!scale) return pass_on(scale.error());
  loaded.frame.depth.scale_m = *scale;
  if (!entry.color.empty()) add_color(loaded, read_pclzf_color(entry.color));
  return choose_camera(loaded, options, recorded);
}

Result<void> load_png(const ReplayEntry& entry, const ReplayOptions& options, LoadedFrame& loaded) {
  const Result<double> scale = depth_scale(options, entry.depth_scale_m, entry.depth);
  if (!scale) return pass_on(scale.error());
  Result<Image<std::uint16_t>> depth = read_png_depth(entry.depth);
  if (!depth) return pass_on(depth.error());
  loaded.frame.depth = {std::move(*depth), *scale};
  if (!entry.color.empty()) add_color(loaded, read_png_color(entry.color));
  return choose_camera(loaded, options, std::nullopt);
}

/// Kept unregistered, as the Kinect saw it: depth from its infrared camera, colour from the other one.
Result<void> load_fakenect(const ReplayEntry& entry, const ReplayOptions& options, LoadedFrame& loaded) {
  static const KinectDepthTable kTable = kinect_depth_table();
  const Result<Image<std::uint16_t>> raw = read_fakenect_raw(entry.depth);
  if (!raw) return pass_on(raw.error());
  loaded.frame.depth = depth_of_raw(*raw, kTable);
  if (!entry.color.empty()) add_color(loaded, read_fakenect_color(entry.color));
  return choose_camera(loaded, options, std::nullopt);
}

std::vector<float> forward_column(const PcdCloud& cloud, const Axes& axes) {
  std::vector<float> z = cloud.xyz[static_cast<std::size_t>(axes.index[2])];
  if (axes.sign[2] < 0)
    for (float& value : z) value = -value;
  return z;
}

void note_oddities(const PcdCloud& cloud, const Axes& axes, FrameReport& report) {
  report.axes = to_string(axes);
  if (axes.left_handed()) report.notes.push_back(fmt::format("axes {} are left-handed: the cloud is a mirror image", report.axes));
  else if (axes != Axes{}) report.notes.push_back(fmt::format("axes {} were turned into the optical frame", report.axes));
  if (cloud.viewpoint != "0 0 0 1 0 0 0" && !cloud.viewpoint.empty())
    report.notes.push_back(fmt::format("VIEWPOINT {} is not applied: the points are the camera's own", cloud.viewpoint));
}

Result<void> load_pcd(const ReplayEntry& entry, const ReplayOptions& options, LoadedFrame& loaded) {
  Result<PcdCloud> cloud = read_pcd(entry.depth);
  if (!cloud) return pass_on(cloud.error());
  std::optional<Axes> axes;
  if (!options.axes.empty()) {
    const Result<Axes> given = parse_axes(options.axes);
    if (!given) return pass_on(given.error());
    axes = *given;
  }
  if (options.camera) {
    const Result<CameraModel> camera = camera_for_image(options.camera->camera, cloud->width, cloud->height);
    if (!camera) return failure(camera.error().code, fmt::format("{}: {}", entry.depth.string(), camera.error().what));
    loaded.frame.camera = *camera;
    loaded.report.camera_origin = CameraOrigin::kGiven;
  }
  if (!options.camera || !axes) {
    const Result<PinholeFit> fit = fit_pinhole(*cloud, axes, entry.depth.string());
    if (!fit && !options.camera) return pass_on(fit.error());  // with a camera, the fit is only asked for the axes
    if (fit) axes = fit->axes, loaded.report.pinhole_rms_px = fit->rms_px;
    if (!options.camera) loaded.frame.camera = fit->camera, loaded.report.camera_origin = CameraOrigin::kFitted;
  }
  note_oddities(*cloud, axes.value_or(Axes{}), loaded.report);
  loaded.frame.depth = quantise_depth(cloud->width, cloud->height, forward_column(*cloud, axes.value_or(Axes{})));
  loaded.frame.color = std::move(cloud->color);
  return {};
}

}  // namespace

std::string_view to_string(CameraOrigin origin) {
  switch (origin) {
    case CameraOrigin::kGiven: return "given";
    case CameraOrigin::kFile: return "file";
    case CameraOrigin::kFitted: return "fitted";
    case CameraOrigin::kAssumed: return "assumed";
  }
  return "unknown";
}

DepthImage quantise_depth(int width, int height, const std::vector<float>& z_m) {
  const auto is_reading = [](float z) { return z > 0 && z <= 65535 * kFinestScale_m * kCoarsestScale; };
  float farthest = 0;
  for (const float z : z_m)
    if (is_reading(z)) farthest = std::max(farthest, z);
  const int coarseness = std::clamp(static_cast<int>(std::ceil(farthest / (65535 * kFinestScale_m))), 1, kCoarsestScale);
  DepthImage depth{Image<std::uint16_t>(width, height), kFinestScale_m * coarseness};
  const double units_per_m = 1.0 / depth.scale_m;
  for (std::size_t i = 0; i < z_m.size(); ++i)
    if (is_reading(z_m[i])) depth.pixels.pixels[i] = static_cast<std::uint16_t>(std::min(65535.0, std::floor(z_m[i] * units_per_m + 0.5)));
  return depth;
}

Result<LoadedFrame> load_frame(const ReplayEntry& entry, const ReplayOptions& options) {
  LoadedFrame loaded;
  loaded.report.file = entry.depth;
  loaded.frame.sensor = options.sensor;
  loaded.frame.noise = options.noise;
  if (options.camera) loaded.frame.T_world_sensor = options.camera->T_world_sensor;
  const Result<void> read = entry.format == ReplayFormat::kPcd     ? load_pcd(entry, options, loaded)
                            : entry.format == ReplayFormat::kPclzf ? load_pclzf(entry, options, loaded)
                            : entry.format == ReplayFormat::kPng   ? load_png(entry, options, loaded)
                                                                   : load_fakenect(entry, options, loaded);
  if (!read) return pass_on(read.error());
  return loaded;
}

}  // namespace gfp
