#include "bumblebee/fake/gige_camera.hpp"

extern "C" {
#include <arv.h>
}
#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <deque>
#include <optional>
#include <thread>
#include <utility>

#include "bumblebee/fake/big_endian.hpp"
#include "gfp/core/random.hpp"
#include "gfp/core/time.hpp"

namespace gfp {
namespace {

// GigE Vision: port and registers of the bootstrap, commands of GVCP (an answer's number is one more), errors.
constexpr std::uint16_t kPort = 3956;
constexpr std::uint32_t kAddressRegister = 0x0024, kCapabilityRegister = 0x0934, kPrivilegeRegister = 0x0A00, kStreamPort = 0x0D00, kStreamPacketSize = 0x0D04, kStreamAddress = 0x0D18;
constexpr std::size_t kDiscoveryBytes = 0xF8, kMaxDatagram = 1024;
enum Command : std::uint16_t { kDiscovery = 0x02, kResend = 0x40, kReadRegister = 0x80, kWriteRegister = 0x82, kReadMemory = 0x84, kWriteMemory = 0x86 };
constexpr std::uint8_t kIsCommand = 0x42;
constexpr std::uint16_t kDone = 0, kNotImplemented = 0x8001, kAccessDenied = 0x8006;
constexpr std::uint32_t kCanResend = 0x4;  // of the capabilities
constexpr std::size_t kKeptFrames = 4;
constexpr int kIdlePoll_ms = 50;

sockaddr_in inet(std::uint32_t address, std::uint16_t port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(address);
  to.sin_port = htons(port);
  return to;
}

bool same(const sockaddr_in& a, const sockaddr_in& b) { return a.sin_addr.s_addr == b.sin_addr.s_addr && a.sin_port == b.sin_port; }

class UdpSocket {
 public:
  UdpSocket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~UdpSocket() { close(descriptor_); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  bool bind_to(std::uint32_t address, std::uint16_t port, bool is_shared) {
    const int yes = 1;
    const sockaddr_in at = inet(address, port);
    return (!is_shared || setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0) && bind(descriptor_, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
  }
  void send(std::span<const std::uint8_t> bytes, const sockaddr_in& to) const { sendto(descriptor_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to); }
  /// Nothing where nothing waits.
  std::optional<std::pair<std::size_t, sockaddr_in>> receive(std::span<std::uint8_t> into) const {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = recvfrom(descriptor_, into.data(), into.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0) return std::nullopt;
    return std::pair{static_cast<std::size_t>(got), from};
  }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

class GigeCamera::Device {
 public:
  Device(const GigeFormat& format, std::vector<std::vector<std::uint8_t>> transfers, const GigeCameraOptions& options) : format_(format), transfers_(std::move(transfers)), options_(options) {}
  ~Device() {
    thread_ = {};
    g_clear_object(&registers_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  Result<void> start();

  std::atomic<std::uint64_t> sent{0}, resent{0};

 private:
  struct Kept {
    std::uint64_t frame;
    GvspPackets packets;
  };
  struct Answer {
    std::uint16_t status = kDone;
    std::vector<std::uint8_t> body;
  };
  void run(const std::stop_token& stop);
  void answer(const UdpSocket& socket);
  std::optional<Answer> execute(std::uint16_t command, std::span<const std::uint8_t> body, const sockaddr_in& from);
  void resend(std::span<const std::uint8_t> body);
  void send_frame();
  void send_packet(std::span<const std::uint8_t> packet);
  bool is_streaming() const { return arv_fake_camera_get_control_channel_privilege(registers_) != 0 && arv_fake_camera_get_acquisition_status(registers_) != 0; }
  std::uint32_t register_value(std::uint32_t at) const {
    guint32 value = 0;
    arv_fake_camera_read_register(registers_, at, &value);
    return value;
  }

  const GigeFormat format_;
  const std::vector<std::vector<std::uint8_t>> transfers_;
  const GigeCameraOptions options_;
  ArvFakeCamera* registers_ = nullptr;
  UdpSocket control_, global_discovery_, subnet_discovery_, stream_;
  std::optional<sockaddr_in> controller_;
  Nanoseconds heard_{};  ///< Of the controller.
  std::uint64_t frame_ = 0;
  std::deque<Kept> kept_;
  Random loss_{1};
  std::jthread thread_;
};

Result<void> GigeCamera::Device::start() {
  in_addr parsed{};
  if (inet_pton(AF_INET, options_.address.c_str(), &parsed) != 1) return failure(ErrorCode::kIo, fmt::format("GigE camera: {} is no IPv4 address", options_.address));
  const std::uint32_t address = ntohl(parsed.s_addr);
  if (!control_.bind_to(address, kPort, false) || !stream_.bind_to(address, 0, false))
    return failure(ErrorCode::kIo, fmt::format("GigE camera: {} port {} cannot be had: {}", options_.address, kPort, std::strerror(errno)));
  const std::uint32_t subnet = address | (address >> 24 == 127 ? 0x00FFFFFFU : 0xFFU);
  if (!global_discovery_.bind_to(INADDR_BROADCAST, kPort, true) || !subnet_discovery_.bind_to(subnet, kPort, true))
    return failure(ErrorCode::kIo, fmt::format("GigE camera: broadcasts to port {} cannot be had: {}", kPort, std::strerror(errno)));

  registers_ = arv_fake_camera_new(options_.serial.c_str());
  std::vector<std::uint8_t> raw;
  BigEndianWriter(raw) << address;
  arv_fake_camera_write_memory(registers_, kAddressRegister, 4, raw.data());
  const auto width = static_cast<guint32>(format_.width), height = static_cast<guint32>(format_.height * format_.parts);  // the payload is that of all parts
  for (const auto& [at, value] : {std::pair<guint32, guint32>{ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, width}, {ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, height}, {ARV_FAKE_CAMERA_REGISTER_WIDTH, width},
                                  {ARV_FAKE_CAMERA_REGISTER_HEIGHT, height}, {ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, format_.pixel_format},
                                  {kCapabilityRegister, register_value(kCapabilityRegister) | (options_.resends ? kCanResend : 0)},
                                  {ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US, static_cast<guint32>(std::lround(1e6 / options_.rate_hz))}})
    arv_fake_camera_write_register(registers_, at, value);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  return {};
}

void GigeCamera::Device::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const Nanoseconds period = std::chrono::microseconds(std::max(1U, register_value(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US)));
    const Nanoseconds due = (monotonic_now() / period + 1) * period;
    for (Nanoseconds left = due - monotonic_now(); left > Nanoseconds::zero() && !stop.stop_requested(); left = due - monotonic_now()) {
      std::array<pollfd, 3> waiting{{{control_.descriptor(), POLLIN, 0}, {global_discovery_.descriptor(), POLLIN, 0}, {subnet_discovery_.descriptor(), POLLIN, 0}}};
      poll(waiting.data(), waiting.size(), std::min(kIdlePoll_ms, 1 + static_cast<int>(left / std::chrono::milliseconds(1))));
      for (const UdpSocket* socket : {&control_, &global_discovery_, &subnet_discovery_}) answer(*socket);
    }
    if (controller_ && monotonic_now() - heard_ > std::chrono::milliseconds(arv_fake_camera_get_heartbeat_timeout(registers_))) {
      controller_.reset();
      arv_fake_camera_set_control_channel_privilege(registers_, 0);
    }
    if (is_streaming()) send_frame();
    else kept_.clear();
  }
}

void GigeCamera::Device::answer(const UdpSocket& socket) {
  std::array<std::uint8_t, kMaxDatagram> datagram;
  while (const auto got = socket.receive(datagram)) {
    const auto [size, from] = *got;
    if (size < 8 || datagram[0] != kIsCommand) continue;
    const std::uint16_t command = read16(&datagram[2]), id = read16(&datagram[6]);
    const std::size_t body = read16(&datagram[4]);
    if (8 + body > size) continue;
    if (controller_ && same(*controller_, from)) heard_ = monotonic_now();
    const auto answer = execute(command, std::span(datagram).subspan(8, body), from);
    if (!answer) continue;
    std::vector<std::uint8_t> reply;
    BigEndianWriter(reply) << answer->status << static_cast<std::uint16_t>(command + 1) << static_cast<std::uint16_t>(answer->body.size()) << id << std::span<const std::uint8_t>(answer->body);
    control_.send(reply, from);
  }
}

/// Nothing to what has no answer. Reads and writes of registers: one each, as Aravis does them.
std::optional<GigeCamera::Device::Answer> GigeCamera::Device::execute(std::uint16_t command, std::span<const std::uint8_t> body, const sockaddr_in& from) {
  Answer answer;
  BigEndianWriter to(answer.body);
  const auto put_memory = [&](std::uint32_t at, std::size_t size) {
    std::array<std::uint8_t, kMaxDatagram> memory;
    arv_fake_camera_read_memory(registers_, at, static_cast<guint32>(size), memory.data());
    for (const std::uint8_t byte : std::span(memory).first(size)) to << byte;
  };
  const std::uint32_t at = body.size() >= 4 ? read32(body.data()) : 0;
  if (command == kDiscovery) {
    put_memory(0, kDiscoveryBytes);
  } else if (command == kReadRegister && body.size() >= 4) {
    to << register_value(at);
  } else if (command == kReadMemory && body.size() >= 8 && read16(&body[6]) <= kMaxDatagram) {
    to << at;
    put_memory(at, read16(&body[6]));
  } else if ((command == kWriteRegister || command == kWriteMemory) && body.size() >= 8) {
    if (controller_ && !same(*controller_, from)) return Answer{kAccessDenied, {}};
    if (command == kWriteRegister) arv_fake_camera_write_register(registers_, at, read32(&body[4]));
    else arv_fake_camera_write_memory(registers_, at, static_cast<guint32>(body.size() - 4), &body[4]);
    if (at == kPrivilegeRegister) controller_ = arv_fake_camera_get_control_channel_privilege(registers_) != 0 ? std::optional(from) : std::nullopt, heard_ = monotonic_now();
    to << std::uint16_t{0} << std::uint16_t{1};  // of one, one was written
  } else if (command == kResend && options_.resends) {
    resend(body);
    return std::nullopt;
  } else {
    answer.status = kNotImplemented;
  }
  return answer;
}

/// Body: channel, frame (16 bits; 0 where its 64 bits follow at the end), first and last packet.
void GigeCamera::Device::resend(std::span<const std::uint8_t> body) {
  if (body.size() < 12 || !is_streaming()) return;
  const bool is_extended = body.size() >= 20;
  const std::uint64_t frame = is_extended ? std::uint64_t{read32(&body[12])} << 32 | read32(&body[16]) : read16(&body[2]);
  const std::size_t first = read32(&body[4]), last = read32(&body[8]);
  for (const Kept& kept : kept_) {
    if ((is_extended ? kept.frame : 1 + (kept.frame - 1) % 0xFFFF) != frame) continue;
    for (std::size_t i = first; i <= last && i < kept.packets.size(); ++i) send_packet(kept.packets[i]), ++resent;
  }
}

void GigeCamera::Device::send_frame() {
  const std::size_t packet_bytes = std::clamp<std::size_t>(register_value(kStreamPacketSize) & 0xFFFF, 128, 0xFFFF);
  kept_.push_back({++frame_, GvspPackets::of_transfer(format_, transfers_[sent % transfers_.size()], frame_, static_cast<std::uint64_t>(monotonic_now().count()), packet_bytes)});
  if (kept_.size() > kKeptFrames) kept_.pop_front();
  ++sent;
  const GvspPackets& packets = kept_.back().packets;
  for (std::size_t i = 0; i < packets.size(); ++i) send_packet(packets[i]);
}

void GigeCamera::Device::send_packet(std::span<const std::uint8_t> packet) {
  if (loss_.uniform() < options_.lost_packets) return;
  stream_.send(packet, inet(register_value(kStreamAddress), static_cast<std::uint16_t>(register_value(kStreamPort))));
}

GigeCamera::GigeCamera(std::unique_ptr<Device> device) : device_(std::move(device)) {}
GigeCamera::~GigeCamera() = default;

std::uint64_t GigeCamera::sent() const { return device_->sent; }
std::uint64_t GigeCamera::resent() const { return device_->resent; }

Result<std::unique_ptr<GigeCamera>> GigeCamera::start(const GigeFormat& format, std::vector<std::vector<std::uint8_t>> transfers, const GigeCameraOptions& options) {
  auto device = std::make_unique<Device>(format, std::move(transfers), options);
  if (auto started = device->start(); !started) return tl::unexpected<Error>(started.error());
  return std::unique_ptr<GigeCamera>(new GigeCamera(std::move(device)));
}

}  // namespace gfp
