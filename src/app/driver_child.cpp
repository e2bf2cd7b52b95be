#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "app/driver_channel.hpp"
#include "app/frame_ring.hpp"
#include "app/make_source.hpp"

namespace gfp {
namespace {

constexpr int kDone = 0, kNoStart = 1;

/// False: nobody listens any more. A listener that is behind loses messages, not this process its time.
bool say(const DriverMessage& message) {
  const auto sent = send(kChannelDescriptor, &message, sizeof(message), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(sizeof(message)) || errno == EAGAIN;
}

bool say(DriverMessage::Kind kind, const Error& error) {
  DriverMessage message;
  message.kind = kind;
  message.code = static_cast<std::uint32_t>(error.code);
  std::strncpy(message.text, error.what.c_str(), sizeof(message.text) - 1);
  return say(message);
}

Result<std::string> read_config() {
  std::string text;
  char part[4096];
  if (lseek(kConfigDescriptor, 0, SEEK_SET) != 0) return failure(ErrorCode::kIo, "the driver's process was given no configuration");
  for (ssize_t count = 0; (count = ::read(kConfigDescriptor, part, sizeof(part))) > 0;) text.append(part, static_cast<std::size_t>(count));
  return text;
}

Result<std::unique_ptr<FrameSource>> configured_source() {
  return read_config()
      .and_then([](const std::string& text) { return config::parse_daemon_options(text, "driver process", {}); })
      .and_then([](const DaemonOptions& options) -> Result<std::unique_ptr<FrameSource>> {
        if (options.sensors.empty()) return failure(ErrorCode::kInvalidArgument, "driver process: no sensor is configured");
        return make_source(options.sensors.front());
      });
}

/// Until nobody listens, or the source has no more to give.
void stream(FrameSource& source, FrameRing& ring) {
  DriverMessage frame_message;
  frame_message.kind = DriverMessage::kFrame;
  while (true) {
    const Result<Frame> frame = source.grab(std::chrono::milliseconds(kDriverBeat_ms));
    const Result<void> written = frame ? ring.write(frame_message.turn, *frame) : tl::unexpected<Error>(frame.error());
    if (written) {
      if (!say(frame_message)) return;
      ++frame_message.turn;
      continue;
    }
    if (!say(DriverMessage::kError, written.error())) return;
    if (written.error().code == ErrorCode::kDeviceLost || written.error().code == ErrorCode::kEndOfStream) return;
  }
}

}  // namespace

int run_driver_child() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  auto ring = FrameRing::map(kRingDescriptor, true);
  if (!ring) return say(DriverMessage::kOpenFailed, ring.error()), kNoStart;
  auto source = configured_source();
  if (!source) return say(DriverMessage::kOpenFailed, source.error()), kNoStart;
  if (const auto opened = (*source)->open(); !opened) return say(DriverMessage::kOpenFailed, opened.error()), kNoStart;
  DriverMessage message;
  message.kind = DriverMessage::kOpened;
  if (say(message)) stream(**source, *ring);
  (*source)->close();
  return kDone;
}

}  // namespace gfp
