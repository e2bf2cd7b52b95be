#pragma once

#include "gfp/core/error.hpp"
#include "gfp/grasp/grasp.hpp"
#include "gfp/v1/scene.pb.h"

namespace gfp::wire {

void fill(const Grasp& grasp, v1::Grasp& message);

/// Errors: kCorruptData (transforms, or not two contacts).
Result<Grasp> grasp_from(const v1::Grasp& message);

}  // namespace gfp::wire
