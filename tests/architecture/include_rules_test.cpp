// The flow of the tree, read from the #include lines: DESIGN's picture stays true, or this test says who broke it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace gfp {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Headers that are plain data or options: the products of their step, which later steps may read. Every other public
/// header is an algorithm, which only `whole` folders may call. core, frame and primitive are products throughout.
const Names kProducts{"cloud/organized_cloud", "segmentation/segments", "memory/object_view", "memory/object_points", "memory/scene_memory", "memory/object_field", "memory/associate_options", "memory/observed_tile", "memory/image_score",
                      "recognition/hypothesis", "registration/placement", "modelling/fitted_model", "selection/object_estimate", "grasp/grasp", "scene/scene"};
const Names kProductFolders{"core", "frame", "primitive"};

struct Rule {
  Names products;       ///< Folders whose products may be included, besides its own and core.
  Names algorithms;     ///< Folders of which everything may be included.
};

const Names kStages{"frame", "cloud", "segmentation", "primitive", "memory", "recognition", "registration", "modelling", "selection", "grasp", "scene"};

/// A row a folder, in the order of the flow.
const std::map<std::string, Rule> kRules{
    {"core", {{}, {}}},
    {"frame", {{}, {}}},
    {"cloud", {{"frame"}, {}}},
    {"segmentation", {{"cloud"}, {}}},
    {"primitive", {{}, {}}},
    {"memory", {{"frame", "cloud", "segmentation"}, {}}},
    {"recognition", {{"memory", "primitive"}, {}}},
    {"registration", {{"memory", "primitive", "recognition"}, {}}},
    {"modelling", {{"memory", "primitive", "recognition", "registration"}, {}}},
    {"selection", {{"memory", "primitive", "modelling"}, {}}},
    {"grasp", {{"memory", "primitive", "modelling"}, {}}},
    {"scene", {{"frame", "segmentation", "primitive", "memory", "modelling", "selection", "grasp"}, {}}},
    {"pipeline", {kStages, kStages}},
    {"simulation", {{"frame", "primitive"}, {}}},
};
// Folders behind the pipeline may know all of it; what they may not know is in kOwners.

/// Third-party things that one folder owns: nobody else includes them.
struct Owner {
  std::string pattern;
  Names folders;
};
const std::vector<Owner> kOwners{
    {R"(yaml-cpp/)", {"src/config"}},
    {R"(\.pb\.h)", {"src/wire", "src/publish", "src/client"}},
    {R"(zmq\.hpp|zmq\.h)", {"src/publish", "src/client"}},
    {R"(boost/beast)", {"src/view"}},
    {R"(CLI/)", {"src/cli", "src/daemon"}},
    {R"(spdlog/)", {"src/daemon"}},
    {R"(^png\.h$)", {"src/frame"}},
    {R"(^libfreenect)", {"drivers/freenect"}},
    {R"(^arv\.h$)", {"drivers/bumblebee"}},
    {R"(^jpeglib\.h$)", {"src/frame"}},
    {R"(^OniC|^Driver/Oni|^OpenNI)", {"drivers/openni2"}},
    // Stages stay pure functions: what they do in parallel are loops whose rounds share nothing.
    {R"(tbb/)", {"src/segmentation", "src/memory", "src/registration", "src/pipeline", "src/app", "src/daemon", "src/evaluation", "src/collection", "src/cli"}},
};

struct Include {
  fs::path file;       ///< Relative to the project.
  std::string folder;  ///< cloud, segmentation...; of drivers, `driver`.
  std::string target;  ///< As between the quotes or brackets.
};

fs::path root() { return GFP_SOURCE_DIR; }

std::string folder_of(const fs::path& file) {
  std::vector<std::string> parts;
  for (const fs::path& part : file) parts.push_back(part.string());
  return parts[0] == "include" ? parts[2] : parts[0] == "drivers" ? "driver" : parts[1];
}

std::vector<Include> includes_below(const std::vector<std::string>& tops) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  std::vector<Include> found;
  for (const std::string& top : tops) {
    if (!fs::exists(root() / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root() / top)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      const fs::path file = fs::relative(entry.path(), root());
      std::ifstream in(entry.path());
      std::smatch match;
      for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, kInclude)) found.push_back({file, folder_of(file), match[1]});
    }
  }
  return found;
}

/// `gfp/cloud/x.hpp` -> cloud, `cloud/x`; nothing for other includes.
struct PublicHeader {
  std::string folder, name;
};
std::optional<PublicHeader> public_header(const std::string& target) {
  static const std::regex kPublic(R"(^gfp/(([a-z_]+)/[a-z0-9_/]+)\.hpp$)");
  std::smatch match;
  if (!std::regex_match(target, match, kPublic)) return std::nullopt;
  return PublicHeader{match[2], match[1]};
}

bool allowed(const std::string& folder, const PublicHeader& header) {
  if (header.folder == folder || header.folder == "core") return true;
  const Rule& rule = kRules.at(folder);
  if (rule.algorithms.contains(header.folder)) return true;
  const bool product = kProductFolders.contains(header.folder) || kProducts.contains(header.name);
  return product && rule.products.contains(header.folder);
}

// A stage includes core and the products it consumes, never another stage's algorithm, never a later stage.
TEST(IncludeRules, DependenciesPointAlongTheFlow) {
  int checked = 0;
  for (const Include& include : includes_below({"include/gfp", "src"})) {
    const auto header = public_header(include.target);
    if (!header || !kRules.contains(include.folder)) continue;
    EXPECT_TRUE(allowed(include.folder, *header)) << include.file << " includes " << include.target;
    ++checked;
  }
  EXPECT_GT(checked, 100) << "the sources were not found below " << root();
}

// What lies in src/<folder> without a public header is that folder's own.
TEST(IncludeRules, PrivateHeadersStayPrivate) {
  for (const Include& include : includes_below({"include/gfp", "src"})) {
    const std::string owner = include.target.substr(0, include.target.find('/'));
    if (!kRules.contains(owner) || public_header(include.target) || include.target.find('/') == std::string::npos) continue;
    EXPECT_EQ(owner, include.folder) << include.file << " includes " << include.target;
  }
}

// A driver has never heard of a cloud: it makes Frames (the synthetic one from the simulation).
TEST(IncludeRules, DriversKnowFramesOnly) {
  for (const Include& include : includes_below({"drivers"})) {
    const auto header = public_header(include.target);
    if (!header) continue;
    EXPECT_TRUE(Names({"core", "frame", "simulation", "primitive", "recording"}).contains(header->folder)) << include.file << " includes " << include.target;
  }
}

TEST(IncludeRules, OneFolderOwnsEachForeignLibrary) {
  for (const Include& include : includes_below({"include/gfp", "src", "drivers"})) {
    for (const Owner& owner : kOwners) {
      if (!std::regex_search(include.target, std::regex(owner.pattern))) continue;
      const bool at_home = std::any_of(owner.folders.begin(), owner.folders.end(), [&](const std::string& home) { return include.file.string().starts_with(home + "/"); });
      EXPECT_TRUE(at_home) << include.file << " includes " << include.target;
    }
  }
}

}  // namespace
}  // namespace gfp
