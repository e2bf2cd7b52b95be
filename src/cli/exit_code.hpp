#pragma once

#include <iosfwd>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// The exit codes of sysexits.h, as far as the commands use them.
enum ExitCode : int {
  kExitOk = 0,
  kExitUsage = 64,        ///< Wrong arguments.
  kExitDataError = 65,    ///< The input breaks its format.
  kExitNoInput = 66,      ///< The input does not exist or cannot be read.
  kExitUnavailable = 69,  ///< A device or peer is not there.
  kExitSoftware = 70,     ///< A bug of ours.
  kExitCannotCreate = 73, ///< An output file cannot be written.
  kExitIoError = 74,
  kExitConfig = 78,       ///< The configuration is wrong.
};

ExitCode exit_code_of(const Error& error);

/// An argument that names what does not exist (a method, a class) is a wrong argument, not a missing input.
inline Error as_argument(Error error) {
  error.code = ErrorCode::kInvalidArgument;
  return error;
}

/// What a command that goes on after an error ends with: the first error's code.
class ExitStatus {
 public:
  int code() const { return code_; }
  void fail(int code) { if (code_ == kExitOk) code_ = code; }

  /// Says `gfp: <subject>: <what> (<code>)` on `err` and remembers the exit code.
  void fail(std::ostream& err, const std::string& subject, const Error& error);

 private:
  int code_ = kExitOk;
};

}  // namespace gfp
