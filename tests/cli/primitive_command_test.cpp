#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/frame/png.hpp"

namespace gfp {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::run_gfp;

TEST(PrimitiveCommand, ListsAtLeastTwelveClassesWithTheirModes) {
  const json all = run_gfp("primitive list --json").lines().at(0);
  EXPECT_GE(all.size(), 12U);
  for (const json& primitive : all) {
    EXPECT_GT(primitive["control_points"], 0) << primitive["class"];
    EXPECT_EQ(primitive["control_points"].get<int>() + primitive["regular_points"].get<int>(), primitive["vertices"].get<int>());
    EXPECT_FALSE(primitive["stable_poses"].empty()) << primitive["class"];
  }
}

TEST(PrimitiveCommand, ShowsAMugWithItsHandle) {
  const CommandResult text = run_gfp("primitive show mug");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("genus 1, hollow"), std::string::npos) << text.out;
  const test::TemporaryFolder folder;
  ASSERT_EQ(run_gfp("primitive show mug --json --png " + (folder / "mug.png").string()).exit_code, 0);
  EXPECT_GE(read_png_header(folder / "mug.png")->width, 900);
}

TEST(PrimitiveCommand, ExportsAClosedMeshOfTheSizeAskedFor) {
  const test::TemporaryFolder folder;
  for (const char* name : {"can.ply", "can.obj"}) {
    const CommandResult result = run_gfp("primitive export can --size 0.06,0.06,0.12 --out " + (folder / name).string());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto mesh = read_mesh(folder / name);
    ASSERT_TRUE(mesh);
    EXPECT_TRUE(examine_topology(*mesh).closed);
    EXPECT_NEAR(bounds(mesh->vertices).size().z(), 0.12, 0.01);
  }
}

TEST(PrimitiveCommand, ChecksWhatAPrimitivePromises) {
  const test::TemporaryFolder folder;
  const json all = run_gfp("primitive list --json").lines().at(0);
  for (const json& primitive : all) {
    const CommandResult result = run_gfp("primitive qa " + primitive["name"].get<std::string>() + " --json --out " + folder.path().string());
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }
  for (const char* file : {"mug.html", "mug.sheet.png", "mug.symmetry.png"}) EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  EXPECT_EQ(run_gfp("primitive qa kettledrum").exit_code, 64);
}

TEST(PrimitiveCommand, RefusesWhatItCannotDo) {
  EXPECT_EQ(run_gfp("primitive show kettledrum").exit_code, 64);
  EXPECT_EQ(run_gfp("primitive export mug --out mug.stl").exit_code, 64);
  EXPECT_EQ(run_gfp("primitive export mug --modes 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0").exit_code, 64);
  EXPECT_EQ(run_gfp("primitive").exit_code, 64);
}

}  // namespace
}  // namespace gfp
