// Every reader of bytes from outside, on whole files that are cut at every structural boundary and damaged at seeded places: an Error
// that names the source, or a value; never a crash, and never an allocation out of proportion to the bytes that were given.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "config/camera_file.hpp"
#include "config/daemon_options.hpp"
#include "fuzz/allocation_watch.hpp"
#include "gfp/collection/model_collection.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/frame/png.hpp"
#include "gfp/frame/read_file.hpp"
#include "gfp/primitive/families.hpp"
#include "replay/files.hpp"
#include "replay/pcd.hpp"
#include "replay/pclzf.hpp"
#include "replay/tum.hpp"
#include "support/mutate.hpp"
#include "support/shapes.hpp"
#include "support/temporary_folder.hpp"
#include "wire/bounded_parse.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {
namespace {

/// What came of the bytes: empty where they were accepted, else the error's text.
using Reader = std::function<std::string(const std::string& bytes)>;

struct Format {
  const char* name;
  std::string valid;
  Reader read;
  std::size_t header_bytes;    ///< Damage falls mostly here.
  bool cut_is_error = true;    ///< False: a prefix may be a whole file (text formats without an announced length).
  const char* source = "hostile";  ///< Every error names it.
};

/// A value of 1 MB may come from anywhere; beyond it, memory follows the bytes. LZF grows by 264 at most.
constexpr std::size_t kFreeBytes = 1U << 20U;
constexpr std::size_t kMostGrowth = 300;

template <class T>
std::string outcome(const Result<T>& result) { return result ? std::string() : result.error().what; }

class HostileBytes : public ::testing::Test {
 protected:
  /// A reader of files, through a file of this name.
  template <class Read>
  Reader file_reader(const std::string& name, Read read) const {
    return [this, name, read](const std::string& bytes) { return outcome(read(folder_.write(name, bytes))); };
  }
  std::string written(const std::string& name, const std::function<void(const std::filesystem::path&)>& write) const {
    write(folder_ / name);
    return *read_file(folder_ / name, 1U << 26U);
  }

  std::vector<Format> formats() const {
    const test::DrawnCloud cloud = test::draw_wall({48, 36, 60, 61, 23.5, 17.25, DistortionModel::kNone, {}});
    const Reader pcd = [](const std::string& bytes) { return outcome(decode_pcd(bytes, "hostile.pcd")); };
    Image<std::uint16_t> depth(40, 30);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) depth.pixels[i] = static_cast<std::uint16_t>(500 + i / 3);
    const TriangleMesh mesh = test::sphere(0.05, 10, 6);
    const auto read = [](const std::filesystem::path& path) { return read_mesh(path); };
    std::string off = "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
    std::string stl(80, 's'), ascii_ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    test::put(stl, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& v : mesh.vertices) off += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
    for (const auto& t : mesh.triangles) {
      off += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
      for (int k = 0; k < 12; ++k) test::put(stl, k < 3 ? 0.0F : static_cast<float>(mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k / 3 - 1)])][k % 3]));
      stl += std::string(2, '\0');
    }
    const std::string config = "threads: 2\nsensors:\n  - name: front\n    driver: replay\n    input: a.pcd\npipeline: {segmentation: {min_points: 100}, grasp: {seed: 3}}\nlog: {level: warn}\n";
    folder_.write("psb/m1.off", off);
    std::string cla = "PSB 1\n60 60\n", csv = "file,class,scale_to_m,up_axis\n";
    for (int k = 0; k < 60; ++k) cla += fmt::format("\nclass_{} 0 2\n1\n{}\n", k, k), csv += fmt::format("mug/{}.off,mug,0.01,y\n", k);
    const auto classes = [](const std::filesystem::path& path) { return find_model_classes(path.parent_path()); };
    const std::string camera = "width: 640\nheight: 480\nfx: 525\nfy: 525\ncx: 319.5\ncy: 239.5\ndepth_scale: 0.001\ndistortion: {model: plumb_bob, coefficients: [0.1, -0.2, 0, 0, 0]}\n";
    return {
        {"ascii PCD", test::ascii_pcd(cloud), pcd, 300, false},  // its last number may lose a digit
        {"binary PCD", test::binary_pcd(cloud), pcd, 300},
        {"compressed PCD", test::compressed_pcd(cloud), pcd, 300},
        {"pclzf", test::depth_pclzf(depth), file_reader("hostile.pclzf", read_pclzf_depth), 40},
        {"PNG", written("valid.png", [&](const auto& path) { ASSERT_TRUE(write_png(path, depth)); }), file_reader("hostile.png", read_png_depth), 60},
        {"OBJ", written("valid.obj", [&](const auto& path) { ASSERT_TRUE(write_obj(path, mesh)); }), file_reader("hostile.obj", read), 400, false},
        {"PLY", written("valid.ply", [&](const auto& path) { ASSERT_TRUE(write_ply(path, mesh)); }), file_reader("hostile.ply", read), 250},
        {"ascii PLY", ascii_ply, file_reader("hostile.ply", read), 200, false},
        {"OFF", off, file_reader("hostile.off", read), 40, false},
        {"STL", stl, file_reader("hostile.stl", read), 84},
        {"Princeton list", cla, file_reader("psb/hostile.cla", classes), 600, false, "psb"},
        {"table of meshes", csv, file_reader("table/meshes.csv", classes), 600, false, "table"},
        {"camera", camera, [](const std::string& bytes) { return outcome(config::parse_camera_file(bytes, "hostile.yaml")); }, 200, false},
        {"configuration", config, [](const std::string& bytes) { return outcome(config::parse_daemon_options(bytes, "hostile.yaml")); }, 200, false},
        {"primitive", wire::encode_primitive(build_family_primitive("ball")), [](const std::string& bytes) { return outcome(wire::decode_primitive(wire::as_bytes(bytes))); }, 400, true, ""},
    };
  }

  /// Reads, and judges the error's text and the memory.
  static bool refused(const Format& format, const std::string& bytes, const std::string& how) {
    const test::AllocationWatch watch;
    const std::string error = format.read(bytes);
    EXPECT_LE(watch.largest_bytes(), kFreeBytes + kMostGrowth * bytes.size()) << format.name << " " << how;
    if (!error.empty()) {
      EXPECT_NE(error.find(format.source), std::string::npos) << format.name << " " << how << ": " << error;
    }
    return !error.empty();
  }

  test::TemporaryFolder folder_;
};

TEST_F(HostileBytes, WholeFilesAreRead) {
  for (const Format& format : formats()) EXPECT_EQ(format.read(format.valid), "") << format.name;
}

// Every byte of a header is a boundary of something; behind it, 200 places are taken evenly, and the last ten bytes.
TEST_F(HostileBytes, CutsAreErrors) {
  for (const Format& format : formats()) {
    const std::size_t size = format.valid.size();
    std::vector<std::size_t> lengths;
    for (std::size_t length = 0; length < std::min(size, format.header_bytes); ++length) lengths.push_back(length);
    for (std::size_t k = 0; k < 200; ++k) lengths.push_back(k * size / 200);
    for (std::size_t k = 1; k <= 10; ++k) lengths.push_back(size - k);
    for (const std::size_t length : lengths) {
      const bool error = refused(format, format.valid.substr(0, length), "cut to " + std::to_string(length));
      if (format.cut_is_error) {
        EXPECT_TRUE(error) << format.name << " cut to " << length << " of " << size << " bytes was accepted";
      }
    }
  }
}

TEST_F(HostileBytes, DamageIsAnErrorOrAValue) {
  for (const Format& format : formats()) {
    int errors = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) errors += refused(format, test::mutated(format.valid, seed, format.header_bytes), "seed " + std::to_string(seed)) ? 1 : 0;
    EXPECT_GT(errors, 40) << format.name;
  }
}

// Ten thousand pixels a side, claimed by a header with next to nothing behind it.
TEST_F(HostileBytes, ClaimedSizesAreRefusedBeforeAllocation) {
  const auto claims = [](std::string bytes, std::size_t at, std::string with) { return bytes.replace(at, with.size(), with); };
  const std::string pcd = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT {0}\nPOINTS {1}\nDATA {2}\nxxxxxxxxxxxx";
  for (const Format& format : formats()) {
    std::vector<std::string> huge;
    if (std::string(format.name).ends_with("PCD"))
      for (const char* kind : {"ascii", "binary", "binary_compressed"})
        for (const long side : {8192L, 10'000L, 4'000'000'000L}) huge.push_back(fmt::format(fmt::runtime(pcd), side, static_cast<unsigned long>(side) * static_cast<unsigned long>(side), kind));
    if (std::string(format.name) == "PNG") huge.push_back(claims(format.valid, 16, std::string("\0\0\x27\x10\0\0\x27\x10", 8)));
    if (std::string(format.name) == "pclzf") huge.push_back(claims(format.valid, 5, std::string("\x10\x27\0\0\x10\x27\0\0", 8)));
    if (std::string(format.name) == "STL") huge.push_back(claims(format.valid, 80, std::string("\xff\xff\xff\xff", 4)));
    if (std::string(format.name) == "OFF") huge.push_back("OFF\n2000000000 2000000000 0\n0 0 0\n");
    for (const std::string& bytes : huge) EXPECT_TRUE(refused(format, bytes, "claim")) << format.name;
  }
}

// A recording's lists name files below its own folder and nothing else.
TEST_F(HostileBytes, TumListsAreNotTrusted) {
  const std::string valid = "# depth\n1305031453.374112 depth/a.png\n1305031453.404816 depth/b.png\n1305031453.436941 depth/c.png\n";
  const auto list = [&](const std::string& text) {
    folder_.write("depth.txt", text);
    return list_tum_folder(folder_.path());
  };
  ASSERT_TRUE(list(valid));
  EXPECT_EQ(list("1.0 ../../etc/passwd\n").error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(list("1.0 /etc/passwd\n").error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(list("later depth/a.png\n").error().code, ErrorCode::kCorruptData);
  EXPECT_FALSE(list(""));
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const test::AllocationWatch watch;
    const auto entries = list(test::mutated(valid, seed, valid.size()));
    EXPECT_LE(watch.largest_bytes(), kFreeBytes);
    if (!entries) {
      EXPECT_FALSE(entries.error().what.empty());
      continue;
    }
    for (const ReplayEntry& entry : *entries) EXPECT_TRUE(entry.depth.string().starts_with(folder_.path().string())) << entry.depth;
  }
}

}  // namespace
}  // namespace gfp
