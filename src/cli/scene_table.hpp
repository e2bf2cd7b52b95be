#pragma once

#include <string>

#include "gfp/scene/scene.hpp"

namespace gfp {

/// A scene for a terminal: a heading and a line an object (id, class, pose in the camera frame, size, fit, best grasp).
std::string scene_table(const Scene& scene);

}  // namespace gfp
