#include "wire/foxglove_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace gfp::wire {
namespace {

std::string optical_frame(const std::string& sensor) { return sensor + "_optical"; }

void fill(Nanoseconds stamp, google::protobuf::Timestamp& message) {
  message.set_seconds(stamp.count() / 1'000'000'000);
  message.set_nanos(static_cast<std::int32_t>(stamp.count() % 1'000'000'000));
}

void fill(const Eigen::Vector3d& vector, foxglove::Vector3& message) {
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
}

void fill(const Eigen::Matrix3d& rotation, foxglove::Quaternion& message) {
  const Eigen::Quaterniond quaternion(rotation);
  message.set_x(quaternion.x());
  message.set_y(quaternion.y());
  message.set_z(quaternion.z());
  message.set_w(quaternion.w());
}

void fill(const Transform& pose, foxglove::Pose& message) {
  fill(Eigen::Vector3d(pose.translation()), *message.mutable_position());
  fill(Eigen::Matrix3d(pose.linear()), *message.mutable_orientation());
}

struct Rgba {
  double r, g, b, a;
};

void fill(const Rgba& color, foxglove::Color& message) {
  message.set_r(color.r);
  message.set_g(color.g);
  message.set_b(color.b);
  message.set_a(color.a);
}

constexpr Rgba kSeen{0.24, 0.71, 0.54, 1}, kInferred{0.93, 0.60, 0.25, 1}, kGripper{0.35, 0.55, 0.95, 0.9}, kLabel{1, 1, 1, 1};

void fill_mesh(const FittedModel& model, foxglove::TriangleListPrimitive& message) {
  fill(model.T_camera_object, *message.mutable_pose());
  for (std::size_t i = 0; i < model.vertices.size(); ++i) {
    foxglove::Point3& point = *message.add_points();
    point.set_x(model.vertices[i].x());
    point.set_y(model.vertices[i].y());
    point.set_z(model.vertices[i].z());
    const bool is_seen = i < model.states.size() && (model.states[i] & kVertexObserved) != 0;
    fill(is_seen ? kSeen : kInferred, *message.add_colors());
  }
  for (const auto& triangle : model.topology->triangles)
    for (int corner = 0; corner < 3; ++corner) message.add_indices(static_cast<std::uint32_t>(triangle[static_cast<std::size_t>(corner)]));
}

/// Two fingers and the bar that carries them. Tool-centre frame: x along the approach, y along the closing axis.
void fill_gripper(const Grasp& grasp, foxglove::SceneEntity& entity) {
  constexpr double kFinger_m = 0.045, kThick_m = 0.008, kWide_m = 0.016;
  const double half_m = 0.5 * std::max(grasp.opening_m, grasp.width_m);
  const auto add = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
    foxglove::CubePrimitive& cube = *entity.add_cubes();
    fill(Transform(grasp.T_camera_tcp * Eigen::Translation3d(centre)), *cube.mutable_pose());
    fill(size, *cube.mutable_size());
    fill(kGripper, *cube.mutable_color());
  };
  for (const double side : {-1.0, 1.0}) add({-0.5 * kFinger_m, side * (half_m + 0.5 * kThick_m), 0}, {kFinger_m, kThick_m, kWide_m});
  add({-kFinger_m - 0.5 * kThick_m, 0, 0}, {kThick_m, 2 * (half_m + kThick_m), kWide_m});
  add({-kFinger_m - 0.03, 0, 0}, {0.045, kThick_m, kThick_m});
}

void fill_object(const Scene& scene, const SceneObject& object, foxglove::SceneEntity& entity) {
  fill(scene.stamps.realtime, *entity.mutable_timestamp());
  entity.set_frame_id(optical_frame(scene.sensor));
  entity.set_id(fmt::format("{}/{}", scene.sensor, object.id));
  entity.mutable_lifetime()->set_seconds(3);
  const auto say = [&](const char* key, std::string value) {
    foxglove::KeyValuePair& pair = *entity.add_metadata();
    pair.set_key(key);
    pair.set_value(std::move(value));
  };
  const auto probability = object.class_probabilities.find(object.model.class_name);
  say("class", object.model.class_name);
  say("probability", fmt::format("{:.2f}", probability == object.class_probabilities.end() ? 0.0 : probability->second));
  say("method", object.model.method);
  say("grasps", object.grasps.grasps.empty() ? object.grasps.no_grasp_reason : std::to_string(object.grasps.grasps.size()));
  fill_mesh(object.model, *entity.add_triangles());
  foxglove::TextPrimitive& label = *entity.add_texts();
  const double height_m = object.model.vertices.empty() ? 0 : bounds(object.model.vertices).high.z();
  fill(Transform(object.model.T_camera_object * Eigen::Translation3d(0, 0, height_m + 0.03)), *label.mutable_pose());
  label.set_billboard(true);
  label.set_font_size(12);
  label.set_scale_invariant(true);
  fill(kLabel, *label.mutable_color());
  label.set_text(fmt::format("{} {}", object.id, object.model.class_name));
  if (!object.grasps.grasps.empty()) fill_gripper(object.grasps.grasps.front(), entity);
}

void fill_image_header(const Frame& frame, int width, int height, int pixel_bytes, const char* encoding, foxglove::RawImage& message) {
  fill(frame.stamps.realtime, *message.mutable_timestamp());
  message.set_frame_id(optical_frame(frame.sensor));
  message.set_width(static_cast<std::uint32_t>(width));
  message.set_height(static_cast<std::uint32_t>(height));
  message.set_step(static_cast<std::uint32_t>(width * pixel_bytes));
  message.set_encoding(encoding);
}

void add_field(foxglove::PointCloud& message, const char* name, std::uint32_t offset, foxglove::PackedElementField::NumericType type) {
  foxglove::PackedElementField& field = *message.add_fields();
  field.set_name(name);
  field.set_offset(offset);
  field.set_type(type);
}

}  // namespace

void fill_depth_image(const Frame& frame, foxglove::RawImage& message) {
  const Image<std::uint16_t>& depth = frame.depth.pixels;
  fill_image_header(frame, depth.width, depth.height, 2, "16UC1", message);
  std::string& data = *message.mutable_data();
  data.resize(2 * depth.pixels.size());
  const double mm_per_unit = 1e3 * frame.depth.scale_m;
  if (mm_per_unit == 1) {
    std::memcpy(data.data(), depth.pixels.data(), data.size());
    return;
  }
  for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
    const auto mm = static_cast<std::uint16_t>(std::min(65535.0, std::round(mm_per_unit * depth.pixels[i])));
    std::memcpy(data.data() + 2 * i, &mm, 2);
  }
}

void fill_color_image(const Frame& frame, foxglove::RawImage& message) {
  fill_image_header(frame, frame.color.width, frame.color.height, 3, "rgb8", message);
  message.set_data(frame.color.pixels.data(), 3 * frame.color.pixels.size());
}

void fill_calibration(const Frame& frame, foxglove::CameraCalibration& message) {
  const CameraModel& camera = frame.camera;
  fill(frame.stamps.realtime, *message.mutable_timestamp());
  message.set_frame_id(optical_frame(frame.sensor));
  message.set_width(static_cast<std::uint32_t>(camera.width));
  message.set_height(static_cast<std::uint32_t>(camera.height));
  if (camera.distortion == DistortionModel::kPlumbBob) message.set_distortion_model("plumb_bob");
  if (camera.distortion == DistortionModel::kRationalPolynomial) message.set_distortion_model("rational_polynomial");
  for (const double coefficient : camera.coefficients) message.add_d(coefficient);
  for (const double k : {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0}) message.add_k(k);
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.add_r(r);
  for (const double p : {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0}) message.add_p(p);
}

void fill_cloud(const Frame& frame, foxglove::PointCloud& message) {
  const Image<std::uint16_t>& depth = frame.depth.pixels;
  const bool has_color = frame.color.width == depth.width && frame.color.height == depth.height;
  fill(frame.stamps.realtime, *message.mutable_timestamp());
  message.set_frame_id(optical_frame(frame.sensor));
  fill(Transform::Identity(), *message.mutable_pose());
  using Field = foxglove::PackedElementField;
  const std::size_t stride = has_color ? 16 : 12;
  message.set_point_stride(static_cast<std::uint32_t>(stride));
  for (const auto& [name, offset] : {std::pair{"x", 0U}, {"y", 4U}, {"z", 8U}}) add_field(message, name, offset, Field::FLOAT32);
  if (has_color)
    for (const auto& [name, offset] : {std::pair{"red", 12U}, {"green", 13U}, {"blue", 14U}, {"alpha", 15U}}) add_field(message, name, offset, Field::UINT8);
  std::string& data = *message.mutable_data();
  data.resize(stride * depth.pixels.size());
  char* out = data.data();
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) {
      const double z = frame.depth.scale_m * depth.at(u, v);
      if (z == 0) continue;
      const std::array<float, 3> point{static_cast<float>((u - frame.camera.cx) / frame.camera.fx * z), static_cast<float>((v - frame.camera.cy) / frame.camera.fy * z), static_cast<float>(z)};
      std::memcpy(out, point.data(), sizeof point);
      if (has_color) {
        const Rgb8 color = frame.color.at(u, v);
        const std::array<std::uint8_t, 4> rgba{color.r, color.g, color.b, 255};
        std::memcpy(out + 12, rgba.data(), rgba.size());
      }
      out += stride;
    }
  data.resize(static_cast<std::size_t>(out - data.data()));
}

void fill_transforms(const Frame& frame, foxglove::FrameTransforms& message) {
  foxglove::FrameTransform& transform = *message.add_transforms();
  fill(frame.stamps.realtime, *transform.mutable_timestamp());
  transform.set_parent_frame_id("world");
  transform.set_child_frame_id(optical_frame(frame.sensor));
  fill(Eigen::Vector3d(frame.T_world_sensor.translation()), *transform.mutable_translation());
  fill(Eigen::Matrix3d(frame.T_world_sensor.linear()), *transform.mutable_rotation());
}

void fill_scene_update(const Scene& scene, foxglove::SceneUpdate& message) {
  for (const std::uint64_t id : scene.lost) {
    foxglove::SceneEntityDeletion& deletion = *message.add_deletions();
    fill(scene.stamps.realtime, *deletion.mutable_timestamp());
    deletion.set_id(fmt::format("{}/{}", scene.sensor, id));
  }
  for (const SceneObject& object : scene.objects) fill_object(scene, object, *message.add_entities());
}

void fill_log(const v1::LogRecord& record, foxglove::Log& message) {
  static_assert(static_cast<int>(v1::LogRecord::LEVEL_ERROR) == static_cast<int>(foxglove::Log::ERROR));
  fill(Nanoseconds(record.stamp_ns()), *message.mutable_timestamp());
  message.set_level(static_cast<foxglove::Log::Level>(record.level()));
  message.set_name("gfpd");
  message.set_message(record.text());
}

}  // namespace gfp::wire
