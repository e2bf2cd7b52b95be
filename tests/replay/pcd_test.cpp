#include "replay/pcd.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "replay/files.hpp"
#include "support/mutate.hpp"

namespace gfp {
namespace {

const CameraModel kCamera{48, 36, 60, 61, 23.5, 17.25, DistortionModel::kNone, {}};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Pcd, AllThreeDataKindsGiveTheSameCloud) {
  const test::DrawnCloud drawn = test::draw_wall(kCamera);
  for (const std::string& bytes : {test::ascii_pcd(drawn), test::binary_pcd(drawn), test::compressed_pcd(drawn)}) {
    const auto cloud = decode_pcd(bytes, "wall.pcd");
    ASSERT_TRUE(cloud.has_value()) << cloud.error().what;
    ASSERT_EQ(cloud->width, 48);
    ASSERT_EQ(cloud->height, 36);
    for (std::size_t i = 0; i < drawn.z.size(); ++i) {
      ASSERT_EQ(std::isnan(cloud->xyz[2][i]), std::isnan(drawn.z[i]));
      if (std::isnan(drawn.z[i])) continue;
      ASSERT_EQ(cloud->xyz[0][i], drawn.x[i]);  // shortest decimal form comes back to the same float
      ASSERT_EQ(cloud->xyz[1][i], drawn.y[i]);
      ASSERT_EQ(cloud->xyz[2][i], drawn.z[i]);
    }
    EXPECT_EQ(cloud->labels.pixels, drawn.label);
    EXPECT_EQ(cloud->color.at(5, 9), (Rgb8{5, 9, 7}));
  }
}

TEST(Pcd, ReadsOtherNumberTypesAndSkipsOtherFields) {
  std::string bytes =
      "VERSION .7\nFIELDS normal x y _ z\nSIZE 4 8 2 1 4\nTYPE F F I U F\nCOUNT 3 1 1 5 1\nWIDTH 1\nHEIGHT 2\nPOINTS 2\nDATA binary\n";
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) test::put(bytes, 9.0F);
    test::put(bytes, 1.5 + i), test::put(bytes, static_cast<std::int16_t>(-3));
    bytes += "abcde";
    test::put(bytes, 2.0F);
  }
  const auto cloud = decode_pcd(bytes, "odd.pcd");
  ASSERT_TRUE(cloud.has_value()) << cloud.error().what;
  EXPECT_EQ(cloud->xyz[0], (std::vector<float>{1.5F, 2.5F}));
  EXPECT_EQ(cloud->xyz[1], (std::vector<float>{-3, -3}));
  EXPECT_EQ(cloud->xyz[2], (std::vector<float>{2, 2}));
  EXPECT_TRUE(cloud->color.empty());
}

struct BadFile {
  const char* name;
  std::string bytes;
  ErrorCode code;
  const char* says;
};

TEST(Pcd, NamesWhatIsWrong) {
  const test::DrawnCloud drawn = test::draw_wall(kCamera);
  const std::string ascii = test::ascii_pcd(drawn), binary = test::binary_pcd(drawn), packed = test::compressed_pcd(drawn);
  const std::size_t packed_sizes = packed.find("binary_compressed\n") + 18;
  std::string bomb = packed;  // claims 480 MB from what it has
  bomb = replaced(replaced(replaced(bomb, "WIDTH 48", "WIDTH 8000"), "HEIGHT 36", "HEIGHT 3000"), "POINTS 1728", "POINTS 24000000");
  const std::uint32_t claimed = 480'000'000;
  std::memcpy(bomb.data() + bomb.find("binary_compressed\n") + 18 + 4, &claimed, 4);
  std::string short_packed = packed;
  const std::uint32_t too_long = 1U << 30U;
  std::memcpy(short_packed.data() + packed_sizes, &too_long, 4);
  const BadFile files[] = {
      {"empty", "", ErrorCode::kCorruptData, "not a PCD file"},
      {"text", "Hello\nworld\n", ErrorCode::kCorruptData, "unknown header line 'Hello'"},
      {"unorganised", replaced(replaced(binary, "WIDTH 48", "WIDTH 1728"), "HEIGHT 36", "HEIGHT 1"), ErrorCode::kUnsupported, "unorganised (1728 x 1)"},
      {"huge", replaced(replaced(binary, "WIDTH 48", "WIDTH 1000000000"), "HEIGHT 36", "HEIGHT 1000000000"), ErrorCode::kTooLarge, "1000000000 x 1000000000"},
      {"10000", replaced(replaced(binary, "WIDTH 48", "WIDTH 10000"), "HEIGHT 36", "HEIGHT 10000"), ErrorCode::kTooLarge, "at most 8192"},
      {"overflow", replaced(binary, "WIDTH 48", "WIDTH 99999999999999999999999"), ErrorCode::kCorruptData, "WIDTH = '999"},
      {"negative", replaced(binary, "WIDTH 48", "WIDTH -48"), ErrorCode::kCorruptData, "WIDTH = '-48'"},
      {"zero", replaced(binary, "WIDTH 48", "WIDTH 0"), ErrorCode::kCorruptData, "0 x 36"},
      {"points", replaced(binary, "POINTS 1728", "POINTS 1729"), ErrorCode::kCorruptData, "POINTS = 1729, expected 48 x 36"},
      {"count", replaced(binary, "COUNT 1 1 1 1 1", "COUNT 1 1 999999 1 1"), ErrorCode::kCorruptData, "COUNT of y"},
      {"record", replaced(binary, "COUNT 1 1 1 1 1", "COUNT 900 1 900 1 1"), ErrorCode::kTooLarge, "a point has"},
      {"size", replaced(binary, "SIZE 4 4 4 4 4", "SIZE 4 4 3 4 4"), ErrorCode::kCorruptData, "SIZE of y = '3'"},
      {"type", replaced(binary, "TYPE U F F F U", "TYPE U F Q F U"), ErrorCode::kCorruptData, "TYPE of y = 'Q'"},
      {"lists", replaced(binary, "TYPE U F F F U", "TYPE U F F F"), ErrorCode::kCorruptData, "expected 5"},
      {"no z", replaced(binary, "FIELDS label x y z rgba", "FIELDS label x y q rgba"), ErrorCode::kUnsupported, "no field z"},
      {"kind", replaced(binary, "DATA binary", "DATA zip"), ErrorCode::kCorruptData, "DATA = 'zip'"},
      {"cut binary", binary.substr(0, binary.size() - 1), ErrorCode::kCorruptData, "data = 34559 bytes, expected 34560"},
      {"cut ascii", ascii.substr(0, ascii.size() / 2), ErrorCode::kCorruptData, "expected a number of type"},
      {"short ascii", ascii.substr(0, ascii.find("DATA ascii\n") + 20), ErrorCode::kCorruptData, "expected at least"},
      {"word", replaced(ascii, "nan nan nan", "nan zero nan"), ErrorCode::kCorruptData, "field y = 'zero'"},
      {"cut packed", packed.substr(0, packed.size() - 9), ErrorCode::kCorruptData, "compressed data ="},
      {"no sizes", packed.substr(0, packed_sizes + 3), ErrorCode::kCorruptData, "ends before its data"},
      {"packed length", short_packed, ErrorCode::kCorruptData, "expected 1073741824"},
      {"bomb", bomb, ErrorCode::kCorruptData, "uncompressed size = 480000000 bytes, expected at most"},
  };
  for (const BadFile& file : files) {
    const auto cloud = decode_pcd(file.bytes, "bad.pcd");
    ASSERT_FALSE(cloud.has_value()) << file.name;
    EXPECT_EQ(cloud.error().code, file.code) << file.name << ": " << cloud.error().what;
    EXPECT_NE(cloud.error().what.find(file.says), std::string::npos) << file.name << ": " << cloud.error().what;
    EXPECT_TRUE(cloud.error().what.starts_with("bad.pcd: ")) << cloud.error().what;
  }
}

TEST(Pcd, DamagedFilesGiveAnErrorOrACloudNeverACrash) {
  const test::DrawnCloud drawn = test::draw_wall(kCamera);
  for (const std::string& valid : {test::ascii_pcd(drawn), test::binary_pcd(drawn), test::compressed_pcd(drawn)}) {
    int refused = 0;
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      const auto cloud = decode_pcd(test::mutated(valid, seed, 300), "damaged.pcd");
      if (!cloud) {
        ++refused;
        EXPECT_TRUE(cloud.error().what.starts_with("damaged.pcd: ")) << seed << ": " << cloud.error().what;
      } else {
        EXPECT_EQ(cloud->xyz[2].size(), static_cast<std::size_t>(cloud->width) * static_cast<std::size_t>(cloud->height)) << seed;
      }
    }
    EXPECT_GT(refused, 150);
  }
}

}  // namespace
}  // namespace gfp
