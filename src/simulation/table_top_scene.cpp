#include "gfp/simulation/table_top_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gfp/core/random.hpp"
#include "gfp/primitive/families.hpp"
#include "simulation/footprint.hpp"
#include "simulation/settle.hpp"

namespace gfp {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr std::array<Rgb8, 10> kPalette{{{196, 64, 56}, {62, 118, 188}, {226, 178, 60}, {84, 150, 84}, {150, 92, 168},
                                         {228, 126, 60}, {72, 164, 168}, {206, 206, 210}, {176, 104, 120}, {116, 124, 150}}};

/// Uniformly distributed orientation (Shoemake 1992).
Matrix3d random_rotation(Random& random) {
  const double u = random.uniform(), a = random.uniform(0, 2 * std::numbers::pi), b = random.uniform(0, 2 * std::numbers::pi);
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

/// Upright as it was set down, or as it comes to rest after a fall that it did not stand up from.
Matrix3d resting_orientation(const TriangleMesh& mesh, bool dropped, Random& random) {
  const Vector3d centre = volume_centroid(mesh);
  const auto is_upright = [](const Matrix3d& rotation) { return rotation(2, 2) > 0.9; };
  Matrix3d rotation = settle(mesh.vertices, centre, Matrix3d::Identity());
  constexpr int kFalls = 16;
  for (int fall = 0; dropped && is_upright(rotation) && fall < kFalls; ++fall) rotation = settle(mesh.vertices, centre, random_rotation(random));
  const Matrix3d yaw = Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), Vector3d::UnitZ()).toRotationMatrix();
  return yaw * rotation;
}

/// An object at rest that has yet to find its place.
struct Resting {
  PlacedMesh object;
  Polygon footprint;  ///< With T_world_object's translation at x = y = 0.
};

Resting make_resting(const std::string& family, int index, const TableTopOptions& options, Random& random) {
  SampleFamilyOptions family_options;
  family_options.free_form = options.free_form;
  FamilyInstance instance = sample_family(family, random, family_options);
  Resting resting;
  PlacedMesh& object = resting.object;
  object.name = family + (index < 10 ? "_0" : "_") + std::to_string(index);
  object.class_name = std::move(instance.class_name);
  object.mesh = std::move(instance.mesh);
  object.color = kPalette[static_cast<std::size_t>(index) % kPalette.size()];
  object.T_world_object.linear() = resting_orientation(object.mesh, random.uniform() < options.resting_otherwise, random);
  std::vector<Vector2d> outline;
  double lowest = 1e300;
  for (const Vector3d& vertex : object.mesh.vertices) {
    const Vector3d p = object.T_world_object.linear() * vertex;
    lowest = std::min(lowest, p.z());
    outline.emplace_back(p.head<2>());
  }
  object.T_world_object.translation().z() = -lowest;
  resting.footprint = convex_hull(std::move(outline));
  return resting;
}

Polygon moved(Polygon polygon, const Vector2d& by) {
  for (Vector2d& corner : polygon) corner += by;
  return polygon;
}

/// Finds places on the table, one object after the other.
class Placer {
 public:
  Placer(const TableTopOptions& options, Random random) : options_(options), random_(random), radius_m_(std::max(0.16, 0.1 * std::sqrt(options.objects))) {}

  Vector2d place(const Polygon& footprint) {
    const bool touching = !placed_.empty() && random_.uniform() < options_.clutter;
    for (int attempt = 1;; ++attempt) {
      const Vector2d at = touching && attempt < kTouchAttempts ? beside_another(footprint) : anywhere();
      Polygon there = moved(footprint, at);
      const double gap_m = touching ? kSmallestGap_m : 0.01 + 0.04 * (1 - options_.clutter);
      if (is_free(there, gap_m)) {
        placed_.push_back(std::move(there));
        return at;
      }
      if (attempt % kAttemptsBeforeGrowing == 0) radius_m_ *= 1.1;
    }
  }

  /// Half the size of what the objects cover, about the origin.
  Vector2d extent() const {
    Vector2d half = Vector2d::Zero();
    for (const Polygon& polygon : placed_)
      for (const Vector2d& corner : polygon) half = half.cwiseMax(corner.cwiseAbs());
    return half;
  }

 private:
  static constexpr int kTouchAttempts = 60, kAttemptsBeforeGrowing = 40;
  static constexpr double kSmallestGap_m = 0.001, kLargestTouchGap_m = 0.003;

  Vector2d anywhere() { return {random_.uniform(-1.25, 1.25) * radius_m_, random_.uniform(-1, 1) * radius_m_}; }

  /// Slid towards one of the others until a small gap is left.
  Vector2d beside_another(const Polygon& footprint) {
    const Polygon& other = placed_[static_cast<std::size_t>(random_.below(static_cast<int>(placed_.size())))];
    const double angle = random_.uniform(0, 2 * std::numbers::pi), gap_m = random_.uniform(kSmallestGap_m, kLargestTouchGap_m);
    Vector2d centre = Vector2d::Zero();
    for (const Vector2d& corner : other) centre += corner / static_cast<double>(other.size());
    const Vector2d direction(std::cos(angle), std::sin(angle));
    double near = 0, far = 2.0;  // metres: no two objects are larger
    for (int i = 0; i < 24; ++i) {
      const double middle = 0.5 * (near + far);
      (separation(moved(footprint, centre + middle * direction), other) < gap_m ? near : far) = middle;
    }
    return centre + far * direction;
  }

  bool is_free(const Polygon& footprint, double gap_m) const {
    return std::all_of(placed_.begin(), placed_.end(), [&](const Polygon& other) { return separation(footprint, other) >= gap_m; });
  }

  const TableTopOptions& options_;
  Random random_;
  double radius_m_;  ///< Half depth of the part of the table that is used; grows until everything fits.
  std::vector<Polygon> placed_;
};

std::vector<std::string> known_classes(const std::vector<std::string>& wanted) {
  const std::vector<std::string> families = family_names();
  if (wanted.empty()) return families;
  std::vector<std::string> known;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(known),
               [&](const std::string& name) { return std::find(families.begin(), families.end(), name) != families.end(); });
  return known;
}

}  // namespace

VirtualScene table_top_scene(const TableTopOptions& options, std::uint64_t seed) {
  VirtualScene scene;
  const Random random(seed);
  const std::vector<std::string> classes = known_classes(options.classes);
  Placer placer(options, random.fork(0));
  for (int i = 0; i < options.objects && !classes.empty(); ++i) {
    Random object_random = random.fork(static_cast<std::uint64_t>(i) + 1);
    const std::string& family = classes[static_cast<std::size_t>(object_random.below(static_cast<int>(classes.size())))];
    Resting resting = make_resting(family, i, options, object_random);
    resting.object.T_world_object.translation().head<2>() = placer.place(resting.footprint);
    scene.objects.push_back(std::move(resting.object));
  }
  constexpr double kMargin_m = 0.08;
  scene.table_half_x_m = std::max(scene.table_half_x_m, placer.extent().x() + kMargin_m);
  scene.table_half_y_m = std::max(scene.table_half_y_m, placer.extent().y() + kMargin_m);
  return scene;
}

}  // namespace gfp
