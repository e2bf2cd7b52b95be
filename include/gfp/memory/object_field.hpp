#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gfp/core/transform.hpp"
#include "gfp/memory/associate_options.hpp"
#include "gfp/memory/object_view.hpp"

namespace gfp {

/// An object as one sensor saw it from one standpoint.
struct FieldView {
  std::string sensor;
  Transform T_world_sensor = Transform::Identity();
  std::shared_ptr<const ObjectView> view;  ///< Its own `field` is empty.
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitX();  ///< From the sensor to the object's readings, unit: asked in every frame, and `view` is large.
};

/// All that is kept of how an object looks from around, oldest first: views from directions apart from each other. Whole views and no voxels: each
/// keeps its readings to the last bit, its own noise, silhouette and free space, and k views of standing sensors cost k tiles.
using ObjectField = std::vector<FieldView>;

/// The field after `view` by `sensor`. A view from the standpoint of an old one takes its place, unless it shows the same within noise (then the
/// old one stays, to the last bit); one from a new direction joins; one from between is left out. Where the old view from that standpoint shows that
/// the object has moved, all others go. At most options.field_views + 2 are kept.
ObjectField remember_view(ObjectField field, const std::string& sensor, const Transform& T_world_sensor, const ObjectView& view,
                          const AssociateOptions& options = {});

/// What of the field a fit of `view` should look at: at most options.field_views, the directions farthest apart first, none that `view`
/// contradicts; nothing where the old view from its own standpoint is contradicted, for then the object has moved. Contradicted is what the object would have to be in two places for: surface where the other camera sees past, or surfaces
/// that both see and that lie apart.
std::vector<Sighting> sightings(const ObjectField& field, const std::string& sensor, const Transform& T_world_sensor, const ObjectView& view,
                                const AssociateOptions& options = {});

/// Whether a sensor stands where it stood: both T_world_sensor.
inline bool same_pose(const Transform& a, const Transform& b) { return a.isApprox(b, 1e-9); }

/// Centre of the object's readings, camera frame, metres.
Eigen::Vector3d seen_centre(const ObjectView& view);

}  // namespace gfp
