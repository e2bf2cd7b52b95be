#include "openni2/oni_records.hpp"

#include <array>
#include <cstdint>
#include <fstream>

namespace gfp {
namespace {

constexpr std::uint32_t kMagic = 0x0052494E;  // "NIR", 0
constexpr std::uint32_t kNewData = 0x0A;
constexpr std::streamoff kFirstRecord = 24;
constexpr std::size_t kHeaderWords = 7;
constexpr int kMaxRecords = 10'000;  // before the first frame: some properties a stream

}  // namespace

bool oni_file_has_frames(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(kFirstRecord);
  for (int record = 0; record < kMaxRecords; ++record) {
    std::array<std::uint32_t, kHeaderWords> header{};
    if (!in.read(reinterpret_cast<char*>(header.data()), sizeof(header))) return false;
    const std::uint32_t magic = header[0], type = header[1], fields = header[3], payload = header[4];
    if (magic != kMagic || fields < sizeof(header)) return false;
    if (type == kNewData) return true;
    in.seekg(static_cast<std::streamoff>(fields) - static_cast<std::streamoff>(sizeof(header)) + static_cast<std::streamoff>(payload), std::ios::cur);
  }
  return false;
}

}  // namespace gfp
