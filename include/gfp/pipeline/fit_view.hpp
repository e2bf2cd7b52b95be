#pragma once

#include <optional>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/pipeline/stage_timings.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "gfp/selection/select_models.hpp"

namespace gfp {

/// All that options.method has to say about one object: every fit that `selection` should choose from. Empty where the method finds nothing.
///
/// gfp_robust: recognise -> register every hypothesis -> contour of the best few placements (by registration cost), and a
/// superquadric where that may win. A view with a warm start keeps its shape and is only moved; every budget.reshape_every fits, or when
/// the shape no longer fits, that class alone (or the superquadric) is fitted; every budget.search_every fits, or when that no longer
/// fits either, all classes are. superquadric: that alone.
/// Pure and single-threaded; `timings` takes the milliseconds of each stage where it is given.
/// Errors: kNotFound for an unknown method, naming the known ones.
Result<std::vector<Candidate>> fit_view(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options = {},
                                        StageTimings* timings = nullptr);

/// The same for an object that is alone in its scene: the fit that `selection` chooses; nothing where the method finds none. Same errors.
Result<std::optional<ObjectEstimate>> fit_object(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options = {},
                                                 StageTimings* timings = nullptr);

/// Whether the view's last fit is to be followed, rather than all classes searched anew.
bool is_tracked(const ObjectView& view, const FitBudgetOptions& options = {});

}  // namespace gfp
