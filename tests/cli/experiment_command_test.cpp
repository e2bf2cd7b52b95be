// gfp experiment: the paper's claims, each in its smallest form.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "cli/command.hpp"

namespace gfp {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::run_gfp;

json experiment(const std::string& arguments) {
  const CommandResult result = run_gfp("experiment " + arguments + " --instances 1 --views 1 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

const json& row(const json& experiment, const std::string& name) {
  for (const json& r : experiment["rows"])
    if (r["name"] == name) return r;
  throw std::out_of_range(name);
}

// P29: from the generic shape the contour arrives in fewer iterations than from a sphere, and nearer to the truth.
TEST(ExperimentCommand, EnergyFallsFasterFromTheGenericShape) {
  const test::TemporaryFolder folder;
  const json result = experiment("energy --elevation 35,60 --report " + (folder / "report").string());
  const json &gfp = row(result, "gfp, +-normal"), &sphere = row(result, "sphere, +-normal");
  EXPECT_LT(2 * gfp["iterations"].get<double>(), sphere["iterations"].get<double>());
  EXPECT_GT(gfp["iou_filled"], sphere["iou_filled"]);
  EXPECT_GT(gfp["fit_similarity"], sphere["fit_similarity"]);
  ASSERT_EQ(result["curves"].size(), 2U);
  for (const json& curve : result["curves"]) EXPECT_LT(curve["energies"].back(), 0.5 * curve["energies"].front().get<double>()) << curve["name"];
  for (const char* file : {"index.html", "experiment.json", "curves.csv"}) EXPECT_TRUE(std::filesystem::exists(folder / "report" / file)) << file;
  std::ifstream page(folder / "report" / "index.html");
  const std::string html{std::istreambuf_iterator<char>(page), {}};
  EXPECT_NE(html.find("<polyline"), std::string::npos);
  EXPECT_NE(html.find("680 ms"), std::string::npos);  // what the paper printed
}

// P30, Table 1: a generic shoe fits what is seen better than a superquadric.
TEST(ExperimentCommand, AGenericShoeFitsBetterThanASuperquadric) {
  const json result = experiment("shoe --elevation 35");
  for (const char* key : {"experiment", "question", "machine", "commit", "seed", "views", "timed", "rows", "curves"}) EXPECT_TRUE(result.contains(key)) << key;
  EXPECT_GT(row(result, "gfp_robust")["fit_similarity"], 0.9);
  EXPECT_LT(row(result, "superquadric")["fit_similarity"], row(result, "gfp_robust")["fit_similarity"]);
  EXPECT_GT(row(result, "gfp_robust")["iou_filled"], row(result, "multi_superquadric")["iou_filled"]);
  EXPECT_EQ(row(result, "superquadric")["paper"], "4.79 s, fit 0.7689");
}

TEST(ExperimentCommand, NamesWhatItKnowsAndWhatIsMissing) {
  const CommandResult unknown = run_gfp("experiment boat");
  EXPECT_EQ(unknown.exit_code, 64);
  EXPECT_NE((unknown.err + unknown.out).find("mug,shoe,energy,speed"), std::string::npos);
  const test::TemporaryFolder empty;
  EXPECT_EQ(run_gfp("experiment mug " + empty.path().string()).exit_code, 66);
}

}  // namespace
}  // namespace gfp
