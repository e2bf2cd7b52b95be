#include "gfp/primitive/families.hpp"

#include <gtest/gtest.h>

#include "primitive/family_shape.hpp"

namespace gfp {
namespace {

class EveryFamily : public testing::TestWithParam<std::string> {
 protected:
  const FamilySpec& spec() const { return *find_family(GetParam()); }
};

void expect_sound(const FamilyInstance& instance, int genus, const std::string& what) {
  const auto topology = examine_topology(instance.mesh);
  EXPECT_TRUE(topology.closed) << what;
  EXPECT_EQ(topology.components, 1) << what;
  EXPECT_EQ(topology.euler_characteristic, 2 - 2 * genus) << what;
  EXPECT_EQ(count_self_intersections(instance.mesh, 1), 0) << what;
  EXPECT_GT(signed_volume(instance.mesh), 0) << what;
  EXPECT_NEAR(bounds(instance.mesh.vertices).low.z(), 0, 1e-9) << what;
  EXPECT_EQ(instance.parts.size(), instance.mesh.vertices.size()) << what;
  const TriangleMesh filled{instance.mesh.vertices, instance.filled_triangles};
  EXPECT_TRUE(examine_topology(filled).closed) << what;
  EXPECT_EQ(count_self_intersections(filled, 1), 0) << what;
  EXPECT_GE(signed_volume(filled), 0.999 * signed_volume(instance.mesh)) << what;
}

TEST_P(EveryFamily, GivesClosedMeshesFreeOfIntersections) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    expect_sound(sample_family(GetParam(), random), spec().genus, GetParam() + ", seed " + std::to_string(seed));
    if (HasFailure()) break;
  }
}

TEST_P(EveryFamily, KeepsItsConnectivity) {
  Random random(1), other(2);
  const auto a = sample_family(GetParam(), random), b = sample_family(GetParam(), other);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.filled_triangles, b.filled_triangles);
  EXPECT_EQ(a.parts, b.parts);
  EXPECT_GE(a.mesh.vertices.size(), 380U);
  EXPECT_LE(a.mesh.vertices.size(), 1000U);
}

TEST_P(EveryFamily, StaysSoundWhenFinerAndBent) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    const auto bent = sample_family(GetParam(), random, {.free_form = 0.04});
    expect_sound(bent, spec().genus, GetParam() + ", bent, seed " + std::to_string(seed));
    const auto fine = sample_family(GetParam(), random, {.resolution = 2, .free_form = 0.04});
    expect_sound(fine, spec().genus, GetParam() + ", fine, seed " + std::to_string(seed));
    EXPECT_EQ(fine.mesh.triangles.size(), 4 * bent.mesh.triangles.size());
    if (HasFailure()) break;
  }
}

INSTANTIATE_TEST_SUITE_P(Families, EveryFamily, testing::ValuesIn(family_names()), [](const auto& family) { return family.param; });

}  // namespace
}  // namespace gfp
