// gfp primitive build: a collection made of our own families' members, exported as files.
#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "cli/command.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/core/random.hpp"
#include "gfp/frame/png.hpp"
#include "gfp/frame/read_file.hpp"
#include "gfp/primitive/families.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::run_gfp;

class PrimitiveBuild : public testing::Test {
 protected:
  void add_members(const std::string& family, int count, const std::string& class_name) const {
    fs::create_directories(folder_ / ("models/" + class_name));
    for (int k = 0; k < count; ++k) {
      Random random(static_cast<std::uint64_t>(7 + k));
      const fs::path stem = folder_ / ("models/" + class_name + "/" + std::to_string(k));
      const TriangleMesh mesh = sample_family(family, random).mesh;
      ASSERT_TRUE(k % 2 == 0 ? write_obj(stem.string() + ".obj", mesh) : write_ply(stem.string() + ".ply", mesh));
    }
  }
  std::string arguments() const { return "primitive build " + (folder_ / "models").string() + " --out " + out().string(); }
  fs::path out() const { return folder_ / "out"; }
  json build(const std::string& more = "") const {
    const auto result = run_gfp(arguments() + " --json " + more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.lines().at(0);
  }
  static std::string bytes(const fs::path& file) { return read_file(file, 1U << 26U).value_or(""); }

  test::TemporaryFolder folder_;
};

TEST_F(PrimitiveBuild, MakesPrimitivesAPageAndReasons) {
  add_members("bowl", 3, "bowl");
  folder_.write("models/bowl/damaged.off", "OFF\n3 1 0\n0 0 0\n1 0 zero\n");
  folder_.write("models/dust/a.stl", "solid nothing\nendsolid\n");
  const json result = build();
  ASSERT_EQ(result["classes"].size(), 2U);
  const json &bowl = result["classes"][0], &dust = result["classes"][1];
  EXPECT_EQ(bowl["class"], "bowl");
  EXPECT_EQ(bowl["primitive"]["provenance"]["members"], 3);
  EXPECT_TRUE(bowl["primitive"]["hollow"]);
  EXPECT_LT(bowl["typing_ms"], 1000);
  const json& damaged = bowl["members"][3];
  EXPECT_FALSE(damaged["kept"]);
  EXPECT_NE(damaged["reason"].get<std::string>().find("damaged.off, line 4"), std::string::npos) << damaged;
  EXPECT_TRUE(dust["primitive"].is_null());
  EXPECT_NE(dust["reason"].get<std::string>().find("a.stl"), std::string::npos) << dust;

  const auto primitive = wire::read_primitive(out() / "bowl.gfp");
  ASSERT_TRUE(primitive) << primitive.error().what;
  EXPECT_FALSE(primitive->training_views.descriptors.empty()) << "recognition finds them in the file";
  EXPECT_FALSE(fs::exists(out() / "dust.gfp"));
  const std::string page = bytes(out() / "report/index.html");
  for (const char* text : {"bowl/sheet.png", "bowl/symmetry.png", "bowl/member_003.png", "damaged.off, line 4", "refused:"}) EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_GE(read_png_header(out() / "report/bowl/sheet.png")->width, 900);
  EXPECT_TRUE(read_png_header(out() / "report/bowl/member_003.png")) << "what is left out has a picture too";
}

TEST_F(PrimitiveBuild, BuildsOnlyWhatChanged) {
  add_members("bowl", 2, "bowl");
  add_members("can", 2, "can");
  EXPECT_FALSE(build()["classes"][0]["skipped"]);
  const std::string can = bytes(out() / "can.gfp");
  add_members("bowl", 3, "bowl");
  const json again = build();
  EXPECT_FALSE(again["classes"][0]["skipped"]) << "a third bowl";
  EXPECT_TRUE(again["classes"][1]["skipped"]);
  EXPECT_FALSE(build("--vertices 500")["classes"][1]["skipped"]) << "other options";
  fs::remove(out() / "can.gfp");
  EXPECT_FALSE(build()["classes"][1]["skipped"]) << "its file is gone";
  EXPECT_EQ(bytes(out() / "can.gfp"), can) << "the same models give the same bytes";
}

// Interrupted after its first class, it ends cleanly; another run finishes the rest.
TEST_F(PrimitiveBuild, GoesOnAfterAnInterrupt) {
  for (const char* name : {"a", "b", "c", "d", "e"}) add_members("bowl", 3, name);
  int code = -1;
  std::jthread run([&] { code = run_gfp(arguments() + " & echo $! >" + (folder_ / "pid").string() + "; wait $!").exit_code; });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!fs::exists(out() / "report/a.json") && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  ASSERT_EQ(kill(std::stoi(bytes(folder_ / "pid")), SIGTERM), 0);
  run.join();
  EXPECT_EQ(code, 130);
  for (const auto& entry : fs::directory_iterator(out())) EXPECT_NE(entry.path().extension(), ".unfinished");
  const json rest = build();
  EXPECT_TRUE(rest["classes"][0]["skipped"]);
  EXPECT_FALSE(rest["classes"][4]["skipped"]);
}

TEST_F(PrimitiveBuild, SaysWhatItExpected) {
  EXPECT_EQ(run_gfp("primitive build " + (folder_ / "nowhere").string()).exit_code, 66);
  fs::create_directories(folder_ / "models");
  const auto empty = run_gfp(arguments());
  EXPECT_EQ(empty.exit_code, 66);
  EXPECT_NE(empty.err.find("meshes.csv"), std::string::npos) << empty.err;
  add_members("can", 2, "can");
  EXPECT_EQ(run_gfp(arguments() + " --only kettledrum").exit_code, 66);
  EXPECT_EQ(run_gfp(arguments() + " --vertices 7").exit_code, 64);
}

}  // namespace
}  // namespace gfp
