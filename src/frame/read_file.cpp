#include "gfp/frame/read_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace gfp {

Result<std::string> read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return failure(ErrorCode::kNotFound, fmt::format("{}: no such file", path.string()));
  if (!std::filesystem::is_regular_file(status)) return failure(ErrorCode::kIo, fmt::format("{}: not a regular file", path.string()));
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return failure(ErrorCode::kIo, fmt::format("{}: {}", path.string(), error.message()));
  if (size > max_bytes)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: size = {} bytes, expected at most {}", path.string(), size, max_bytes));
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  if (!file || (size > 0 && !file.read(bytes.data(), static_cast<std::streamsize>(size))))
    return failure(ErrorCode::kIo, fmt::format("{}: cannot be read", path.string()));
  return bytes;
}

}  // namespace gfp
