#include "app/isolated_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "app/driver_channel.hpp"
#include "app/frame_ring.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kOpenPatience = 20s;   // a GigE camera that does not answer takes seconds
constexpr Nanoseconds kEndPatience = 500ms;  // for a driver to close its device by itself
constexpr int kAboveTheChilds = 10;          // our descriptors stay clear of the numbers that the process is given

/// An open descriptor, closed with it.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int get() const { return number_; }
  bool valid() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

/// The same file under a high number.
Descriptor raised(Descriptor low) { return Descriptor(fcntl(low.get(), F_DUPFD_CLOEXEC, kAboveTheChilds)); }

Descriptor file_with(const std::string& text) {
  Descriptor file(memfd_create("gfp-config", MFD_CLOEXEC));
  if (!file.valid() || ::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) return {};
  return raised(std::move(file));
}

Error system_error(const char* what) { return {ErrorCode::kIo, fmt::format("driver process: {}: {}", what, std::strerror(errno))}; }

std::string ending(int status) {
  if (WIFSIGNALED(status)) return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

class IsolatedSource final : public FrameSource {
 public:
  IsolatedSource(SensorConfig sensor, SourceInfo info, std::filesystem::path program)
      : sensor_(std::move(sensor)), info_(std::move(info)), program_(program.empty() ? "/proc/self/exe" : std::move(program)) {
    sensor_.isolation = "none";
  }
  ~IsolatedSource() override { close(); }

  SourceInfo info() const override { return info_; }
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override;

 private:
  Result<void> spawn();
  /// The next message, within the patience. Errors: kTimeout, kDeviceLost (the process has ended).
  Result<DriverMessage> next(Nanoseconds patience);
  Result<Frame> frame_of(const DriverMessage& message);
  tl::unexpected<Error> ended();
  /// Its exit status, after at most the patience: then it is killed.
  int reap(Nanoseconds patience) noexcept;

  SensorConfig sensor_;
  const SourceInfo info_;
  const std::filesystem::path program_;
  Descriptor channel_;
  std::optional<FrameRing> ring_;
  pid_t process_ = -1;
  Nanoseconds heard_{};
  Nanoseconds last_stamp_{-1}, offset_{};
  bool rebase_ = false;
  std::uint64_t sequence_ = 0;
};

Result<void> IsolatedSource::open() {
  close();
  if (auto started = spawn(); !started) return close(), started;
  const auto message = next(kOpenPatience);
  Result<void> opened;
  if (!message) opened = tl::unexpected<Error>(message.error().code == ErrorCode::kTimeout ? Error{ErrorCode::kDeviceLost, "hang: the driver's process did not open its device within 20 s"} : message.error());
  else if (message->kind == DriverMessage::kOpenFailed) opened = failure(static_cast<ErrorCode>(message->code), message->text);
  else if (message->kind != DriverMessage::kOpened) opened = failure(ErrorCode::kDeviceLost, "the driver's process speaks out of turn");
  if (!opened) return close(), opened;
  rebase_ = true;
  heard_ = monotonic_now();
  return {};
}

Result<void> IsolatedSource::spawn() {
  DaemonOptions only;
  only.sensors = {sensor_};
  int pair[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) return tl::unexpected(system_error("no channel"));
  channel_ = Descriptor(pair[0]);
  const Descriptor childs = raised(Descriptor(pair[1])), config = file_with(config::to_yaml(only));
  auto memory = FrameRing::create();
  if (!memory) return tl::unexpected<Error>(memory.error());
  const Descriptor shared = raised(Descriptor(*memory));
  if (!childs.valid() || !config.valid() || !shared.valid()) return tl::unexpected(system_error("no descriptors"));
  auto ring = FrameRing::map(shared.get(), false);
  if (!ring) return tl::unexpected<Error>(ring.error());
  ring_.emplace(std::move(*ring));

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const auto& [from, to] : {std::pair{childs.get(), kChannelDescriptor}, {shared.get(), kRingDescriptor}, {config.get(), kConfigDescriptor}}) posix_spawn_file_actions_adddup2(&actions, from, to);
  posix_spawnattr_t attributes;  // the daemon blocks signals that must end a driver
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::string name = "gfpd", flag = "--driver-child";
  char* const arguments[] = {name.data(), flag.data(), nullptr};
  const int failed = posix_spawn(&process_, program_.c_str(), &actions, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed == 0) return {};
  process_ = -1;
  return failure(ErrorCode::kIo, fmt::format("driver process: {} cannot be started: {}", program_.string(), std::strerror(failed)));
}

Result<DriverMessage> IsolatedSource::next(Nanoseconds patience) {
  pollfd wait{channel_.get(), POLLIN, 0};
  const auto patience_ms = static_cast<int>(std::clamp<std::int64_t>(std::chrono::ceil<std::chrono::milliseconds>(patience).count(), 0, 60'000));
  if (const int ready = poll(&wait, 1, patience_ms); ready == 0 || (ready < 0 && errno == EINTR)) return failure(ErrorCode::kTimeout, fmt::format("no frame within {} ms", patience_ms));
  DriverMessage message;
  const auto size = recv(channel_.get(), &message, sizeof(message), 0);
  if (size <= 0) return ended();
  if (size != static_cast<ssize_t>(sizeof(message))) return failure(ErrorCode::kCorruptFrame, "the driver's process sent what is no message of ours");
  message.text[sizeof(message.text) - 1] = 0;
  heard_ = monotonic_now();
  return message;
}

tl::unexpected<Error> IsolatedSource::ended() {
  const pid_t process = process_;
  const int status = reap(kEndPatience);  // its end of the channel is closed: it is gone, or about to be
  return failure(ErrorCode::kDeviceLost, fmt::format("crash: driver process {} ended by {}", process, ending(status)));
}

Result<Frame> IsolatedSource::grab(std::chrono::milliseconds timeout) {
  if (process_ < 0) return failure(ErrorCode::kDeviceLost, "the driver's process is not running");
  const double period_s = info_.rate_hz > 0 ? 1 / info_.rate_hz : 1.0 / 30;
  const Nanoseconds silence = std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(sensor_.source.hang_s > 0 ? sensor_.source.hang_s : 3 * period_s + 0.5));
  const Nanoseconds deadline = monotonic_now() + timeout;
  while (true) {
    const Nanoseconds now = monotonic_now();
    if (now - heard_ > silence) {
      const pid_t process = process_;
      reap(Nanoseconds::zero());
      close();
      return failure(ErrorCode::kDeviceLost, fmt::format("hang: driver process {} said nothing for {:.2f} s and was ended", process, 1e-9 * static_cast<double>(silence.count())));
    }
    if (now >= deadline) return failure(ErrorCode::kTimeout, fmt::format("no frame within {} ms", timeout.count()));
    const auto message = next(std::min(deadline - now, heard_ + silence - now + 1ms));
    if (!message && message.error().code == ErrorCode::kTimeout) continue;
    if (!message) return tl::unexpected<Error>(message.error());
    if (message->kind == DriverMessage::kFrame) {
      Result<Frame> frame = frame_of(*message);
      if (!frame && frame.error().code == ErrorCode::kTimeout) continue;  // a newer one follows
      return frame;
    }
    const auto code = static_cast<ErrorCode>(message->code);
    if (message->kind != DriverMessage::kError) return failure(ErrorCode::kCorruptFrame, "the driver's process speaks out of turn");
    if (code != ErrorCode::kTimeout) return failure(code, message->text);
  }
}

/// A new process counts from 0: what it says goes on where the one before ended.
Result<Frame> IsolatedSource::frame_of(const DriverMessage& message) {
  Result<Frame> frame = ring_->read(message.turn);
  if (!frame) return frame;
  if (std::exchange(rebase_, false)) offset_ = last_stamp_ < Nanoseconds::zero() ? Nanoseconds::zero() : std::max(Nanoseconds::zero(), last_stamp_ + 1ns - frame->stamps.sensor);
  last_stamp_ = frame->stamps.sensor = std::max(frame->stamps.sensor + offset_, last_stamp_ + 1ns);
  frame->sensor = sensor_.name;
  frame->sequence = sequence_++;
  return frame;
}

void IsolatedSource::close() noexcept {
  channel_ = Descriptor();
  ring_.reset();
  if (process_ >= 0) reap(kEndPatience);
}

int IsolatedSource::reap(Nanoseconds patience) noexcept {
  const pid_t process = std::exchange(process_, -1);
  const Nanoseconds deadline = monotonic_now() + patience;
  int status = 0;
  while (monotonic_now() < deadline) {
    if (waitpid(process, &status, WNOHANG) != 0) return status;
    std::this_thread::sleep_for(5ms);
  }
  kill(process, SIGKILL);
  waitpid(process, &status, 0);
  return status;
}

}  // namespace

std::unique_ptr<FrameSource> make_isolated_source(SensorConfig sensor, SourceInfo info, const std::filesystem::path& program) {
  return std::make_unique<IsolatedSource>(std::move(sensor), std::move(info), program);
}

}  // namespace gfp
