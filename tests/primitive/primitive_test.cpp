#include "gfp/primitive/primitive.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <map>
#include <set>

#include "gfp/primitive/content_hash.hpp"
#include "gfp/primitive/families.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "primitive/family_shape.hpp"

namespace gfp {
namespace {

class EveryPrimitive : public testing::TestWithParam<std::string> {
 protected:
  /// Built once a class: the tests only read it.
  const Primitive& primitive() const {
    static std::map<std::string, Primitive> built;
    const auto [entry, fresh] = built.try_emplace(GetParam());
    if (fresh) entry->second = build_family_primitive(GetParam());
    return entry->second;
  }
  TriangleMesh mesh(const std::vector<double>& modes = {}) const {
    return {shape(primitive(), primitive().typical_size_m(), modes), primitive().topology->triangles};
  }
};

TEST_P(EveryPrimitive, IsSoundAtTheMeanAndTwoSigmaAlongEveryMode) {
  const auto topology = examine_topology(mesh());
  EXPECT_TRUE(topology.closed);
  EXPECT_EQ(topology.euler_characteristic, 2 - 2 * primitive().genus);
  EXPECT_TRUE(examine_topology({mesh().vertices, primitive().topology->filled_triangles}).closed);
  EXPECT_EQ(count_self_intersections(mesh()), 0);
  for (std::size_t k = 0; k < primitive().modes.size(); ++k) {
    for (const double b : {-2.0, 2.0}) {
      std::vector<double> modes(k + 1, 0.0);
      modes[k] = b;
      EXPECT_EQ(count_self_intersections(mesh(modes), 1), 0) << "mode " << k << " at " << b << " sigma";
    }
  }
}

// The canonical frame is divided by the reference size: a body of revolution is a unit wide and high.
TEST_P(EveryPrimitive, IsCanonical) {
  const Bounds box = bounds(primitive().mean);
  EXPECT_NEAR(box.low.z(), 0, 0.02);
  EXPECT_NEAR(box.high.z(), 1, 0.2);
  EXPECT_LE(primitive().modes.size(), 8U);
  EXPECT_GE(primitive().modes.size(), 4U);
  EXPECT_TRUE(std::is_sorted(primitive().mode_sigma.rbegin(), primitive().mode_sigma.rend(), [](double a, double b) { return a < 0.8 * b; }));
  EXPECT_EQ(primitive().topology->types.size(), primitive().size());
  EXPECT_EQ(primitive().topology->parts.size(), primitive().size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(primitive().log_size_covariance);
  EXPECT_GT(spread.eigenvalues().minCoeff(), 0);
}

// Modes are orthogonal, since they are principal axes of the members.
TEST_P(EveryPrimitive, HasOrthogonalModes) {
  const auto dot = [&](std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t i = 0; i < primitive().size(); ++i) sum += primitive().modes[a][i].dot(primitive().modes[b][i]);
    return sum;
  };
  for (std::size_t a = 0; a < primitive().modes.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_LT(std::abs(dot(a, b)), 1e-6 * std::sqrt(dot(a, a) * dot(b, b)));
}

// Every vertex of a mirror-symmetric class has an exact partner in the mean and in all modes.
TEST_P(EveryPrimitive, KeepsItsMirrorPairs) {
  const auto check = [&](Eigen::Index axis) {
    const auto mirrored = [&](Eigen::Vector3d p) {
      p[axis] = -p[axis];
      return p;
    };
    for (std::size_t i = 0; i < primitive().size(); ++i) {
      std::size_t partner = 0;
      for (std::size_t j = 0; j < primitive().size(); ++j)
        if ((primitive().mean[j] - mirrored(primitive().mean[i])).squaredNorm() < (primitive().mean[partner] - mirrored(primitive().mean[i])).squaredNorm()) partner = j;
      ASSERT_LT((primitive().mean[partner] - mirrored(primitive().mean[i])).norm(), 1e-9) << "vertex " << i << " axis " << axis;
    }
  };
  if (primitive().symmetry.mirror_x) check(0);
  if (primitive().symmetry.mirror_y) check(1);
}

TEST_P(EveryPrimitive, RestsOnItsStablePoses) {
  double sum = 0;
  ASSERT_FALSE(primitive().stable_poses.empty());
  EXPECT_EQ(primitive().stable_poses[0].name, "upright");
  const TriangleMesh typical = mesh();
  for (const auto& pose : primitive().stable_poses) {
    sum += pose.probability;
    EXPECT_NEAR(pose.R_support_object.determinant(), 1, 1e-9);
    EXPECT_TRUE((pose.R_support_object * pose.R_support_object.transpose()).isIdentity(1e-9));
    // It stands on at least three points and its centre of mass is not beyond the farthest of them.
    const Eigen::Matrix3d& R = pose.R_support_object;
    double low = 1e9;
    for (const auto& p : typical.vertices) low = std::min(low, (R * p).z());
    const Eigen::Vector3d centre = R * volume_centroid(typical);
    Bounds feet;
    int count = 0;
    const double extent = bounds(typical.vertices).size().norm();
    for (const auto& p : typical.vertices) {
      if ((R * p).z() > low + 0.02 * extent) continue;
      feet.include(R * p);
      ++count;
    }
    EXPECT_GE(count, 3) << pose.name;
    EXPECT_GT(centre.x(), feet.low.x() - 1e-9) << pose.name;
    EXPECT_LT(centre.x(), feet.high.x() + 1e-9) << pose.name;
    EXPECT_GT(centre.y(), feet.low.y() - 1e-9) << pose.name;
    EXPECT_LT(centre.y(), feet.high.y() + 1e-9) << pose.name;
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST_P(EveryPrimitive, OffersAntipodalContacts) {
  const TriangleMesh typical = mesh();
  const auto normals = triangle_normals(typical);
  ASSERT_GE(primitive().contact_pairs.size(), 50U);
  for (const auto& pair : primitive().contact_pairs) {
    Eigen::Vector3d point[2];
    for (int side = 0; side < 2; ++side) {
      const auto& triangle = typical.triangles[static_cast<std::size_t>(pair.face[side])];
      point[side] = Eigen::Vector3d::Zero();
      EXPECT_NEAR(pair.barycentric[side].sum(), 1, 1e-12);
      EXPECT_GE(pair.barycentric[side].minCoeff(), -1e-12);
      for (std::size_t k = 0; k < 3; ++k) point[side] += pair.barycentric[side][static_cast<Eigen::Index>(k)] * typical.vertices[static_cast<std::size_t>(triangle[k])];
    }
    const Eigen::Vector3d line = (point[1] - point[0]).normalized();
    EXPECT_GT(normals[static_cast<std::size_t>(pair.face[1])].dot(line), 0.8);   // inside the cone
    EXPECT_LT(normals[static_cast<std::size_t>(pair.face[0])].dot(line), -0.999);  // against the normal
  }
}

// The sizes the class was built from lie around its prior: 3 sigma hold nearly all of a bounded distribution.
TEST_P(EveryPrimitive, CoversItsMembersSizes) {
  const Eigen::Matrix3d information = primitive().log_size_covariance.inverse();
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const Eigen::Vector3d off = sample_family(GetParam(), random).size_m.array().log().matrix() - primitive().log_size_mean;
    EXPECT_LT(off.dot(information * off), 25) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Classes, EveryPrimitive, testing::ValuesIn(family_names()), [](const auto& family) { return family.param; });

TEST(Primitive, BuildsTheSameTwiceAndHashesWhatItHolds) {
  const Primitive first = build_family_primitive("cup");
  Primitive second = build_family_primitive("cup");
  EXPECT_EQ(first.content_hash, second.content_hash);
  EXPECT_EQ(first.content_hash, content_hash(second));
  second.modes[0][3].x() += 1e-15;
  EXPECT_NE(first.content_hash, content_hash(second));
}

TEST(Primitive, ShapeIsMeanPlusModesTimesSize) {
  Primitive primitive;
  primitive.mean = {{1, 2, 3}};
  primitive.modes = {{{1, 0, 0}}, {{0, 1, 0}}};
  EXPECT_EQ(shape(primitive, {10, 100, 1000})[0], Eigen::Vector3d(10, 200, 3000));
  EXPECT_EQ(shape(primitive, {10, 100, 1000}, {2})[0], Eigen::Vector3d(30, 200, 3000));
  EXPECT_EQ(shape(primitive, {10, 100, 1000}, {2, -1, 7})[0], Eigen::Vector3d(30, 100, 3000));
}

TEST(PrimitiveLibrary, FindsByNameAndAlias) {
  const auto make = [](const char* name, const char* class_name, std::vector<std::string> aliases) {
    Primitive primitive;
    primitive.name = name;
    primitive.class_name = class_name;
    primitive.aliases = std::move(aliases);
    return std::make_shared<const Primitive>(primitive);
  };
  const PrimitiveLibrary library({make("shoe", "shoe", {}), make("jug", "jug", {"pitcher"}), make("cup", "cup", {"glass"}), make("boot", "shoe", {"wellington"})});
  EXPECT_EQ(library.all()[0]->name, "boot");
  EXPECT_EQ(library.find("pitcher")->class_name, "jug");
  EXPECT_EQ(library.find("glass")->class_name, "cup");
  EXPECT_EQ(library.find("boot")->name, "boot");
  EXPECT_EQ(library.find("spaceship"), nullptr);
  EXPECT_EQ(library.of_class("shoe").size(), 2U);
  EXPECT_EQ(library.of_class("boot").size(), 1U);
  EXPECT_EQ(library.of_class("wellington").front()->name, "boot");
  EXPECT_TRUE(library.of_class("spaceship").empty());
}

TEST(Families, HaveNamesAndAliasesOnce) {
  std::multiset<std::string> names;
  for (const auto& name : family_names()) {
    names.insert(name);
    for (const auto& alias : find_family(name)->aliases) names.insert(alias);
  }
  EXPECT_GE(family_names().size(), 24U);
  for (const auto& name : names) EXPECT_EQ(names.count(name), 1U) << name;
}

}  // namespace
}  // namespace gfp
