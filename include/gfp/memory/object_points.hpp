#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/memory/object_view.hpp"

namespace gfp {

/// The readings of the object's own pixels, row by row: camera frame, metres, every one of them (P9).
std::vector<Eigen::Vector3f> object_points(const ObjectView& view);

}  // namespace gfp
