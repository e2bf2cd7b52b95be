#include "app/run_input.hpp"

#include <chrono>
#include <string>
#include <utility>

namespace gfp {
namespace {

Result<void> put_mask(Frame& frame, const Image<std::uint8_t>& mask) {
  if (mask.empty()) return {};
  if (mask.width != frame.camera.width || mask.height != frame.camera.height)
    return failure(ErrorCode::kInvalidArgument, "mask is " + std::to_string(mask.width) + " x " + std::to_string(mask.height) + " pixels, expected the frame's " +
                                                    std::to_string(frame.camera.width) + " x " + std::to_string(frame.camera.height));
  frame.mask = mask;
  return {};
}

}  // namespace

void run_input(Input& input, const PrimitiveLibrary& library, const PipelineOptions& options, const Image<std::uint8_t>& mask, const InputVisitor& visit) {
  constexpr std::chrono::seconds kPatience{60};  // files do not time out; a stuck file system does
  SceneMemory memory;
  while (true) {
    Result<Frame> frame = input.source->grab(kPatience);
    if (!frame && frame.error().code == ErrorCode::kEndOfStream) return;
    if (!frame) {
      visit.error(frame.error());
      if (frame.error().code == ErrorCode::kTimeout || frame.error().code == ErrorCode::kDeviceLost) return;
      continue;
    }
    if (const auto masked = put_mask(*frame, mask); !masked) {
      visit.error(masked.error());
      continue;
    }
    PipelineResult result = process_frame(*frame, memory, library, options);
    visit.frame(*frame, input.report(), result);
    memory = std::move(result.memory);
  }
}

}  // namespace gfp
