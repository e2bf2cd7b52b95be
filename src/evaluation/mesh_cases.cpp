#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "gfp/evaluation/cases.hpp"
#include "mesh_table.hpp"
#include "table_view.hpp"

namespace gfp {
namespace {

using Shapes = std::vector<std::shared_ptr<const TruthShape>>;

std::string object_name(const std::string& file, std::size_t part, std::size_t parts) {
  const std::filesystem::path path(file);
  const std::string name = (path.parent_path() / path.stem()).generic_string();
  return parts > 1 ? name + "_" + std::to_string(part + 1) : name;
}

Result<Shapes> load_shapes(const std::filesystem::path& folder, const MeshEntry& entry, const TruthOptions& options) {
  auto objects = load_objects(folder, entry);
  if (!objects) return tl::unexpected(objects.error());
  Shapes shapes;
  for (std::size_t i = 0; i < objects->size(); ++i) {
    bool turned = false;
    TriangleMesh mesh = on_origin(stood_up((*objects)[i], turned));
    auto shape = make_truth_shape(object_name(entry.file, i, objects->size()) + (turned ? " (turned)" : ""), entry.class_name, std::move(mesh), options);
    if (!shape) return tl::unexpected(shape.error());
    shapes.push_back(std::make_shared<const TruthShape>(std::move(*shape)));
  }
  return shapes;
}

}  // namespace

void append_surface_points(const TriangleMesh& mesh_camera, std::vector<Eigen::Vector3f>& points) {
  constexpr double kSpacing_m = 0.005;
  constexpr double kMostPoints = 50'000;
  const double wanted = std::min(surface_area(mesh_camera) / (kSpacing_m * kSpacing_m), kMostPoints);
  for (const Eigen::Vector3d& point : sample_surface(mesh_camera, static_cast<int>(wanted), 1).points) points.push_back(point.cast<float>());
}

Result<std::vector<CaseSpec>> list_mesh_cases(const std::filesystem::path& folder, const CaseOptions& options) {
  auto entries = read_mesh_table(folder / "meshes.csv");
  if (!entries) return tl::unexpected(entries.error());
  std::erase_if(*entries, [&](const MeshEntry& entry) { return !options.wants(entry.class_name, entry.file); });
  std::vector<Result<Shapes>> loaded(entries->size());
  tbb::parallel_for(std::size_t{0}, entries->size(), [&](std::size_t i) { loaded[i] = load_shapes(folder, (*entries)[i], options.truth); });
  std::vector<CaseSpec> specs;
  std::uint64_t index = 0;
  for (const auto& shapes : loaded) {
    if (!shapes) return tl::unexpected(shapes.error());
    for (const auto& shape : *shapes) add_table_cases("meshes", shape, options, index++, specs);
  }
  return specs;
}

Result<std::vector<CaseSpec>> list_folder_cases(const std::filesystem::path& folder, const CaseOptions& options) {
  if (std::filesystem::is_regular_file(folder / "poses.json")) return list_posed_cases(folder, options);
  if (std::filesystem::is_regular_file(folder / "meshes.csv")) return list_mesh_cases(folder, options);
  return failure(ErrorCode::kNotFound, folder.string() + ": neither meshes.csv nor poses.json");
}

}  // namespace gfp
