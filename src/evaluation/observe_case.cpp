#include "observe_case.hpp"

#include <memory>
#include <utility>

namespace gfp {
namespace {

constexpr double kLeastOverlap = 0.1;  // a segment that overlaps less is another thing

double overlap(const Segment& segment, const Image<std::uint8_t>& mask, int object_readings) {
  int common = 0;
  for (const std::int32_t pixel : segment.pixels) common += mask.pixels[static_cast<std::size_t>(pixel)] != 0 ? 1 : 0;
  const int all = object_readings + static_cast<int>(segment.pixels.size()) - common;
  return all > 0 ? static_cast<double>(common) / all : 0.0;
}

/// One frame of a case as the pipeline's front end sees it.
CaseObservation observe_frame(const MaskedFrame& shown, const PipelineOptions& options, bool mask_from_truth) {
  const Frame& frame = shown.frame;
  const OrganizedCloud cloud = depth_to_cloud(frame.depth, frame.camera, options.cloud);
  CaseObservation observation;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (shown.object_mask.pixels[i] != 0 && cloud.valid(i)) observation.points_camera.push_back(cloud.point(i).cast<double>());

  Segments segments = segment_cloud(cloud, options.segmentation, frame.up_camera, nullptr, mask_from_truth ? shown.object_mask : Image<std::uint8_t>{});
  std::size_t best = 0;
  for (std::size_t i = 0; i < segments.segments.size(); ++i) {
    const double iou = overlap(segments.segments[i], shown.object_mask, static_cast<int>(observation.points_camera.size()));
    if (iou <= observation.segment_iou) continue;
    observation.segment_iou = iou;
    best = i;
  }
  if (observation.segment_iou < kLeastOverlap) return observation;
  std::vector<PixelRect> regions;
  for (const Segment& segment : segments.segments) regions.push_back(segment.bbox);
  const NormalMap normals = estimate_normals(cloud, options.normals, regions);
  std::vector<ObjectView> views = associate(segments, cloud, normals, frame, {}, options.memory);
  observation.view = std::move(views[best]);
  return observation;
}

}  // namespace

CaseObservation observe_case(const EvaluationCase& shown, const PipelineOptions& options, bool mask_from_truth) {
  CaseObservation observation = observe_frame(shown, options, mask_from_truth);
  if (!observation.view) return observation;
  for (const MaskedFrame& other : shown.elsewhere) {
    CaseObservation seen = observe_frame(other, options, mask_from_truth);
    if (!seen.view) continue;
    observation.view->field.push_back({other.frame.T_world_sensor.inverse() * shown.frame.T_world_sensor, std::make_shared<const ObjectView>(std::move(*seen.view))});
  }
  return observation;
}

}  // namespace gfp
