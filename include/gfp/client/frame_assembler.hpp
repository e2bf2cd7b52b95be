#pragma once

#include <map>
#include <optional>
#include <string>

#include "gfp/client/subscriber.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// Puts the messages of /gfp/sensor/<name>/ together again: depth and camera of one capture make a Frame, with its colour where that
/// came before the camera, as gfpd sends it. One thread at a time.
class FrameAssembler {
 public:
  /// Takes in one message; gives the frame that it completes. Messages of other topics are ignored.
  /// Errors: kCorruptData, kTooLarge, kInvalidArgument (camera): the message is left out.
  Result<std::optional<Frame>> put(const Message& message);

 private:
  std::map<std::string, Frame> waiting_;  ///< By sensor: the capture whose images came last.
};

}  // namespace gfp
