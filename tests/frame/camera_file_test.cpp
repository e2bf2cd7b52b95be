#include "gfp/frame/camera_file.hpp"

#include <gtest/gtest.h>

namespace gfp {
namespace {

TEST(InlineCamera, ReadsFourNumbers) {
  const auto file = parse_inline_camera("1066.778,1067.487,312.9869,241.3109");
  ASSERT_TRUE(file.has_value()) << file.error().what;
  EXPECT_EQ(file->camera.fx, 1066.778);
  EXPECT_EQ(file->camera.fy, 1067.487);
  EXPECT_EQ(file->camera.cx, 312.9869);
  EXPECT_EQ(file->camera.cy, 241.3109);
  const auto sized = camera_for_image(file->camera, 640, 480);
  ASSERT_TRUE(sized.has_value());
  EXPECT_EQ(sized->width, 640);
}

TEST(InlineCamera, RefusesAnythingElseByName) {
  for (const char* text : {"", "525", "525,525,320", "525,525,320,240,0", "525, 525,320,240", "a,b,c,d", "525,525,320,", "nan,525,1,1",
                           "-525,525,320,240", "525,525,inf,240", "1e9,525,320,240"}) {
    const auto file = parse_inline_camera(text);
    ASSERT_FALSE(file.has_value()) << text;
    EXPECT_EQ(file.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(file.error().what.find("camera"), std::string::npos) << file.error().what;
  }
}

TEST(CameraForImage, RefusesAnotherSize) {
  const auto camera = camera_for_image(default_kinect_camera(640, 480), 320, 240);
  ASSERT_FALSE(camera.has_value());
  EXPECT_EQ(camera.error().what, "camera is 640 x 480, expected the image's 320 x 240");
}

}  // namespace
}  // namespace gfp
