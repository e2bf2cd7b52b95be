// gfp fit from file to mesh, on a rendered table with three boxes.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "cli/command.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/frame/png.hpp"
#include "support/table_frame.hpp"

namespace gfp {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::run_gfp;

class FitCommand : public ::testing::Test {
 protected:
  FitCommand() {
    input_ = (folder_ / "table.png").string();
    EXPECT_TRUE(write_png(input_, test::table_frame({{-0.18, 0}, {0.02, 0.03, {0.08, 0.05, 0.07}, 0.9}, {0.2, -0.05, {0.05, 0.05, 0.14}, 0.1}}).depth.pixels));
  }
  std::string fit(const std::string& options) const { return "fit " + input_ + " --camera 525,525,319.5,239.5 --depth-scale 0.0001 --seed 3 " + options; }

  test::TemporaryFolder folder_;
  std::string input_;
};

TEST_F(FitCommand, WritesALineWithAllItsKeys) {
  const CommandResult result = run_gfp(fit("--json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ASSERT_EQ(result.lines().size(), 1U);
  const json line = result.lines()[0];
  for (const char* key : {"input", "frame", "stamp_ns", "sensor", "profile", "method", "support", "ms", "rejected", "objects"}) EXPECT_TRUE(line.contains(key)) << key;
  EXPECT_EQ(line["input"], input_);
  ASSERT_EQ(line["objects"].size(), 3U);
  for (const json& object : line["objects"]) {
    for (const char* key : {"id", "class", "class_probabilities", "method", "T_camera_object", "scale", "extents_m", "pose_covariance", "yaw_interval_rad", "pixels", "bbox_px",
                            "vertices", "triangles", "closed", "self_intersections", "volume_material_m3", "volume_filled_m3", "fit_similarity", "rms_mm", "observed_fraction",
                            "sigma_median_mm", "evidence", "mesh", "no_grasp_reason", "grasps", "ms"})
      EXPECT_TRUE(object.contains(key)) << key;
    EXPECT_TRUE(object["closed"].get<bool>());
    EXPECT_EQ(object["self_intersections"], 0);
    EXPECT_TRUE(object["grasps"].empty() != object["no_grasp_reason"].is_null()) << "grasps, or a reason for none";
  }
}

TEST_F(FitCommand, WritesClosedMeshesInTheCameraFrame) {
  const auto out = folder_ / "meshes";
  const CommandResult result = run_gfp(fit("--json --out " + out.string()));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const json& object : result.lines()[0]["objects"]) {
    const std::string name = object["mesh"];
    const auto mesh = read_mesh(out / name);
    ASSERT_TRUE(mesh) << mesh.error().what;
    EXPECT_TRUE(examine_topology(*mesh).closed);
    const Eigen::Vector3d centre = bounds(mesh->vertices).centre();
    EXPECT_GT(centre.z(), 0.5);
    EXPECT_LT(centre.z(), 1.2);
    for (const char* extension : {".obj", ".glb"}) EXPECT_TRUE(std::filesystem::exists((out / name).replace_extension(extension)));
  }
}

TEST_F(FitCommand, DrawsAPicturePerFrame) {
  const auto picture = folder_ / "fit.png";
  ASSERT_EQ(run_gfp(fit("--png " + picture.string())).exit_code, 0);
  EXPECT_GT(read_png_header(picture)->width, 1000);
  ASSERT_EQ(run_gfp(fit(input_ + " --png " + picture.string())).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "fit_0000.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "fit_0001.png"));
}

// Same input, options and seed: the same line, but for the times.
TEST_F(FitCommand, IsDeterministic) {
  std::set<std::string> lines;
  for (int run = 0; run < 2; ++run) {
    json line = run_gfp(fit("--json")).lines().at(0);
    line.erase("ms");
    for (json& object : line["objects"]) object.erase("ms");
    lines.insert(line.dump());
  }
  EXPECT_EQ(lines.size(), 1U);
}

TEST_F(FitCommand, AMaskIsTheOneObject) {
  Image<std::uint8_t> mask(640, 480, 0);
  for (int v = 180; v < 240; ++v)
    for (int u = 190; u < 240; ++u) mask.at(u, v) = 255;
  const auto file = folder_ / "mask.png";
  ASSERT_TRUE(write_png(file, mask));
  const CommandResult result = run_gfp(fit("--json --mask " + file.string()));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.lines()[0]["objects"].size(), 1U);
}

TEST_F(FitCommand, TakesTheClassAndMethodThatItIsTold) {
  const json boxes = run_gfp(fit("--json --class box")).lines().at(0)["objects"];
  for (const json& object : boxes) EXPECT_TRUE(object["class"] == "box" || object["method"] == "superquadric") << object["class"];
  const json superquadrics = run_gfp(fit("--json --method superquadric")).lines().at(0)["objects"];
  for (const json& object : superquadrics) EXPECT_EQ(object["method"], "superquadric");
}

TEST_F(FitCommand, PrintsATableForPeople) {
  const CommandResult result = run_gfp(fit(""));
  EXPECT_NE(result.out.find("3 objects"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace gfp
