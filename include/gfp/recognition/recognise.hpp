#pragma once

#include <string>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "gfp/recognition/hypothesis.hpp"

namespace gfp {

struct RecognitionOptions {
  int max_hypotheses = 6;        ///< Primitives in a stable pose that registration tries.
  std::string only_class;        ///< Non-empty: the class is known (`--class`).
};

template <class Visitor>
void visit_fields(RecognitionOptions& o, Visitor&& field) {
  field("max_hypotheses", o.max_hypotheses, 1, 64);
  field("only_class", o.only_class);
}

/// The classes worth a fit, most probable first, each with the stable poses worth a try.
std::vector<Hypothesis> recognise(const ObjectView& view, const PrimitiveLibrary& library, const RecognitionOptions& options = {});

}  // namespace gfp
