#include "cli/exit_code.hpp"

#include <ostream>
#include <string>

namespace gfp {

ExitCode exit_code_of(const Error& error) {
  switch (error.code) {
    case ErrorCode::kInvalidArgument: return kExitUsage;
    case ErrorCode::kNotFound: return kExitNoInput;
    case ErrorCode::kCorruptData:
    case ErrorCode::kTooLarge:
    case ErrorCode::kUnsupported:
    case ErrorCode::kCorruptFrame:
    case ErrorCode::kTooFewPoints:
    case ErrorCode::kDegenerateGeometry: return kExitDataError;
    case ErrorCode::kTimeout:
    case ErrorCode::kPaused:
    case ErrorCode::kDeviceLost:
    case ErrorCode::kEndOfStream: return kExitUnavailable;
    case ErrorCode::kIo: return kExitIoError;
  }
  return kExitSoftware;
}

void ExitStatus::fail(std::ostream& err, const std::string& subject, const Error& error) {
  err << "gfp: " << subject << ": " << error.what << " (" << to_string(error.code) << ")\n";
  fail(exit_code_of(error));
}

}  // namespace gfp
