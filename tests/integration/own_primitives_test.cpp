// Own primitives in use: a class is built from meshes, and fits, evaluations and the daemon work with it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>

#include "app/builtin_library.hpp"
#include "cli/command.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/core/random.hpp"
#include "gfp/evaluation/voxel_solid.hpp"
#include "gfp/frame/png.hpp"
#include "gfp/primitive/families.hpp"
#include "gfp/simulation/virtual_camera.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::run_gfp;

/// Bowls, in the place of the built-in ones: the even ones are built from, the odd ones are what is seen.
class OwnPrimitives : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    fs::create_directories(folder() / "models/bowl");
    fs::create_directories(folder() / "seen");
    std::ofstream table(folder() / "seen/meshes.csv");
    table << "file,class,scale_to_m,up_axis\n";
    for (int k = 0; k < 16; ++k) {
      const std::string name = std::to_string(k) + ".obj";
      ASSERT_TRUE(write_obj(folder() / (k % 2 == 0 ? "models/bowl/" + name : "seen/" + name), bowl(k)));
      if (k % 2 == 1) table << name << ",bowl,1,z\n";
    }
    const auto built = run_gfp("primitive build " + (folder() / "models").string() + " --out " + (folder() / "own").string() + " --json");
    ASSERT_EQ(built.exit_code, 0) << built.err;
    ASSERT_EQ(built.lines()[0]["classes"][0]["primitive"]["provenance"]["members"], 8) << built.out;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static TriangleMesh bowl(int k) {
    Random random(static_cast<std::uint64_t>(40 + k));
    return sample_family("bowl", random).mesh;
  }
  static const fs::path& folder() { return folder_->path(); }
  static std::string own() { return " --primitives " + (folder() / "own").string(); }

  inline static std::optional<test::TemporaryFolder> folder_;
};

TEST_F(OwnPrimitives, AFitRecognisesTheClassAndClosesIt) {
  const PlacedMesh seen{"bowl", "bowl", bowl(3), Transform::Identity(), {}};
  const Transform T_world_camera = look_at_pose({0, 0, 0.03}, 0.8, 0.6, 0.4);
  const Capture capture = gfp::capture({{seen}}, default_kinect_camera(), T_world_camera, {}, 5);
  ASSERT_TRUE(write_png(folder() / "view.png", capture.frame.depth.pixels));
  const auto result = run_gfp("fit " + (folder() / "view.png").string() + " --camera 525,525,319.5,239.5 --json --out " + (folder() / "fits").string() + own());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json objects = result.lines().at(0)["objects"];
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0]["class"], "bowl");
  EXPECT_EQ(objects[0]["vertices"], library_with(folder() / "own")->find("bowl")->size()) << "ours, not the built-in one";
  EXPECT_TRUE(objects[0]["closed"].get<bool>());
  EXPECT_EQ(objects[0]["self_intersections"], 0);

  const auto fit = read_mesh(folder() / "fits" / objects[0]["mesh"].get<std::string>());
  ASSERT_TRUE(fit);
  const auto solid = fill_solid(transformed(*fit, T_world_camera)), truth = fill_solid(seen.mesh);
  ASSERT_TRUE(solid && truth);
  EXPECT_GT(intersection_over_union(solid->filled, truth->filled), 0.85);
}

TEST_F(OwnPrimitives, AnEvaluationMeasuresThem) {
  const auto result = run_gfp("eval " + (folder() / "seen").string() + own() + " --class-estimated --views 1 --elevation 35 --seed 2 --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json summary = json::parse(result.out)["summary"]["gfp_robust"];
  EXPECT_GT(summary["iou_filled_median"], 0.85);
  EXPECT_EQ(summary["closed_rate"], 1.0);
  EXPECT_EQ(summary["self_intersection_rate"], 0.0);
  EXPECT_GE(summary["class_accuracy"], 0.75);
}

TEST_F(OwnPrimitives, AClassReplacesTheBuiltInOnes) {
  fs::create_directories(folder() / "bottles/bottle");
  fs::create_directories(folder() / "replaced");
  for (int k = 0; k < 2; ++k) {
    Random random(static_cast<std::uint64_t>(k));
    ASSERT_TRUE(write_ply(folder() / ("bottles/bottle/" + std::to_string(k) + ".ply"), sample_family("bottle", random).mesh));
  }
  ASSERT_EQ(run_gfp("primitive build " + (folder() / "bottles").string() + " --out " + (folder() / "replaced").string()).exit_code, 0);
  ASSERT_GE(builtin_library().of_class("bottle").size(), 2U) << "round and flat ones";
  const auto library = library_with(folder() / "replaced");
  ASSERT_TRUE(library) << library.error().what;
  ASSERT_EQ(library->of_class("bottle").size(), 1U);
  EXPECT_EQ(library->of_class("bottle")[0]->provenance.members, 2);
  EXPECT_NE(library->find("mug"), nullptr);
  const auto listed = run_gfp("primitive list --json --primitives " + (folder() / "replaced").string()).lines().at(0);
  EXPECT_EQ(listed.size(), library->all().size());
}

TEST_F(OwnPrimitives, ADamagedFileIsAnErrorThatNamesIt) {
  fs::create_directories(folder() / "damaged");
  fs::copy_file(folder() / "own/bowl.gfp", folder() / "damaged/bowl.gfp", fs::copy_options::overwrite_existing);
  fs::resize_file(folder() / "damaged/bowl.gfp", 1000);
  const std::string damaged = " --primitives " + (folder() / "damaged").string();
  for (const std::string& command : {"fit nothing.png" + damaged, "eval --families" + damaged, "primitive list" + damaged}) {
    const auto result = run_gfp(command);
    EXPECT_EQ(result.exit_code, 65) << command;
    EXPECT_NE(result.err.find("bowl.gfp"), std::string::npos) << result.err;
  }
  folder_->write("gfpd.yaml", "primitives: damaged\nsensors: [{name: a, driver: synthetic}]\n");
  const int status = std::system((GFPD_PROGRAM " --config " + (folder() / "gfpd.yaml").string() + " 2>" + (folder() / "err").string()).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 78) << "the daemon does not start with less than it was asked for";
  const auto error = library_of_configuration("damaged", 0, folder() / "gfpd.yaml");
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().what.find("primitives: "), 0U);
  EXPECT_EQ(library_with(folder() / "nowhere").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(library_with(folder() / "models").error().code, ErrorCode::kNotFound) << "no .gfp file in it";
}

}  // namespace
}  // namespace gfp
