#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace gfp {

/// What a caller can do differently; few on purpose. The person's explanation is in Error::what.
enum class ErrorCode {
  kInvalidArgument,   ///< Bad configuration, option or call: fix the value that `what` names.
  kNotFound,          ///< A file, device, class or method that does not exist.
  kCorruptData,       ///< A file or message that breaks its format: skip it.
  kTooLarge,          ///< A size beyond our bounds, refused before anything was allocated.
  kUnsupported,       ///< Well-formed, but not something we read (an unorganised cloud, say).
  kTimeout,           ///< Nothing arrived in time: ask again.
  kPaused,            ///< Somebody holds a replay: nothing is wrong, ask again.
  kCorruptFrame,      ///< One frame was damaged: the next may be fine.
  kDeviceLost,        ///< The device is gone: reopen.
  kEndOfStream,       ///< A recording has come to its end: close.
  kTooFewPoints,      ///< Too little data for an estimate: skip the segment.
  kDegenerateGeometry,///< Points on a line, a flat mesh...: skip the segment.
  kIo,                ///< The operating system refused a read, write or socket.
};

std::string_view to_string(ErrorCode code);

/// `what` holds the quantity, the value and the bound, as in
/// `segmentation.table_inlier_m = -0.01, expected [0.001, 0.05]`.
struct Error {
  ErrorCode code;
  std::string what;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> failure(ErrorCode code, std::string what) {
  return tl::unexpected<Error>(Error{code, std::move(what)});
}

}  // namespace gfp
