#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "gfp/core/mesh_io.hpp"
#include "gfp/evaluation/cases.hpp"
#include "gfp/frame/png.hpp"
#include "gfp/frame/read_file.hpp"
#include "mesh_table.hpp"

namespace gfp {
namespace {

using Json = nlohmann::json;
using ShapePtr = std::shared_ptr<const TruthShape>;
constexpr std::uintmax_t kMaxPosesBytes = 64U << 20U;

/// One object of one frame.
struct PosedObject {
  int label = 0;
  ShapePtr shape;
  Transform T_camera_object = Transform::Identity();
};

struct PosedFrame {
  std::filesystem::path stem;  ///< Folder and name of the frame, without `-depth.png`.
  CameraModel camera;          ///< Its size is the depth image's.
  double depth_scale_m = 0.001;
  std::vector<PosedObject> objects;
};

// The published matrices carry rounding: the nearest rotation to the printed one.
Transform rigid_transform(const Json& rows) {
  Transform transform = Transform::Identity();
  Eigen::Matrix3d linear;
  for (int r = 0; r < 3; ++r) {
    const Json& row = rows.at(static_cast<std::size_t>(r));
    for (int c = 0; c < 3; ++c) linear(r, c) = row.at(static_cast<std::size_t>(c)).get<double>();
    transform.translation()[r] = row.at(3).get<double>();
  }
  transform.linear() = Eigen::Quaterniond(linear).normalized().toRotationMatrix();
  return transform;
}

CameraModel camera_of(const Json& k) {
  CameraModel camera;
  camera.fx = k.at(0).at(0).get<double>();
  camera.fy = k.at(1).at(1).get<double>();
  camera.cx = k.at(0).at(2).get<double>();
  camera.cy = k.at(1).at(2).get<double>();
  return camera;
}

/// A mesh and where its file's frame lies in the shape's (base centre at the origin).
struct LoadedMesh {
  ShapePtr shape;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
};

Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& name, const std::string& class_name, const TruthOptions& options) {
  auto mesh = read_mesh(file);
  if (!mesh) return tl::unexpected(mesh.error());
  if (mesh->triangles.empty()) return failure(ErrorCode::kCorruptData, file.string() + ": no triangles");
  TriangleMesh welded;
  for (const TriangleMesh& group : split_groups(*mesh)) append(welded, group);
  const Bounds box = bounds(welded.vertices);
  LoadedMesh loaded;
  loaded.base = {box.centre().x(), box.centre().y(), box.low.z()};
  auto shape = make_truth_shape(name, class_name, on_origin(std::move(welded)), options);
  if (!shape) return tl::unexpected(shape.error());
  loaded.shape = std::make_shared<const TruthShape>(std::move(*shape));
  return loaded;
}

Result<std::vector<PosedFrame>> parse_frames(const Json& poses, const std::filesystem::path& folder, const TruthOptions& options) {
  std::map<std::string, LoadedMesh> meshes;
  std::vector<PosedFrame> frames;
  for (const auto& [name, entry] : poses.items()) {
    PosedFrame frame{folder / name, camera_of(entry.at("K")), 1.0 / entry.at("depth_units_per_m").get<double>(), {}};
    for (const Json& object : entry.at("objects")) {
      const auto path = object.at("mesh").get<std::string>();
      if (!meshes.contains(path)) {
        auto loaded = load_mesh(folder / ".." / ".." / path, std::filesystem::path(path).stem().string(), object.at("class").get<std::string>(), options);
        if (!loaded) return tl::unexpected(loaded.error());
        meshes.emplace(path, std::move(*loaded));
      }
      const LoadedMesh& loaded = meshes.at(path);
      Transform T_camera_object = rigid_transform(object.at("mesh_to_camera"));
      T_camera_object.translate(loaded.base);
      if (!T_camera_object.matrix().allFinite()) return failure(ErrorCode::kCorruptData, (folder / "poses.json").string() + ": frame " + name + ": mesh_to_camera is no rigid transform");
      frame.objects.push_back({object.at("label_value").get<int>(), loaded.shape, T_camera_object});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// The frame in the object's frame as its world, and the pixels that show the object.
Result<MaskedFrame> read_posed_frame(const PosedFrame& posed, const PosedObject& object) {
  auto depth = read_png_depth(posed.stem.string() + "-depth.png");
  if (!depth) return tl::unexpected(depth.error());
  auto labels = read_png_grey(posed.stem.string() + "-label.png");
  if (!labels) return tl::unexpected(labels.error());
  if (labels->width != depth->width || labels->height != depth->height)
    return failure(ErrorCode::kCorruptData, posed.stem.string() + "-label.png: " + std::to_string(labels->width) + "x" + std::to_string(labels->height) + ", expected the depth image's size");
  MaskedFrame result;
  result.frame.sensor = "posed";
  result.frame.camera = posed.camera;
  result.frame.camera.width = depth->width;
  result.frame.camera.height = depth->height;
  result.frame.depth = {std::move(*depth), posed.depth_scale_m};
  result.object_mask = std::move(*labels);
  for (auto& pixel : result.object_mask.pixels) pixel = pixel == object.label ? 255 : 0;
  result.frame.T_world_sensor = object.T_camera_object.inverse();
  return result;
}

const PosedObject* find_object(const PosedFrame& posed, const ShapePtr& shape) {
  const auto found = std::find_if(posed.objects.begin(), posed.objects.end(), [&](const PosedObject& object) { return object.shape == shape; });
  return found != posed.objects.end() ? &*found : nullptr;
}

/// Frame `number` and, for `cameras` > 1, frames evenly spaced behind it that show the object too.
Result<EvaluationCase> make_posed_case(const std::vector<PosedFrame>& frames, std::size_t number, std::size_t index, std::size_t cameras) {
  const PosedFrame& posed = frames[number];
  const PosedObject& object = posed.objects[index];
  auto shown = read_posed_frame(posed, object);
  if (!shown) return tl::unexpected(shown.error());
  EvaluationCase result;
  static_cast<MaskedFrame&>(result) = std::move(*shown);
  for (std::size_t k = 1; k < cameras; ++k) {
    const PosedFrame& other = frames[(number + k * frames.size() / cameras) % frames.size()];
    const PosedObject* there = find_object(other, object.shape);
    if (!there || &other == &posed) continue;
    auto seen = read_posed_frame(other, *there);
    if (!seen) return tl::unexpected(seen.error());
    result.elsewhere.push_back(std::move(*seen));
  }
  std::vector<TriangleTree> others;
  for (std::size_t i = 0; i < posed.objects.size(); ++i) {
    if (i == index) continue;
    const TriangleMesh mesh_camera = transformed(posed.objects[i].shape->mesh, posed.objects[i].T_camera_object);
    append_surface_points(mesh_camera, result.others_camera);
    others.emplace_back(mesh_camera);
  }
  result.truth = {object.shape, object.T_camera_object, visible_samples(*object.shape, object.T_camera_object, result.frame.camera, others)};
  return result;
}

}  // namespace

Result<std::vector<CaseSpec>> list_posed_cases(const std::filesystem::path& folder, const CaseOptions& options) {
  const auto file = folder / "poses.json";
  const auto text = read_file(file, kMaxPosesBytes);
  if (!text) return tl::unexpected(text.error());
  try {
    auto frames = parse_frames(Json::parse(*text), folder, options.truth);
    if (!frames) return tl::unexpected(frames.error());
    std::vector<CaseSpec> specs;
    const auto all = std::make_shared<const std::vector<PosedFrame>>(std::move(*frames));
    for (std::size_t n = 0; n < all->size(); ++n) {
      const PosedFrame& frame = (*all)[n];
      for (std::size_t i = 0; i < frame.objects.size(); ++i) {
        const TruthShape& shape = *frame.objects[i].shape;
        if (!options.wants(shape.class_name, shape.name)) continue;
        specs.push_back({"frames", shape.name, frame.stem.filename().string(), shape.class_name,
                         [all, n, i, cameras = static_cast<std::size_t>(options.cameras)] { return make_posed_case(*all, n, i, cameras); }});
      }
    }
    return specs;
  } catch (const Json::exception& error) {
    return failure(ErrorCode::kCorruptData, file.string() + ": " + error.what());
  }
}

}  // namespace gfp
