#include "cli/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cli/canvas.hpp"
#include "cli/painter.hpp"
#include "cli/side_view.hpp"

namespace gfp {
namespace {

constexpr int kFrontWidth = 1280;
constexpr int kMaxFrontHeight = 1600;
constexpr Rgb8 kBackground{18, 18, 24}, kText{225, 225, 230}, kDim{150, 150, 160}, kTable{90, 255, 160}, kWarning{255, 170, 60};

/// The frame's camera for a picture `scale` times as large.
CameraModel scaled_camera(const CameraModel& camera, double scale, int width, int height) {
  return {width, height, camera.fx * scale, camera.fy * scale, (camera.cx + 0.5) * scale - 0.5, (camera.cy + 0.5) * scale - 0.5, DistortionModel::kNone, {}};
}

/// Depth at every picture pixel; 0 where there is none.
Image<float> scaled_depth(const DepthImage& depth, double scale, int width, int height) {
  Image<float> result(width, height, 0.0F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const int su = std::min(depth.pixels.width - 1, static_cast<int>(u / scale)), sv = std::min(depth.pixels.height - 1, static_cast<int>(v / scale));
      result.at(u, v) = static_cast<float>(depth.scale_m * depth.pixels.at(su, sv));
    }
  }
  return result;
}

/// Grey by the slope towards the lower right, bluish with distance; black where there is no reading.
Rgb8 depth_color(const Image<float>& depth_m, int u, int v) {
  const float z = depth_m.at(u, v);
  if (!(z > 0)) return {8, 8, 14};
  const float right = depth_m.at(std::min(u + 3, depth_m.width - 1), v), below = depth_m.at(u, std::min(v + 3, depth_m.height - 1));
  const double slope = (right > 0 ? z - right : 0) + (below > 0 ? z - below : 0);
  const double light = std::clamp(120 + 9000 * slope / z, 40.0, 210.0) * std::clamp(1.3 - 0.25 * z, 0.3, 1.0);
  return {static_cast<std::uint8_t>(light), static_cast<std::uint8_t>(light), static_cast<std::uint8_t>(std::min(255.0, light * 1.12))};
}

void draw_background(Canvas& canvas, const Frame& frame, const Image<float>& depth_m, double scale) {
  for (int v = 0; v < canvas.height(); ++v) {
    for (int u = 0; u < canvas.width(); ++u) {
      const int su = static_cast<int>(u / scale), sv = static_cast<int>(v / scale);
      const bool colored = frame.color.width == frame.camera.width && frame.color.height == frame.camera.height && frame.color.contains(su, sv);
      canvas.blend(u, v, colored ? shaded(frame.color.at(su, sv), 0.85) : depth_color(depth_m, u, v));
    }
  }
}

/// Borders of the segments, as the segmentation drew them.
void draw_segments(Canvas& canvas, const SceneMemory& memory, const Scene& scene, double scale) {
  const int width = scene.camera.width, height = scene.camera.height;
  for (const Track& track : memory.tracks) {
    const SensorTrack* seen = track.seen_by(scene.sensor);
    if (!seen || seen->missed_frames > 0) continue;
    Image<std::uint8_t> mask(width, height, 0);
    for (const std::int32_t pixel : seen->pixels) mask.pixels[static_cast<std::size_t>(pixel)] = 1;
    const auto inside = [&](int u, int v) { return mask.contains(u, v) && mask.at(u, v); };
    for (const std::int32_t pixel : seen->pixels) {
      const int u = pixel % width, v = pixel / width;
      if (inside(u - 1, v) && inside(u + 1, v) && inside(u, v - 1) && inside(u, v + 1)) continue;
      canvas.disc({(u + 0.5) * scale - 0.5, (v + 0.5) * scale - 0.5}, 0.35 * scale, {255, 255, 255}, 0.55);
    }
  }
}

void draw_labels(Canvas& canvas, const Scene& scene, double scale) {
  for (const SceneObject& object : scene.objects) {
    const int u = static_cast<int>(object.bbox.u0 * scale), v = static_cast<int>(object.bbox.v0 * scale) - 30;
    canvas.label(u, v, fmt::format("{} {}", object.id, class_label(object)), distinct_color(object.id));
  }
}

void draw_grasps(Painter& painter, const Scene& scene, const Gripper& gripper, const Transform& T_view_camera, std::size_t at_most) {
  for (const SceneObject& object : scene.objects)
    for (std::size_t i = std::min(at_most, object.grasps.grasps.size()); i-- > 0;)  // the best one last, on top
      painter.grasp(object.grasps.grasps[i], gripper, T_view_camera, i == 0 ? Rgb8{255, 255, 80} : shaded(distinct_color(object.id), 0.8), i == 0);
}

std::vector<PaintedMesh> painted_objects(const Scene& scene, const Transform& T_view_camera) {
  std::vector<PaintedMesh> meshes;
  for (const SceneObject& object : scene.objects) meshes.push_back(painted(object.model, T_view_camera, distinct_color(object.id)));
  return meshes;
}

Image<Rgb8> draw_front(const Frame& frame, const Scene& scene, const SceneMemory& memory, const Gripper& gripper) {
  const double scale = std::min(static_cast<double>(kFrontWidth) / frame.camera.width, static_cast<double>(kMaxFrontHeight) / frame.camera.height);
  const int width = std::max(1, static_cast<int>(frame.camera.width * scale)), height = std::max(1, static_cast<int>(frame.camera.height * scale));
  Canvas canvas(width, height, kBackground);
  const Image<float> depth_m = scaled_depth(frame.depth, scale, width, height);
  draw_background(canvas, frame, depth_m, scale);
  Painter painter(canvas, scaled_camera(frame.camera, scale, width, height));
  if (scene.support) painter.support(*scene.support, Transform::Identity(), kTable);
  painter.meshes(painted_objects(scene, Transform::Identity()), 0.5, depth_m);
  draw_segments(canvas, memory, scene, scale);
  draw_grasps(painter, scene, gripper, Transform::Identity(), 6);
  draw_labels(canvas, scene, scale);
  return canvas.image();
}

Image<Rgb8> draw_side(const Frame& frame, const Scene& scene, const Gripper& gripper, int height) {
  Canvas canvas(height, height, kBackground);
  const SideView view = side_view(scene, height);
  const Image<float> points_m = draw_points(canvas, frame, view);
  Painter painter(canvas, view.camera);
  if (scene.support) painter.support(*scene.support, view.T_view_camera, kTable);
  painter.meshes(painted_objects(scene, view.T_view_camera), 0.75, points_m);
  draw_grasps(painter, scene, gripper, view.T_view_camera, 1);
  canvas.label(0, 0, "60 deg about up, over the measured points", kDim);
  return canvas.image();
}

/// What a person wants to know of one object, in one line.
std::string object_line(const SceneObject& object) {
  const FittedModel& model = object.model;
  const Eigen::Vector3d extents_mm = 1e3 * bounds(model.vertices).size();
  const std::string grasps = object.grasps.grasps.empty() ? "no grasp: " + object.grasps.no_grasp_reason
                                                          : fmt::format("{} grasps, best epsilon {:.3f}", object.grasps.grasps.size(), object.grasps.grasps.front().epsilon);
  return fmt::format("{:>3} {:<18} {:<13} {:4.0f} x{:4.0f} x{:4.0f} mm {:5.0f} ml  rms {:4.1f} mm  fit {:.3f}  sil {:.2f} free {:.2f} cost {:6.3f}  {}{}  {}",
                     object.id, class_label(object), model.method, extents_mm.x(), extents_mm.y(), extents_mm.z(), 1e6 * object.volume_filled_m3,
                     1e3 * model.evidence.rms_m, model.evidence.fit_similarity, model.evidence.silhouette_iou, model.evidence.free_space_violation,
                     model.evidence.cost, object.closed ? "closed" : "OPEN",
                     object.self_intersections > 0 ? fmt::format(", {} CROSSINGS", object.self_intersections) : "", grasps);
}

struct TextLine {
  std::string text;
  Rgb8 color;
};

std::vector<TextLine> footer_lines(const Scene& scene, const std::string& title) {
  double total_ms = 0;
  for (const auto& [stage, ms] : scene.ms) total_ms += ms;
  std::vector<TextLine> lines{{fmt::format("{}  {} objects, {} rejected, support {}, {:.0f} ms", title, scene.objects.size(), scene.rejected.size(),
                                           scene.support ? "found" : "none", total_ms), kText},
                              {"solid: observed, striped: inferred, pale: behind something, white dots: segment outline, green: support, yellow: best grasp", kDim}};
  for (const SceneObject& object : scene.objects) lines.push_back({object_line(object), distinct_color(object.id)});
  std::string rejected;
  for (const RejectedSegment& segment : scene.rejected) rejected += fmt::format("  {} ({} px)", segment.reason, segment.pixels);
  if (!rejected.empty()) lines.push_back({"rejected:" + rejected, kWarning});
  return lines;
}

Image<Rgb8> draw_footer(const std::vector<TextLine>& lines, int width) {
  constexpr int kLineHeight = 22, kMaxLines = 40;
  const int count = std::min(kMaxLines, static_cast<int>(lines.size()));
  Canvas canvas(width, count * kLineHeight + 12, kBackground);
  for (int i = 0; i < count; ++i) canvas.text(10, 8 + i * kLineHeight, lines[static_cast<std::size_t>(i)].text, lines[static_cast<std::size_t>(i)].color);
  return canvas.image();
}

}  // namespace

std::string class_label(const SceneObject& object) {
  const auto found = object.class_probabilities.find(object.model.class_name);
  return found == object.class_probabilities.end() ? object.model.class_name : fmt::format("{} {:.2f}", object.model.class_name, found->second);
}

Image<Rgb8> draw_overlay(const Frame& frame, const Scene& scene, const SceneMemory& memory, const Gripper& gripper, const std::string& title) {
  const Image<Rgb8> front = draw_front(frame, scene, memory, gripper);
  const Image<Rgb8> side = draw_side(frame, scene, gripper, std::max(480, front.height));
  const Image<Rgb8> footer = draw_footer(footer_lines(scene, title), front.width + 4 + side.width);
  Canvas canvas(footer.width, std::max(front.height, side.height) + footer.height, kBackground);
  canvas.paste(front, 0, 0);
  canvas.paste(side, front.width + 4, 0);
  canvas.paste(footer, 0, std::max(front.height, side.height));
  return canvas.image();
}

}  // namespace gfp
