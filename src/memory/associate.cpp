#include "gfp/memory/associate.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "memory/cut_view.hpp"
#include "memory/footprint.hpp"
#include "memory/optimal_assignment.hpp"

namespace gfp {
namespace {

/// REP 103 optical: y points down, so an upright camera's up is -y.
Eigen::Vector3d guess_up(const Frame& frame, const SceneMemory& memory) {
  if (frame.up_camera) return frame.up_camera->normalized();
  if (const auto& last = memory.of(frame.sensor).last_support) return last->T_camera_support.linear().col(2);
  return -Eigen::Vector3d::UnitY();
}

/// The frame's sensor as it last saw the object, if it has not moved since.
const SensorTrack* from_same_standpoint(const Track& track, const Frame& frame) {
  const SensorTrack* seen = track.seen_by(frame.sensor);
  return seen && same_pose(seen->T_world_sensor, frame.T_world_sensor) ? seen : nullptr;
}

/// How many of the pixels where an object was each segment holds now.
std::vector<int> overlaps(const SensorTrack& seen, const Segments& segments) {
  std::vector<int> counts(segments.segments.size(), 0);
  for (const std::int32_t pixel : seen.pixels) {
    if (static_cast<std::size_t>(pixel) >= segments.labels.pixels.size()) continue;  // the image was larger then
    const std::int32_t label = segments.labels.pixels[static_cast<std::size_t>(pixel)];
    if (label >= 0) ++counts[static_cast<std::size_t>(label)];
  }
  return counts;
}

/// 1 at the same place and height, 0 a step away. Out of sight, an object may have gone up to three steps.
double nearness(const Track& track, const Eigen::Vector3d& centre_world, double height_m, const AssociateOptions& options) {
  const double reach_m = options.max_step_m * std::min(3, 1 + track.last().missed_frames);
  const double distance_m = (centre_world - track.centre_world).norm();
  if (distance_m >= reach_m) return 0;
  const double high = std::max(height_m, track.height_m), low = std::min(height_m, track.height_m);
  return (1 - distance_m / reach_m) * (high > 0 ? std::max(low, 0.0) / high : 1.0);
}

/// Share of the view's points inside the body that was fitted, a little enlarged: from another side other points are seen, of the same body.
double share_inside(const Track& track, const ObjectView& view, const Transform& T_world_sensor) {
  constexpr double kGrowth = 0.1, kMarginM = 0.01;
  constexpr int kStep = 3;
  if (!track.last().object) return 0;
  const Transform T_object_camera = (track.T_world_fit * track.fit.T_camera_object).inverse() * T_world_sensor;
  const Eigen::Vector3d size = (1 + kGrowth) * track.fit.scale + Eigen::Vector3d::Constant(2 * kMarginM);
  int all = 0, inside = 0;
  for (int j = 0; j < view.tile.height(); j += kStep) {
    for (int i = 0; i < view.tile.width(); i += kStep) {
      if (view.evidence.at(i, j) != Evidence::kObject) continue;
      const Eigen::Vector3d p = T_object_camera * Eigen::Vector3d(view.camera.ray(view.tile.u0 + i, view.tile.v0 + j) * static_cast<double>(view.depth_m.at(i, j)));
      const bool level = std::abs(p.x()) < 0.5 * size.x() && std::abs(p.y()) < 0.5 * size.y();
      ++all;
      inside += level && p.z() > -kMarginM && p.z() < size.z() - kMarginM ? 1 : 0;
    }
  }
  return static_cast<double>(inside) / std::max(1, all);
}

/// Views x tracks; 0 where the two cannot be one object.
std::vector<double> affinities(const std::vector<ObjectView>& views, const Segments& segments, const Frame& frame,
                               const SceneMemory& memory, const AssociateOptions& options) {
  std::vector<double> affinity(views.size() * memory.tracks.size(), 0.0);
  std::vector<Eigen::Vector3d> centres;
  for (const ObjectView& view : views) centres.push_back(frame.T_world_sensor * seen_centre(view));
  for (std::size_t t = 0; t < memory.tracks.size(); ++t) {
    const Track& track = memory.tracks[t];
    const SensorTrack* before = from_same_standpoint(track, frame);
    const std::vector<int> overlap = before ? overlaps(*before, segments) : std::vector<int>(views.size(), 0);
    const auto pixels_before = static_cast<double>(before ? before->pixels.size() : 0);
    for (std::size_t s = 0; s < views.size(); ++s) {
      const double either = static_cast<double>(segments.segments[s].pixels.size()) + pixels_before - overlap[s];
      const double iou = either > 0 ? overlap[s] / either : 0;
      const double near = nearness(track, centres[s], views[s].height_m, options);
      const double value = iou + (before ? near : std::max(near, share_inside(track, views[s], frame.T_world_sensor)));
      affinity[s * memory.tracks.size() + t] = value >= options.min_affinity ? value : 0;
    }
  }
  return affinity;
}

bool same_sightings(const std::vector<Sighting>& a, const std::vector<Sighting>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Sighting& x, const Sighting& y) { return x.view == y.view; });
}

void recall(ObjectView& view, const Track& track, const Frame& frame, const AssociateOptions& options) {
  view.id = track.id;
  view.field = sightings(track.field, frame.sensor, frame.T_world_sensor, view, options);
  if (!track.last().object) return;
  view.warm_start = track.fit;
  view.warm_start->T_camera_object = frame.T_world_sensor.inverse() * track.T_world_fit * track.fit.T_camera_object;
  const SensorTrack* before = from_same_standpoint(track, frame);
  view.unchanged = before && before->fitted_view && same_sightings(view.field, before->fitted_view->field) && same_within_noise(view, *before->fitted_view, options);
}

/// Outlines of all other segments on each view's support plane; most frames have one plane, so they are made once.
void add_footprints(std::vector<ObjectView>& views, const Segments& segments, const OrganizedCloud& cloud) {
  const auto outlines_on = [&](const Transform& T_camera_support) {
    std::vector<std::vector<Eigen::Vector2d>> outlines;
    for (const Segment& segment : segments.segments) outlines.push_back(footprint(segment, cloud, T_camera_support));
    return outlines;
  };
  std::vector<std::vector<std::vector<Eigen::Vector2d>>> of_plane(segments.planes.size());
  for (ObjectView& view : views) {
    if (!view.has_support) continue;  // on a guessed plane an outline would be a guess too
    auto& outlines = of_plane[static_cast<std::size_t>(segments.segments[static_cast<std::size_t>(view.segment)].support)];
    if (outlines.empty()) outlines = outlines_on(view.T_camera_support);
    for (std::size_t s = 0; s < outlines.size(); ++s)
      if (static_cast<int>(s) != view.segment && outlines[s].size() >= 3) view.neighbour_footprints.push_back(outlines[s]);
  }
}

}  // namespace

std::vector<ObjectView> associate(const Segments& segments, const OrganizedCloud& cloud, const NormalMap& normals,
                                  const Frame& frame, const SceneMemory& memory, const AssociateOptions& options) {
  const Eigen::Vector3d up_camera = guess_up(frame, memory);
  std::vector<ObjectView> views(segments.segments.size());
  oneapi::tbb::parallel_for(std::size_t{0}, views.size(),
                            [&](std::size_t s) { views[s] = cut_view(segments, static_cast<int>(s), cloud, normals, frame, up_camera, options); });

  const std::vector<int> track_of = optimal_assignment(affinities(views, segments, frame, memory, options),
                                                       static_cast<int>(views.size()), static_cast<int>(memory.tracks.size()));
  std::uint64_t next_id = memory.next_id;
  for (std::size_t s = 0; s < views.size(); ++s) {
    if (track_of[s] >= 0) {
      recall(views[s], memory.tracks[static_cast<std::size_t>(track_of[s])], frame, options);
    } else {
      views[s].id = next_id++;
    }
  }
  add_footprints(views, segments, cloud);
  return views;
}

}  // namespace gfp
