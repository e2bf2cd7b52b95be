#include "gfp/core/mesh_io.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace gfp {
namespace {

/// A directory of the test's own, removed with it.
class MeshIo : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("gfp_mesh_io_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& name, const std::string& content = {}) const {
    if (!content.empty()) std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  ErrorCode error_of(const std::string& name, const std::string& content, const ReadMeshOptions& options = {}) const {
    const auto mesh = read_mesh(file(name, content), options);
    EXPECT_FALSE(mesh.has_value()) << name << ":\n" << content.substr(0, 200);
    return mesh ? ErrorCode::kIo : mesh.error().code;
  }

  std::filesystem::path folder_;
};

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.125, -0.75}}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
}

void expect_equal(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

// Coordinates of the tetrahedron are short binary fractions, so that even float files keep them exactly.
TEST_F(MeshIo, WrittenMeshesComeBackTheSame) {
  const std::vector<Rgb8> colours(4, Rgb8{10, 200, 30});
  ASSERT_TRUE(write_obj(file("a.obj"), tetrahedron(), colours));
  ASSERT_TRUE(write_ply(file("a.ply"), tetrahedron(), colours));
  ASSERT_TRUE(write_ply(file("plain.PLY"), tetrahedron()));
  for (const char* name : {"a.obj", "a.ply", "plain.PLY"}) {
    const auto mesh = read_mesh(file(name));
    ASSERT_TRUE(mesh) << mesh.error().what;
    expect_equal(*mesh, tetrahedron());
  }
}

TEST_F(MeshIo, ReadsTheVariantsOfObj) {
  const auto mesh = read_mesh(file("quad.obj", "# a comment\r\nv 0 0 0 1 0 0\r\nv +1 0 0\nv 1 1 0\nv 0 1e0 0\nvn 0 0 1\nf 1/1/1 2//1 3 -1\n"));
  ASSERT_TRUE(mesh) << mesh.error().what;
  EXPECT_EQ(mesh->vertices.size(), 4U);
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(MeshIo, ReadsTheVariantsOfOff) {
  for (const char* text : {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF 3 1 0\n# c\n0 0 0\n\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n"}) {
    const auto mesh = read_mesh(file("a.off", text));
    ASSERT_TRUE(mesh) << mesh.error().what;
    expect_equal(*mesh, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  }
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const void* value, std::size_t size) { bytes.append(static_cast<const char*>(value), size); };
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  put(&count, 4);
  for (const auto& triangle : mesh.triangles) {
    bytes.append(12, '\0');
    for (const auto vertex : triangle) {
      const Eigen::Vector3f p = mesh.vertices[static_cast<std::size_t>(vertex)].cast<float>();
      put(p.data(), 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

TEST_F(MeshIo, JoinsTheCornersOfAnStl) {
  const auto mesh = read_mesh(file("a.stl", binary_stl(tetrahedron())));
  ASSERT_TRUE(mesh) << mesh.error().what;
  EXPECT_EQ(mesh->vertices.size(), 4U);
  EXPECT_TRUE(examine_topology(*mesh).closed);
  EXPECT_DOUBLE_EQ(signed_volume(*mesh), signed_volume(tetrahedron()));

  const auto ascii = read_mesh(file("b.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n vertex 0 1 0\nendloop\nendfacet\nendsolid\n"));
  ASSERT_TRUE(ascii) << ascii.error().what;
  EXPECT_EQ(ascii->triangles.size(), 1U);
}

TEST_F(MeshIo, ReadsAsciiAndBigEndianPly) {
  const std::string header = " 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
  const auto ascii = read_mesh(file("a.ply", "ply\nformat ascii" + header + "0 0 0 7\n1 0 0 7\n0 1 0 7\n3 0 1 2\n"));
  ASSERT_TRUE(ascii) << ascii.error().what;
  std::string body;
  for (const auto& p : ascii->vertices) {
    for (int axis = 0; axis < 3; ++axis) body += p[axis] == 1 ? std::string("\x3f\x80\0\0", 4) : std::string(4, '\0');
    body += '\x07';
  }
  body += std::string("\x03\0\0\0\0\0\0\0\x01\0\0\0\x02", 13);
  const auto big = read_mesh(file("b.ply", "ply\nformat binary_big_endian" + header + body));
  ASSERT_TRUE(big) << big.error().what;
  expect_equal(*big, *ascii);
}

TEST_F(MeshIo, RefusesWhatIsDamaged) {
  EXPECT_EQ(error_of("a.obj", "v 0 0\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.obj", "v 0 0 nan\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.obj", "v 0 0 1e999\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 1 0 1\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 1 -2 1\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.off", "OFF\n3000000000 1 0\n0 0 0\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.off", "OFF\n1 1 0\n0 0 0\n4000000000 0\n"), ErrorCode::kTooLarge);
  EXPECT_EQ(error_of("a.stl", binary_stl(tetrahedron()).substr(0, 200)), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n1234"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"), ErrorCode::kCorruptData);
  EXPECT_EQ(error_of("a.xyz", "0 0 0\n"), ErrorCode::kUnsupported);
  EXPECT_EQ(read_mesh(folder_ / "absent.obj").error().code, ErrorCode::kNotFound);
}

TEST_F(MeshIo, RefusesWhatIsBeyondItsBounds) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n";
  EXPECT_EQ(error_of("a.obj", three, {.max_vertices = 2}), ErrorCode::kTooLarge);
  EXPECT_EQ(error_of("a.obj", three, {.max_triangles = 1}), ErrorCode::kTooLarge);
  EXPECT_EQ(error_of("a.obj", three, {.max_file_bytes = 10}), ErrorCode::kTooLarge);
  EXPECT_EQ(error_of("a.stl", binary_stl(tetrahedron()), {.max_triangles = 3}), ErrorCode::kTooLarge);
}

// Every proper prefix of a binary file lacks bytes and must say so.
TEST_F(MeshIo, RefusesEveryTruncation) {
  ASSERT_TRUE(write_ply(file("whole.ply"), tetrahedron()));
  std::ifstream stream(file("whole.ply"), std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  for (std::size_t length = 1; length < whole.size(); length += 7)
    EXPECT_EQ(error_of("cut.ply", whole.substr(0, length)), ErrorCode::kCorruptData) << length << " bytes";
}

TEST_F(MeshIo, GlbIsWellFramedAndTurnsUpToY) {
  const auto glb = encode_glb(tetrahedron(), std::vector<Rgb8>(4));
  const auto word = [&](std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, glb.data() + at, 4);
    return value;
  };
  EXPECT_EQ(word(0), 0x46546C67U);  // "glTF"
  EXPECT_EQ(word(4), 2U);
  EXPECT_EQ(word(8), glb.size());
  const std::size_t json_bytes = word(12), bin = 20 + json_bytes;
  EXPECT_EQ(word(16), 0x4E4F534AU);  // "JSON"
  EXPECT_EQ(word(bin + 4), 0x004E4942U);  // "BIN"
  EXPECT_EQ(bin + 8 + word(bin), glb.size());
  float position[3];  // of vertex 3, behind the 4 triangles: (0.25, 0.125, -0.75) seen with y up
  std::memcpy(position, glb.data() + bin + 8 + 48 + 36, sizeof(position));
  EXPECT_EQ(position[0], 0.25F);
  EXPECT_EQ(position[1], -0.75F);
  EXPECT_EQ(position[2], -0.125F);
}

TEST_F(MeshIo, WritersRefuseColoursThatDoNotFit) {
  EXPECT_EQ(write_ply(file("a.ply"), tetrahedron(), std::vector<Rgb8>(3)).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(write_obj(folder_ / "no" / "such" / "folder.obj", tetrahedron()).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace gfp
