#include "gfp/memory/object_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "gfp/memory/associate.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSpare = 2;          ///< Views kept beyond those that a fit looks at.
constexpr double kSamples = 500;           ///< Readings that are looked up in the other view, about.
constexpr double kPastM = 0.012;           ///< Edges waver and mixed pixels float: nearer than that a reading is no contradiction.
constexpr double kMostPast = 0.15;         ///< Share of an object's readings that the other camera may see past.
constexpr int kLeastCommon = 30;           ///< Readings of the same surface that say whether it is in the same place...
constexpr double kCommonReachM = 0.03;     ///< ... of which farther ones are another surface.
constexpr double kApartM = 0.004;          ///< Median distance along the normal beyond which it is not.
constexpr float kSameFacing = 0.7F;        ///< Cosine between the normals of one surface seen twice.

/// What one view's readings are to the other.
struct Comparison {
  int looked_up = 0, past = 0;
  std::vector<double> apart_m;  ///< Where both see the surface.
};

/// Looks the readings of `from` up in `in`.
void compare(const ObjectView& from, const Transform& T_in_from, const ObjectView& in, Comparison& result) {
  const int step = std::max(1, static_cast<int>(std::lround(std::sqrt(from.object_pixels / kSamples))));
  const Eigen::Matrix3f turn = T_in_from.linear().cast<float>();
  for (int j = 0; j < from.tile.height(); j += step) {
    for (int i = 0; i < from.tile.width(); i += step) {
      if (from.evidence.at(i, j) != Evidence::kObject) continue;
      const Vector3d point = T_in_from * Vector3d(from.camera.ray(from.tile.u0 + i, from.tile.v0 + j) * static_cast<double>(from.depth_m.at(i, j)));
      if (point.z() <= 0) continue;
      const Eigen::Vector2d pixel = in.camera.project(point);
      const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
      if (u < 0 || v < 0 || u >= in.camera.width || v >= in.camera.height) continue;
      if (!in.tile.contains(u, v)) {  // far beside the object; where it is cut it may go on there
        if (in.occluded || in.touches_border) continue;
        ++result.looked_up;
        ++result.past;
        continue;
      }
      const double reading = static_cast<double>(in.depth_m.at(u - in.tile.u0, v - in.tile.v0));
      if (!(reading > 0)) continue;
      ++result.looked_up;
      const double behind = reading - point.z();
      result.past += behind > kPastM + 3 * in.noise.sigma_m(reading) ? 1 : 0;
      if (in.evidence.at(u - in.tile.u0, v - in.tile.v0) != Evidence::kObject || std::abs(behind) > kCommonReachM) continue;
      const Eigen::Vector3f normal = turn * from.normals.at(i, j), other = in.normals.at(u - in.tile.u0, v - in.tile.v0);
      if (normal.dot(other) > kSameFacing) result.apart_m.push_back(std::abs(behind * static_cast<double>(other.dot(in.camera.ray(u, v).cast<float>()))));
    }
  }
}

bool contradicts(const ObjectView& view, const ObjectView& other, const Transform& T_other_view) {
  Comparison comparison;
  compare(other, T_other_view.inverse(), view, comparison);
  compare(view, T_other_view, other, comparison);
  if (comparison.past > kMostPast * comparison.looked_up) return true;
  auto& apart = comparison.apart_m;
  if (apart.size() < kLeastCommon) return false;
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
  std::nth_element(apart.begin(), middle, apart.end());
  return *middle > kApartM;
}

/// From the sensor to the object, world frame, unit.
Vector3d direction_world(const Transform& T_world_sensor, const ObjectView& view) { return (T_world_sensor.linear() * seen_centre(view)).normalized(); }

double angle(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

ObjectField::const_iterator find_standpoint(const ObjectField& field, const std::string& sensor, const Transform& T_world_sensor) {
  return std::find_if(field.begin(), field.end(), [&](const FieldView& old) { return old.sensor == sensor && same_pose(old.T_world_sensor, T_world_sensor); });
}

/// Between two views from one standpoint.
bool has_moved(const ObjectView& now, const ObjectView& before) { return contradicts(now, before, Transform::Identity()); }

}  // namespace

Vector3d seen_centre(const ObjectView& view) {
  Vector3d sum = Vector3d::Zero();
  for (int j = 0; j < view.tile.height(); ++j)
    for (int i = 0; i < view.tile.width(); ++i)
      if (view.evidence.at(i, j) == Evidence::kObject) sum += view.camera.ray(view.tile.u0 + i, view.tile.v0 + j) * static_cast<double>(view.depth_m.at(i, j));
  return sum / std::max(1, view.object_pixels);
}

ObjectField remember_view(ObjectField field, const std::string& sensor, const Transform& T_world_sensor, const ObjectView& view,
                          const AssociateOptions& options) {
  if (options.field_views == 0) return {};
  const double least = options.field_angle_deg * std::numbers::pi / 180;
  const Vector3d direction = direction_world(T_world_sensor, view);
  const auto entry = [&]() -> FieldView {
    ObjectView alone = view;
    alone.field.clear();
    alone.warm_start.reset();
    return {sensor, T_world_sensor, std::make_shared<const ObjectView>(std::move(alone)), direction};
  };
  if (const auto old = find_standpoint(field, sensor, T_world_sensor); old != field.end()) {
    if (same_within_noise(view, *old->view, options)) return field;
    if (has_moved(view, *old->view)) return {entry()};
    field[static_cast<std::size_t>(old - field.begin())] = entry();
    return field;
  }
  const bool known = std::any_of(field.begin(), field.end(), [&](const FieldView& old) { return angle(direction, old.direction_world) < least; });
  if (known) return field;
  field.push_back(entry());
  if (field.size() > static_cast<std::size_t>(options.field_views) + kSpare) field.erase(field.begin());
  return field;
}

std::vector<Sighting> sightings(const ObjectField& field, const std::string& sensor, const Transform& T_world_sensor, const ObjectView& view,
                                const AssociateOptions& options) {
  struct Choice {
    const FieldView* seen;
    double apart;  ///< Angle to the nearest direction that is looked from already.
  };
  const double least = options.field_angle_deg * std::numbers::pi / 180;
  const Vector3d own = direction_world(T_world_sensor, view);
  std::vector<Choice> open;
  for (const FieldView& seen : field)
    if (const double apart = angle(own, seen.direction_world); apart >= least) open.push_back({&seen, apart});
  if (open.empty()) return {};  // a sensor alone, as a rule
  if (const auto old = find_standpoint(field, sensor, T_world_sensor); old != field.end() && has_moved(view, *old->view)) return {};
  std::vector<Sighting> chosen;
  while (chosen.size() < static_cast<std::size_t>(options.field_views)) {
    const auto farthest = std::max_element(open.begin(), open.end(), [](const Choice& a, const Choice& b) { return a.apart < b.apart; });
    if (farthest == open.end() || farthest->apart < least) break;
    const FieldView& seen = *farthest->seen;
    open.erase(farthest);
    const Transform T_sighting_camera = seen.T_world_sensor.inverse() * T_world_sensor;
    if (contradicts(view, *seen.view, T_sighting_camera)) continue;
    for (Choice& other : open) other.apart = std::min(other.apart, angle(other.seen->direction_world, seen.direction_world));
    chosen.push_back({T_sighting_camera, seen.view});
  }
  return chosen;
}

}  // namespace gfp
