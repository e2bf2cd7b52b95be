#include "cli/fit_output.hpp"

#include <fmt/format.h>

#include <ostream>
#include <vector>

#include "cli/canvas.hpp"
#include "cli/overlay.hpp"
#include "gfp/core/mesh_io.hpp"

namespace gfp {
namespace {

double observed_share(const FittedModel& model) {
  if (model.states.empty()) return 0;
  std::size_t observed = 0;
  for (const std::uint8_t state : model.states) observed += (state & kVertexObserved) != 0;
  return static_cast<double>(observed) / static_cast<double>(model.states.size());
}

std::string grasp_text(const GraspPlan& plan) {
  if (plan.grasps.empty()) return "none: " + plan.no_grasp_reason;
  return fmt::format("{}, best {:.0f} mm wide, epsilon {:.3f}", plan.grasps.size(), 1e3 * plan.grasps.front().width_m, plan.grasps.front().epsilon);
}

std::string object_row(const SceneObject& object) {
  const Eigen::Vector3d extents_mm = 1e3 * bounds(object.model.vertices).size();
  const std::string flaws = (object.closed ? std::string() : std::string("  NOT CLOSED")) +
                            (object.self_intersections > 0 ? fmt::format("  {} self-intersections", object.self_intersections) : "");
  return fmt::format("  {:>4}  {:<18} {:<13} {:>4.0f} x {:>3.0f} x {:>3.0f}  {:>9.0f}  {:>6.1f}  {:>5.3f}  {:>4.0f} %  {}{}\n", object.id, class_label(object),
                     object.model.method, extents_mm.x(), extents_mm.y(), extents_mm.z(), 1e6 * object.volume_filled_m3, 1e3 * object.model.evidence.rms_m,
                     object.model.evidence.fit_similarity, 100 * observed_share(object.model), grasp_text(object.grasps), flaws);
}

std::vector<Rgb8> vertex_colors(const SceneObject& object) {
  const Rgb8 color = distinct_color(object.id);
  const auto pale = [](std::uint8_t value) { return static_cast<std::uint8_t>((value + 3 * 235) / 4); };
  std::vector<Rgb8> colors;
  for (const std::uint8_t state : object.model.states)
    colors.push_back(state & kVertexObserved ? color : Rgb8{pale(color.r), pale(color.g), pale(color.b)});
  return colors.size() == object.model.vertices.size() ? colors : std::vector<Rgb8>{};
}

Result<void> write_object(const std::filesystem::path& base, const SceneObject& object) {
  const TriangleMesh mesh = object.model.mesh_camera();
  const std::vector<Rgb8> colors = vertex_colors(object);
  for (const auto& [extension, write] : {std::pair{".ply", &write_ply}, std::pair{".obj", &write_obj}, std::pair{".glb", &write_glb}})
    if (auto written = write(std::filesystem::path(base) += extension, mesh, colors); !written) return written;
  return {};
}

}  // namespace

void print_table(std::ostream& out, const std::string& input, const Scene& scene) {
  double total_ms = 0;
  for (const auto& [stage, ms] : scene.ms) total_ms += ms;
  out << fmt::format("{}  frame {}: {} objects, {}, {:.0f} ms\n", input, scene.sequence, scene.objects.size(),
                     scene.support ? "on a support plane" : "no support plane", total_ms);
  if (!scene.objects.empty())
    out << "    id  class              method          size mm           filled ml  rms mm    fit   seen  grasps\n";
  for (const SceneObject& object : scene.objects) out << object_row(object);
  for (const RejectedSegment& segment : scene.rejected) out << fmt::format("        rejected: {} ({} pixels)\n", segment.reason, segment.pixels);
}

std::string object_stem(const std::string& stem, const Scene& scene, const SceneObject& object) {
  return fmt::format("{}_{}_{}", stem, scene.sequence, object.id);
}

Result<std::map<std::uint64_t, std::string>> write_meshes(const std::filesystem::path& folder, const std::string& stem, const Scene& scene) {
  std::map<std::uint64_t, std::string> names;
  for (const SceneObject& object : scene.objects) {
    const std::string base = object_stem(stem, scene, object);
    if (const auto written = write_object(folder / base, object); !written) return tl::unexpected(written.error());
    names[object.id] = base + ".ply";
  }
  return names;
}

std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number) {
  return file.parent_path() / fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string());
}

}  // namespace gfp
