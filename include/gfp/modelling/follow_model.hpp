#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

/// The same body at another pose, judged anew by what is seen now. Vertices that were seen before stay marked as seen, those that are
/// seen for the first time are marked too; their sigma stays what it was, for the shape did not learn from them.
FittedModel follow_model(const ObjectView& view, const FittedModel& before, const FollowedPose& pose);

}  // namespace gfp
