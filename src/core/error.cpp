#include "gfp/core/error.hpp"

namespace gfp {

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument: return "invalid_argument";
    case ErrorCode::kNotFound: return "not_found";
    case ErrorCode::kCorruptData: return "corrupt_data";
    case ErrorCode::kTooLarge: return "too_large";
    case ErrorCode::kUnsupported: return "unsupported";
    case ErrorCode::kTimeout: return "timeout";
    case ErrorCode::kPaused: return "paused";
    case ErrorCode::kCorruptFrame: return "corrupt_frame";
    case ErrorCode::kDeviceLost: return "device_lost";
    case ErrorCode::kEndOfStream: return "end_of_stream";
    case ErrorCode::kTooFewPoints: return "too_few_points";
    case ErrorCode::kDegenerateGeometry: return "degenerate_geometry";
    case ErrorCode::kIo: return "io";
  }
  return "unknown";
}

}  // namespace gfp
