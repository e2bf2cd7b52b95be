#include "collection/find_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gfp/evaluation/surface_samples.hpp"
#include "gfp/evaluation/triangle_tree.hpp"

namespace gfp {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSamples = 600;
constexpr double kClearly = 0.5;  ///< A turn is a symmetry if it moves the surface by less than this share of what others do.
constexpr int kPlanes = 36;  ///< Mirror planes looked at over half a turn, then halved down to a tenth of a degree.

Matrix3d turn(double rad) { return Eigen::AngleAxisd(rad, Vector3d::UnitZ()).toRotationMatrix(); }

/// A shape and how far its surface is from itself moved.
class Mover {
 public:
  explicit Mover(const TriangleMesh& mesh) : tree_(mesh), samples_(sample_surface(mesh, kSamples, 1).points) {
    const Bounds box = bounds(mesh.vertices);
    centre_ = box.centre();
    longest_ = box.size().maxCoeff();
  }
  /// Mean distance, as a share of the longest side.
  double distance(const Matrix3d& motion) const {
    double sum = 0;
    for (const Vector3d& p : samples_) sum += tree_.closest(centre_ + motion * (p - centre_)).distance_m;
    return sum / static_cast<double>(std::max<std::size_t>(1, samples_.size())) / longest_;
  }

 private:
  TriangleTree tree_;
  std::vector<Vector3d> samples_;
  Vector3d centre_;
  double longest_ = 1;
};

Matrix3d mirror(double plane_yaw) { return turn(plane_yaw) * Vector3d(1, -1, 1).asDiagonal() * turn(-plane_yaw); }

}  // namespace

Symmetry find_symmetry(const TriangleMesh& mesh, double tolerance) {
  const Mover mover(mesh);
  const auto turned = [&](double rad) { return mover.distance(turn(rad)); };
  Symmetry symmetry;
  double worst = 0;
  for (const double rad : {std::numbers::pi / 4, 1.0, std::numbers::pi / 2}) worst = std::max(worst, turned(rad));
  symmetry.revolution = worst < tolerance;
  if (!symmetry.revolution) {
    for (const int n : {6, 5, 4, 3, 2}) {
      if (turned(2 * std::numbers::pi / n) > std::min(tolerance, kClearly * worst)) continue;  // what is nearly round looks alike at any turn
      symmetry.cyclic = n;
      break;
    }
  }
  symmetry.mirror_x = mover.distance(Vector3d(-1, 1, 1).asDiagonal()) < tolerance;
  symmetry.mirror_y = mover.distance(Vector3d(1, -1, 1).asDiagonal()) < tolerance;
  symmetry.flip_z = mover.distance(Vector3d(1, -1, -1).asDiagonal()) < tolerance;
  return symmetry;
}

double yaw_of_mirror_plane(const TriangleMesh& mesh) {
  const Mover mover(mesh);
  double best = 0, least = std::numeric_limits<double>::infinity(), step = std::numbers::pi / kPlanes;
  const auto look = [&](double yaw) {
    const double distance = mover.distance(mirror(yaw));
    if (distance < least - 1e-9) least = distance, best = yaw;
  };
  for (int k = 0; k < kPlanes; ++k) look(k * step);
  for (int k = 0; k < 6; ++k) {
    step *= 0.5;
    const double around = best;
    look(around - step);
    look(around + step);
  }
  const auto samples = sample_surface(mesh, kSamples, 1).points;
  Vector3d centroid = Vector3d::Zero();
  for (const Vector3d& p : samples) centroid += p / static_cast<double>(samples.size());
  const Vector3d along = turn(best) * Vector3d::UnitX(), middle = bounds(mesh.vertices).centre();
  // What reaches out is far from the bulk: the middle of the box lies on its side of the centroid.
  const bool reaches_forwards = along.dot(middle - centroid) >= 0;
  return -(reaches_forwards ? best : best + std::numbers::pi);
}

}  // namespace gfp
