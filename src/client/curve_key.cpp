#include "gfp/client/curve_key.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zmq.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "gfp/frame/read_file.hpp"

namespace gfp {
namespace {

constexpr std::size_t kKeyLength = 40;        ///< 32 bytes in Z85.
constexpr std::size_t kMaxKeyFileBytes = 4096;

Result<void> write_new(const std::filesystem::path& path, const std::string& text, mode_t mode) {
  const int file = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
  if (file < 0) return failure(ErrorCode::kIo, fmt::format("{}: {}", path.string(), std::strerror(errno)));
  const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(file);
  if (!written) return failure(ErrorCode::kIo, fmt::format("{}: not written", path.string()));
  return {};
}

bool is_key(const std::string& text) {
  std::array<std::uint8_t, 32> bytes{};
  return text.size() == kKeyLength && zmq_z85_decode(bytes.data(), text.c_str()) != nullptr;
}

}  // namespace

CurveKey new_curve_key() {
  std::array<char, kKeyLength + 1> public_key{}, secret_key{};
  zmq_curve_keypair(public_key.data(), secret_key.data());
  return {public_key.data(), secret_key.data()};
}

Result<void> write_curve_key(const std::filesystem::path& stem, const CurveKey& key) {
  const std::string shared = "public: " + key.public_key + "\n";
  if (auto written = write_new(stem.string() + ".key", "# Keep this file to yourself; give the .pub file away.\n" + shared + "secret: " + key.secret_key + "\n", 0600); !written)
    return written;
  return write_new(stem.string() + ".pub", shared, 0644);
}

Result<CurveKey> read_curve_key(const std::filesystem::path& file) {
  const auto text = read_file(file, kMaxKeyFileBytes);
  if (!text) return tl::unexpected(text.error());
  CurveKey key;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with("public: ")) key.public_key = line.substr(8);
    if (line.starts_with("secret: ")) key.secret_key = line.substr(8);
  }
  if (!is_key(key.public_key)) return failure(ErrorCode::kCorruptData, fmt::format("{}: no line `public: ` with a key of 40 characters", file.string()));
  if (!key.secret_key.empty() && !is_key(key.secret_key)) return failure(ErrorCode::kCorruptData, fmt::format("{}: the secret is not a key of 40 characters", file.string()));
  return key;
}

}  // namespace gfp
