#pragma once

#include "simulation/render_scene.hpp"

namespace gfp {

/// The colour picture of a rendering: lit surfaces, smooth within 40 degrees of crease; black where nothing is hit.
Image<Rgb8> shade(const Rendering& rendering, const CameraModel& camera);

}  // namespace gfp
