// gfp primitive retype: a person's word on control points, kept apart from the automatic typing.
#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/core/random.hpp"
#include "gfp/primitive/families.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::run_gfp;

class PrimitiveRetype : public testing::Test {
 protected:
  std::string folder() const { return (folder_ / "own").string(); }
  json retype(const std::string& name, const std::string& more) const {
    const auto result = run_gfp("primitive retype " + name + " --json --primitives " + folder() + " " + more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.lines().empty() ? json() : result.lines()[0];
  }
  Primitive read(const std::string& name) const { return wire::read_primitive(folder_ / ("own/" + name + ".gfp")).value_or(Primitive{}); }

  test::TemporaryFolder folder_;
};

TEST_F(PrimitiveRetype, OverridesAndTakesBack) {
  const json before = run_gfp("primitive show mug --json").lines().at(0);
  const json handle = retype("mug", "--set control --part handle");
  EXPECT_GT(handle["changed"], 20);
  EXPECT_EQ(handle["manual"].size(), handle["changed"].get<std::size_t>());
  EXPECT_GT(handle["control_points"], before["control_points"]);
  const Primitive mug = read("mug");
  for (std::size_t i = 0; i < mug.size(); ++i) {
    EXPECT_EQ(mug.manual_types[i].has_value(), mug.topology->parts[i] == Part::kHandle) << i;
    if (mug.manual_types[i]) {
      EXPECT_EQ(mug.topology->types[i], PointType::kControl) << i;
    }
  }
  const json upper = retype("mug", "--set regular --part handle --box -1,-1,0.05,1,1,1");
  EXPECT_GT(upper["changed"], 0);
  EXPECT_LT(upper["changed"], handle["changed"]);
  EXPECT_EQ(upper["manual"].size(), handle["manual"].size());
  for (const json& entry : upper["manual"]) EXPECT_EQ(entry["type"] == "regular", entry["point_m"][2].get<double>() >= 0.05) << entry;
  EXPECT_EQ(retype("mug", "--set auto --vertices " + std::to_string(upper["manual"][0]["vertex"].get<int>()))["changed"], 1);
  EXPECT_TRUE(retype("mug", "--set auto")["manual"].empty());
  EXPECT_EQ(run_gfp("primitive show mug --json --primitives " + folder()).lines().at(0)["content_hash"], before["content_hash"]) << "nothing of it is left";
}

// What a folder has of a class replaces all of it: the class's other built-in primitives come along, so that none is lost.
TEST_F(PrimitiveRetype, BringsTheOthersOfItsClassAlong) {
  retype("flat_bottle", "--set regular --vertices 0-3");
  const auto names = [](const std::string& more) {
    std::vector<std::string> listed;
    for (const json& line : run_gfp("primitive list --json " + more).lines())
      for (const json& primitive : line) listed.push_back(primitive["name"]);
    return listed;
  };
  EXPECT_EQ(names("--primitives " + folder()), names(""));
  EXPECT_TRUE(fs::exists(folder_ / "own/bottle.gfp"));
  EXPECT_FALSE(fs::exists(folder_ / "own/mug.gfp"));
}

// A new build types anew, and keeps what a person said: by skipping, and by another set of models.
TEST_F(PrimitiveRetype, SurvivesANewBuild) {
  const auto add = [&](int k) {
    Random random(static_cast<std::uint64_t>(k));
    fs::create_directories(folder_ / "models/bowl");
    ASSERT_TRUE(write_ply(folder_ / ("models/bowl/" + std::to_string(k) + ".ply"), sample_family("bowl", random).mesh));
  };
  const auto build = [&](const std::string& more = "") { return run_gfp("primitive build " + (folder_ / "models").string() + " --json --out " + folder() + " " + more).lines().at(0)["classes"][0]; };
  add(1), add(2);
  build();
  ASSERT_EQ(retype("bowl", "--set regular --vertices 10-29")["manual"].size(), 20U);
  const Primitive first = read("bowl");
  EXPECT_TRUE(build()["skipped"]);
  EXPECT_EQ(read("bowl").content_hash, first.content_hash);
  EXPECT_EQ(build("--force")["primitive"]["manual_types"], 20);
  EXPECT_EQ(read("bowl").content_hash, first.content_hash) << "the same models, the same words";
  add(3);
  const json changed = build();
  EXPECT_FALSE(changed["skipped"]);
  EXPECT_GE(changed["primitive"]["manual_types"], 10) << "each at the nearest place";
}

TEST_F(PrimitiveRetype, RefusesWhatItCannotDo) {
  const std::string mug = "primitive retype mug --primitives " + folder() + " ";
  EXPECT_EQ(run_gfp("primitive retype mug --set control --vertices 1").exit_code, 64) << "built-in primitives cannot be written";
  EXPECT_EQ(run_gfp(mug + "--set control").exit_code, 64);
  for (const char* vertices : {"99999", "3-", "5-3", "1,,2", "1,", "x", "-4", "18446744073709551616"}) {
    const auto result = run_gfp(mug + "--set control --vertices=" + vertices);
    EXPECT_EQ(result.exit_code, 64) << vertices;
    EXPECT_NE(result.err.find("expected indices in [0, "), std::string::npos) << result.err;
  }
  EXPECT_EQ(run_gfp(mug + "--set control --part lid").exit_code, 64);
  EXPECT_EQ(run_gfp(mug + "--set control --box 1,1,1,2,2,2").exit_code, 64) << "nothing is there";
  EXPECT_EQ(run_gfp("primitive retype kettledrum --list").exit_code, 64);
  EXPECT_FALSE(fs::exists(folder_ / "own/mug.gfp"));
}

}  // namespace
}  // namespace gfp
