#include "gfp/collection/build_primitive.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>

#include "gfp/collection/manual_layer.hpp"
#include "gfp/core/random.hpp"
#include "gfp/evaluation/triangle_tree.hpp"
#include "gfp/primitive/families.hpp"
#include "gfp/primitive/primitive_of_members.hpp"
#include "support/shapes.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {
namespace {

/// Members of a family, each turned about z and standing somewhere else: what a collection holds.
std::vector<CollectionModel> members_of(const std::string& family, int count) {
  std::vector<CollectionModel> models;
  for (int k = 0; k < count; ++k) {
    Random random(static_cast<std::uint64_t>(100 + k));
    TriangleMesh mesh = sample_family(family, random).mesh;
    mesh.vertices = transformed(mesh.vertices, Transform(Eigen::Translation3d(0.1 * k, 0.2, -0.3)) * Eigen::AngleAxisd(0.7 * k, Eigen::Vector3d::UnitZ()));
    models.push_back({family + std::to_string(k), std::move(mesh)});
  }
  return models;
}

void expect_sound(const Primitive& primitive, int genus) {
  const TriangleMesh mean{shape(primitive, primitive.typical_size_m()), primitive.topology->triangles};
  EXPECT_TRUE(examine_topology(mean).closed);
  EXPECT_EQ(count_self_intersections(mean), 0);
  EXPECT_EQ(primitive.genus, genus);
  EXPECT_TRUE(examine_topology({mean.vertices, primitive.topology->filled_triangles}).boundary_edges == 0);
  EXPECT_NEAR(bounds(mean.vertices).low.z(), 0, 1e-3);
  EXPECT_FALSE(primitive.stable_poses.empty());
  EXPECT_FALSE(primitive.contact_pairs.empty());
}

TEST(BuildPrimitive, AveragesBottles) {
  const auto models = members_of("bottle", 6);
  int last = 0, of = 0;
  const auto built = build_primitive("bottle", models, {}, [&](int done, int all) { last = done, of = all; });
  ASSERT_TRUE(built) << built.error().what;
  expect_sound(built->primitive, 0);
  EXPECT_EQ(last, of) << "progress ends at the end";
  EXPECT_TRUE(built->primitive.symmetry.revolution);
  EXPECT_LE(built->primitive.modes.size(), 5U) << "at most members - 1";
  EXPECT_GE(built->primitive.modes.size(), 1U);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& model : models) mean += bounds(model.mesh.vertices).size().array().log().matrix() / 6;
  EXPECT_NEAR(built->primitive.log_size_mean.z(), mean.z(), 0.05);
  for (const MemberReport& member : built->members) {
    EXPECT_TRUE(member.rejected.empty()) << member.name << ' ' << member.rejected;
    EXPECT_LT(member.residual, 0.01) << member.name;
  }
}

// A mug keeps its handle, whichever way its members stood, and is a vessel.
TEST(BuildPrimitive, KeepsTheHandleOfAMug) {
  const auto built = build_primitive("mug", members_of("mug", 5));
  ASSERT_TRUE(built) << built.error().what;
  const Primitive& mug = built->primitive;
  expect_sound(mug, 1);
  EXPECT_FALSE(mug.symmetry.revolution);
  EXPECT_TRUE(mug.symmetry.mirror_y) << "the handle lies in the mirror plane";
  EXPECT_TRUE(mug.hollow);
  const Bounds box = bounds(shape(mug, mug.typical_size_m()));
  EXPECT_GT(box.high.x(), 1.2 * -box.low.x()) << "the handle is at +x, the origin below the body";
  const TriangleMesh mean{shape(mug, mug.typical_size_m()), mug.topology->triangles};
  EXPECT_GT(signed_volume({mean.vertices, mug.topology->filled_triangles}), 1.5 * signed_volume(mean));
}

TEST(BuildPrimitive, LeavesOutWhatIsOfAnotherKindAndSaysWhy) {
  auto models = members_of("bowl", 4);
  models.push_back({"ring", test::torus(0.1, 0.03)});
  models.push_back({"nothing", {}});
  models.push_back({"damaged", {}, "line 3: no number"});
  const auto built = build_primitive("bowl", models);
  ASSERT_TRUE(built) << built.error().what;
  EXPECT_NE(built->members[4].rejected.find("genus 1"), std::string::npos) << built->members[4].rejected;
  EXPECT_NE(built->members[5].rejected.find("no triangles"), std::string::npos) << built->members[5].rejected;
  EXPECT_EQ(built->members[6].rejected, "line 3: no number");
  EXPECT_EQ(built->primitive.provenance.members, 4);
}

TEST(BuildPrimitive, NeedsTwoMembers) {
  const auto built = build_primitive("bowl", {members_of("bowl", 1)[0], {"nothing", {}}});
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().what.find("members kept = 1"), std::string::npos) << built.error().what;
  EXPECT_NE(built.error().what.find("no triangles"), std::string::npos);
}

TEST(BuildPrimitive, IsTheSameAtAnyThreadCount) {
  const auto models = members_of("mug", 4);
  const auto build_with = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return build_primitive("mug", models);
  };
  const auto first = build_with(1), second = build_with(2);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(wire::encode_primitive(first->primitive), wire::encode_primitive(second->primitive));
  for (std::size_t m = 0; m < models.size(); ++m) EXPECT_EQ(first->members[m].residual, second->members[m].residual);
}

// One sound shape and one so folded that the average with it crosses itself: the mean goes as far as it can, and so do its modes.
TEST(PrimitiveOfMembers, AMeanThatCrossesItselfIsKeptOnItsWay) {
  const TriangleMesh can = test::cylinder(0.03, 0.1, 24, 12);
  ClassMembers members;
  members.triangles = members.filled_triangles = can.triangles;
  members.parts.assign(can.vertices.size(), Part::kBody);
  members.shapes.assign(2, can.vertices);
  members.sizes_m.assign(2, bounds(can.vertices).size());
  members.sound = members.shapes[0];
  members.sound_size_m = members.sizes_m[0];
  std::vector<Eigen::Vector3d>& folded = members.shapes[1];  // one vertex of the wall pulled through the far side
  folded[3 * 24].x() -= 0.2;
  const Primitive primitive = primitive_of_members(members, {.name = "can", .class_name = "can", .aliases = {}, .symmetry = {}, .provenance = {}});
  std::vector<Eigen::Vector3d> plain = primitive.mean;
  for (std::size_t i = 0; i < plain.size(); ++i) plain[i] = 0.5 * (members.shapes[0][i].cwiseQuotient(members.sizes_m[0]) + folded[i].cwiseQuotient(members.sizes_m[1]));
  ASSERT_GT(count_self_intersections({plain, can.triangles}), 0) << "what the test is about";
  EXPECT_EQ(count_self_intersections({primitive.mean, can.triangles}), 0);
  for (std::size_t k = 0; k < primitive.modes.size(); ++k)
    for (const double sigma : {-2.0, 2.0}) {
      std::vector<double> modes(k + 1, 0.0);
      modes[k] = sigma;
      EXPECT_EQ(count_self_intersections({shape(primitive, primitive.typical_size_m(), modes), can.triangles}), 0) << k << ' ' << sigma;
    }
}

TEST(BuildPrimitive, OneModelIsAClassOfItsOwnWithWidePriors) {
  const auto built = build_primitive("bowl", members_of("bowl", 1));
  ASSERT_TRUE(built) << built.error().what;
  expect_sound(built->primitive, 0);
  EXPECT_TRUE(built->primitive.modes.empty());
  EXPECT_NEAR(built->primitive.log_size_covariance(0, 0), 0.15 * 0.15, 1e-6);
}

TEST(BuildPrimitive, StopsWhenAsked) {
  std::stop_source stop;
  std::vector<MemberReport> members;
  const auto built = build_primitive("bowl", members_of("bowl", 3), {}, [&](int, int) { stop.request_stop(); }, stop.get_token(), &members);
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().code, ErrorCode::kTimeout);
}

// What a person said of a vertex stays with it: at the same index, or at the nearest place of another mesh of the class.
TEST(CarryManualTypes, KeepsWhatAPersonSaid) {
  const auto models = members_of("bowl", 3);
  auto first = build_primitive("bowl", models), same = build_primitive("bowl", models), finer = build_primitive("bowl", models, {.vertices = 900});
  ASSERT_TRUE(first && same && finer);
  std::vector<std::optional<PointType>> manual(first->primitive.size());
  for (std::size_t i = 0; i < 20; ++i) manual[i] = i % 2 == 0 ? PointType::kControl : PointType::kRegular;
  set_manual_types(first->primitive, manual);
  EXPECT_EQ(carry_manual_types(first->primitive, same->primitive), 0);
  EXPECT_EQ(same->primitive.content_hash, first->primitive.content_hash);
  EXPECT_EQ(carry_manual_types(first->primitive, finer->primitive), 0);
  const auto& carried = finer->primitive.manual_types;
  EXPECT_GE(std::count_if(carried.begin(), carried.end(), [](const auto& type) { return type.has_value(); }), 15) << "two may meet at one vertex";
}

}  // namespace
}  // namespace gfp
