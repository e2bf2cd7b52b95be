#include "evaluation/mesh_table.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "gfp/core/mesh_io.hpp"
#include "gfp/evaluation/voxel_solid.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

class MeshTable : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / ("mesh_table_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& text) const {
    const auto file = folder_ / "meshes.csv";
    std::ofstream(file) << text;
    return file;
  }
  std::filesystem::path folder_;
};

TEST_F(MeshTable, FindsItsColumnsByNameAndKeepsQuotedCommas) {
  const auto entries = read_mesh_table(write("licence,file,up_axis,class,scale_to_m\r\n\"a, \"\"b\"\"\",cup/a.obj,y,cup,0.01\r\n\nMIT,mug/b.obj,z,mug,1\n"));
  ASSERT_TRUE(entries.has_value());
  ASSERT_EQ(entries->size(), 2U);
  EXPECT_EQ((*entries)[0].file, "cup/a.obj");
  EXPECT_EQ((*entries)[0].class_name, "cup");
  EXPECT_EQ((*entries)[0].scale_to_m, 0.01);
  EXPECT_EQ((*entries)[0].up_axis, 'y');
  EXPECT_EQ((*entries)[1].class_name, "mug");
}

TEST_F(MeshTable, SaysWhatIsWrongAndWhere) {
  const auto error_of = [&](const std::string& text) { return read_mesh_table(write(text)).error(); };
  EXPECT_EQ(read_mesh_table(folder_ / "none.csv").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(error_of("").code, ErrorCode::kCorruptData);
  EXPECT_NE(error_of("file,class,up_axis\n").what.find("scale_to_m"), std::string::npos);
  EXPECT_NE(error_of("file,class,scale_to_m,up_axis\na,b,1,z\na,b,-1,z\n").what.find(":3: scale_to_m = -1"), std::string::npos);
  EXPECT_NE(error_of("file,class,scale_to_m,up_axis\na,b,1e,z\n").what.find("scale_to_m = 1e"), std::string::npos);
  EXPECT_NE(error_of("file,class,scale_to_m,up_axis\na,b,1,w\n").what.find("up_axis = w"), std::string::npos);
  EXPECT_EQ(error_of("file,class,scale_to_m,up_axis\na,b\n").code, ErrorCode::kCorruptData);
}

// A box 0.4 long in y, up axis y: on the table it is 0.4 high.
TEST_F(MeshTable, ObjectsStandUprightOnTheOrigin) {
  TriangleMesh mesh = test::box({0.1, 0.4, 0.2});
  for (auto& v : mesh.vertices) v = 1000 * (v + Eigen::Vector3d(3, 4, 5));
  ASSERT_TRUE(write_obj(folder_ / "box.obj", mesh).has_value());
  const auto objects = load_objects(folder_, {"box.obj", "box", 0.001, 'y'});
  ASSERT_TRUE(objects.has_value());
  ASSERT_EQ(objects->size(), 1U);
  const Bounds box = bounds(objects->front().vertices);
  EXPECT_LT((box.low - Eigen::Vector3d(-0.05, -0.1, 0)).norm(), 1e-6);
  EXPECT_LT((box.high - Eigen::Vector3d(0.05, 0.1, 0.4)).norm(), 1e-6);
  EXPECT_GT(signed_volume(objects->front()), 0) << "a turn, not a mirror";
  EXPECT_EQ(load_objects(folder_, {"box.obj", "box", 1, 'y'}).error().code, ErrorCode::kTooLarge);
}

TEST_F(MeshTable, APairIsSplitIntoGroupsOfPartsThatTouch) {
  const auto at = [](TriangleMesh mesh, double x, double z) {
    for (auto& v : mesh.vertices) v += Eigen::Vector3d(x, 0, z);
    return mesh;
  };
  TriangleMesh pair;
  for (const double x : {-0.2, 0.2}) {
    append(pair, at(test::box({0.1, 0.1, 0.02}), x, 0));     // sole
    append(pair, at(test::sphere(0.03), x, 0.04));           // strap, a part of its own inside the sole's bounds
  }
  ASSERT_TRUE(write_obj(folder_ / "slippers_pair.obj", pair).has_value());
  ASSERT_TRUE(write_obj(folder_ / "slippers.obj", pair).has_value());
  const auto two = load_objects(folder_, {"slippers_pair.obj", "shoe", 1, 'z'}), one = load_objects(folder_, {"slippers.obj", "shoe", 1, 'z'});
  ASSERT_TRUE(two.has_value() && one.has_value());
  ASSERT_EQ(two->size(), 2U);
  EXPECT_EQ(one->size(), 1U);
  for (const TriangleMesh& shoe : *two) {
    EXPECT_EQ(examine_topology(shoe).components, 2);
    EXPECT_LT(bounds(shoe.vertices).centre().head<2>().norm(), 1e-6);
  }
}

TEST(StoodUp, TurnsACupThatLiesAndLeavesTheRest) {
  const TriangleMesh cup = test::revolve({{0.04, 0}, {0.04, 0.1}, {0.036, 0.1}, {0.036, 0.005}}, 48);
  Transform lying = Transform::Identity();
  lying.linear() = rotation_from_vector({0, 1.5707963267948966, 0});
  bool turned = false;
  const TriangleMesh stood = stood_up(transformed(cup, lying), turned);
  EXPECT_TRUE(turned);
  EXPECT_NEAR(bounds(stood.vertices).size().z(), 0.1, 1e-9);
  EXPECT_TRUE(fill_solid(on_origin(stood))->filled.contains({0, 0, 0.08}));
  stood_up(cup, turned);
  EXPECT_FALSE(turned);
  stood_up(test::box({0.1, 0.05, 0.02}), turned);
  EXPECT_FALSE(turned);
}

TEST(SplitGroups, WeldsTheVerticesThatAFileRepeats) {
  TriangleMesh loose;  // every triangle with corners of its own
  const TriangleMesh box = test::box({0.1, 0.1, 0.1});
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<std::int32_t>(loose.vertices.size());
    for (const std::int32_t corner : t) loose.vertices.push_back(box.vertices[static_cast<std::size_t>(corner)]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_FALSE(examine_topology(loose).closed);
  const auto groups = split_groups(loose);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_TRUE(examine_topology(groups.front()).closed);
}

}  // namespace
}  // namespace gfp
