#pragma once

#include <functional>

#include "app/input.hpp"
#include "gfp/pipeline/process_frame.hpp"

namespace gfp {

/// What is told of every frame of an input, in order.
struct InputVisitor {
  std::function<void(const Frame&, const FrameReport&, const PipelineResult&)> frame;
  std::function<void(const Error&)> error;  ///< A frame that could not be read: the next ones follow.
};

/// Processes all frames of the input, one after the other and without dropping any; what is known of one frame serves the next.
/// `mask`: empty, or of the frames' size (else every frame is an error).
void run_input(Input& input, const PrimitiveLibrary& library, const PipelineOptions& options, const Image<std::uint8_t>& mask, const InputVisitor& visit);

}  // namespace gfp
