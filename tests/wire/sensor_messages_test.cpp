#include "wire/sensor_messages.hpp"

#include <gtest/gtest.h>

#include "wire/geometry_messages.hpp"

namespace gfp::wire {
namespace {

Frame some_frame() {
  Frame frame;
  frame.sensor = "front";
  frame.sequence = 7;
  frame.depth.pixels = Image<std::uint16_t>(3, 2);
  for (std::uint16_t i = 0; i < 6; ++i) frame.depth.pixels.pixels[i] = static_cast<std::uint16_t>(1000 * i);
  frame.depth.scale_m = 1e-4;
  frame.color = Image<Rgb8>(3, 2, Rgb8{1, 2, 3});
  frame.camera = default_kinect_camera(3, 2);
  frame.up_camera = -Eigen::Vector3d::UnitY();
  return frame;
}

TEST(SensorMessages, ImagesComeBackTheSame) {
  const Frame frame = some_frame();
  v1::DepthImage depth;
  fill_depth(frame, depth);
  const auto back = depth_from(depth, depth_blob(frame));
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_EQ(back->pixels.pixels, frame.depth.pixels.pixels);
  EXPECT_EQ(back->scale_m, 1e-4);
  v1::ColorImage color;
  fill_color(frame, color);
  EXPECT_EQ(color_from(color, color_blob(frame))->pixels, frame.color.pixels);
}

TEST(SensorMessages, DepthIsLittleEndian) {
  const Frame frame = some_frame();
  EXPECT_EQ(depth_blob(frame)[2], std::byte{1000 & 0xff});
  EXPECT_EQ(depth_blob(frame)[3], std::byte{1000 >> 8});
}

TEST(SensorMessages, SizesAreCheckedBeforeAnythingIsAllocated) {
  v1::DepthImage message;
  message.set_width(1U << 31);
  message.set_height(1U << 31);
  EXPECT_EQ(depth_from(message, {}).error().code, ErrorCode::kTooLarge);
  message.set_width(100);
  message.set_height(100);
  EXPECT_EQ(depth_from(message, {}).error().what, "image has 0 bytes, expected 20000");
}

TEST(SensorMessages, TheCameraTravelsWithItsPose) {
  v1::CameraInfo message;
  const Frame frame = some_frame();
  fill_camera(frame, message);
  EXPECT_EQ(*camera_from(message.camera()), frame.camera);
  EXPECT_EQ(vector_from(message.up_camera()), *frame.up_camera);
  EXPECT_EQ(message.header().sequence(), 7U);
}

TEST(GeometryMessages, OnlyRigidTransformsAndValidCamerasPass) {
  v1::Transform message;
  EXPECT_EQ(transform_from(message, "T").error().what, "T has 0 numbers, expected 16");
  for (int i = 0; i < 16; ++i) message.add_matrix(1);
  EXPECT_EQ(transform_from(message, "T").error().what, "T is not a rigid transform");
  v1::Camera camera;
  camera.set_width(0xFFFFFFFF);
  EXPECT_FALSE(camera_from(camera).has_value());
}

}  // namespace
}  // namespace gfp::wire
