// gfp-calibrate, run as `gfp calibrate`: pictures of a chessboard to a stereo calibration, its error, and a picture that shows it.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/canvas.hpp"
#include "cli/chessboard.hpp"
#include "cli/exit_code.hpp"
#include "config/stereo_calibration_file.hpp"
#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/cloud/rectify_stereo.hpp"
#include "gfp/frame/jpeg.hpp"
#include "gfp/frame/png.hpp"

namespace gfp {
namespace {

struct Arguments {
  std::vector<std::string> left, right;
  std::string board = "9x6", out = "calibration.yaml", png;
  double square_m = 0;
  bool json = false;
};

Result<Image<std::uint8_t>> read_grey(const std::string& file) {
  std::string end = std::filesystem::path(file).extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end == ".jpg" || end == ".jpeg") return read_jpeg_grey(file);
  const auto color = read_png_color(file);
  if (!color) return tl::unexpected<Error>(color.error());
  Image<std::uint8_t> grey(color->width, color->height);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) grey.pixels[i] = static_cast<std::uint8_t>((color->pixels[i].r + 2 * color->pixels[i].g + color->pixels[i].b + 2) / 4);
  return grey;
}

Result<Chessboard> parse_board(const std::string& text, double square_m) {
  Chessboard board;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &board.columns, &board.rows, &rest) != 2 || std::min(board.columns, board.rows) < 3 || std::max(board.columns, board.rows) > 50)
    return failure(ErrorCode::kInvalidArgument, fmt::format("--board = {}, expected COLUMNSxROWS inner corners, 3 to 50 each", text));
  board.square_m = square_m;
  return board;
}

/// The board's corners as the rectified cameras see them: mean distance of their rows, pixels.
double row_error_px(const StereoRectifier& rectifier, const StereoCalibration& calibration, const std::vector<BoardView>& views) {
  double sum = 0;
  std::size_t count = 0;
  const RayTable left = ray_table(calibration.left), right = ray_table(calibration.right);
  const auto rectified = [&](const RayTable& rays, const Eigen::Matrix3d& rotation, const Eigen::Vector2f& corner) {
    // Between the rays of four pixels: a lens bends little over one.
    const int u = std::clamp(static_cast<int>(corner.x()), 0, rays.camera.width - 2), v = std::clamp(static_cast<int>(corner.y()), 0, rays.camera.height - 2);
    const double fu = corner.x() - u, fv = corner.y() - v;
    const auto at = [&](int du, int dv) {
      const auto i = static_cast<std::size_t>((v + dv) * rays.camera.width + u + du);
      return Eigen::Vector3d(rays.x[i], rays.y[i], 1);
    };
    const Eigen::Vector3d ray = (1 - fv) * ((1 - fu) * at(0, 0) + fu * at(1, 0)) + fv * ((1 - fu) * at(0, 1) + fu * at(1, 1));
    return rectifier.geometry().camera.project(rotation * ray);
  };
  for (const BoardView& view : views)
    for (std::size_t i = 0; i < view.left.size(); ++i, ++count)
      sum += std::abs(rectified(left, rectifier.rotation_left(), view.left[i]).y() - rectified(right, rectifier.rotation_right(), view.right[i]).y());
  return sum / static_cast<double>(std::max<std::size_t>(1, count));
}

/// Both rectified pictures side by side with common rows: what lies on a line left lies on it right.
Canvas draw(const StereoPair& pair) {
  const int width = pair.left.width, height = pair.left.height;
  Canvas canvas(2 * width, height, {0, 0, 0});
  const auto paste = [&](const Image<std::uint8_t>& grey, int u) {
    Image<Rgb8> color(grey.width, grey.height);
    for (std::size_t i = 0; i < grey.pixels.size(); ++i) color.pixels[i] = {grey.pixels[i], grey.pixels[i], grey.pixels[i]};
    canvas.paste(color, u, 0);
  };
  paste(pair.left, 0);
  paste(pair.right, width);
  for (int v = 16; v < height; v += 32) canvas.line({0, static_cast<double>(v)}, {2.0 * width, static_cast<double>(v)}, distinct_color(static_cast<std::uint64_t>(v / 32)), 1, 0.8);
  return canvas;
}

Result<nlohmann::json> calibrate(const Arguments& arguments) {
  if (arguments.left.size() != arguments.right.size())
    return failure(ErrorCode::kInvalidArgument, fmt::format("left pictures = {}, right pictures = {}, expected as many", arguments.left.size(), arguments.right.size()));
  const auto board = parse_board(arguments.board, arguments.square_m);
  if (!board) return tl::unexpected<Error>(board.error());
  std::vector<BoardView> views;
  StereoPair shown;
  nlohmann::json without = nlohmann::json::array();
  for (std::size_t i = 0; i < arguments.left.size(); ++i) {
    auto left = read_grey(arguments.left[i]), right = read_grey(arguments.right[i]);
    if (!left) return tl::unexpected<Error>(left.error());
    if (!right) return tl::unexpected<Error>(right.error());
    if (left->width != right->width || left->height != right->height || (!shown.left.empty() && (left->width != shown.left.width || left->height != shown.left.height)))
      return failure(ErrorCode::kInvalidArgument, fmt::format("{} and {}: {} x {} and {} x {}, expected the same size of all pictures", arguments.left[i], arguments.right[i], left->width, left->height, right->width, right->height));
    BoardView view = find_board(*left, *right, *board);
    if (view.left.empty()) without.push_back(arguments.left[i]);
    else views.push_back(std::move(view));
    shown = {std::move(*left), std::move(*right), {}};
  }
  auto result = calibrate_stereo(views, *board, shown.left.width, shown.left.height);
  if (!result) return tl::unexpected<Error>(result.error());
  const auto rectifier = StereoRectifier::make(result->calibration);
  if (!rectifier) return tl::unexpected<Error>(rectifier.error());
  std::ofstream file(arguments.out);
  file << config::to_opencv_yaml(result->calibration);
  if (!file.flush()) return failure(ErrorCode::kIo, arguments.out + ": cannot be written");
  if (!arguments.png.empty())
    if (const auto written = write_png(arguments.png, draw(rectifier->rectify(shown).value()).image()); !written) return tl::unexpected<Error>(written.error());
  return nlohmann::json{{"pairs", views.size()}, {"without_board", without}, {"rms_px", result->rms_px}, {"row_error_px", row_error_px(*rectifier, result->calibration, views)},
                        {"baseline_m", result->calibration.baseline_m()}, {"focal_px", rectifier->geometry().camera.fx}, {"file", arguments.out}};
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Calibrates a stereo camera from pictures of a chessboard that both eyes see", "gfp calibrate"};
  app.add_option("--left", arguments.left, "Pictures of the left eye (JPEG, PNG), in order")->required();
  app.add_option("--right", arguments.right, "Those of the right eye, in the same order")->required();
  app.add_option("--board", arguments.board, "Inner corners, COLUMNSxROWS")->capture_default_str();
  app.add_option("--square", arguments.square_m, "Side of a square, metres")->required()->check(CLI::Range(1e-4, 1.0));
  app.add_option("--out", arguments.out, "Calibration to write (OpenCV's YAML)")->capture_default_str();
  app.add_option("--png", arguments.png, "Picture to write: the last pair rectified, with common rows");
  app.add_flag("--json", arguments.json, "One JSON document");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  const auto result = calibrate(arguments);
  ExitStatus status;
  if (!result) return status.fail(std::cerr, "calibrate", result.error()), status.code();
  if (arguments.json) std::cout << result->dump() << "\n";
  else
    std::cout << fmt::format("{} pairs, reprojection error {:.3f} px (RMS), rows {:.3f} px apart, baseline {:.4f} m, f {:.1f} px: {}\n", (*result)["pairs"].get<int>(), (*result)["rms_px"].get<double>(),
                             (*result)["row_error_px"].get<double>(), (*result)["baseline_m"].get<double>(), (*result)["focal_px"].get<double>(), arguments.out);
  return kExitOk;
}

}  // namespace
}  // namespace gfp

int main(int argc, char** argv) {
  try {
    return gfp::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "gfp: calibrate: " << error.what() << " (a bug: please report it)\n";
    return gfp::kExitSoftware;
  }
}
