#include "replay/fakenect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>

#include "gfp/frame/read_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxIndexBytes = 64U << 20U, kMaxImageBytes = 64U << 20U;
constexpr int kMaxSide = 4096;
constexpr Nanoseconds kMaxColorLag = std::chrono::milliseconds(50);

/// d-1302720000.123456-2000000.pgm
struct Listed {
  char kind = 0;
  Nanoseconds stamp{};
  fs::path file;
};

std::optional<Listed> parse_name(const fs::path& folder, const std::string& name) {
  if (name.size() < 5 || name[1] != '-' || name.find('/') != std::string::npos) return std::nullopt;
  const std::size_t dash = name.find('-', 2);
  if (dash == std::string::npos) return std::nullopt;
  const std::optional<Nanoseconds> stamp = stamp_from_name(name.substr(2, dash - 2));
  if (!stamp) return std::nullopt;
  return Listed{name[0], *stamp, folder / name};
}

/// `colors` ascend in time.
fs::path nearest_color(const std::vector<Listed>& colors, Nanoseconds stamp) {
  const auto after = std::lower_bound(colors.begin(), colors.end(), stamp, [](const Listed& color, Nanoseconds t) { return color.stamp < t; });
  const Listed* best = after != colors.end() ? &*after : nullptr;
  if (after != colors.begin() && (!best || stamp - std::prev(after)->stamp < best->stamp - stamp)) best = &*std::prev(after);
  const bool near = best && (best->stamp > stamp ? best->stamp - stamp : stamp - best->stamp) <= kMaxColorLag;
  return near ? best->file : fs::path();
}

/// The pixels behind a header of four words and one white space.
Result<std::string_view> netpbm_pixels(std::string_view bytes, std::string_view magic, int maximum, std::size_t pixel_bytes, const fs::path& file, int& width, int& height) {
  const std::size_t line = bytes.substr(0, 64).find('\n');
  std::istringstream header(std::string(bytes.substr(0, line == std::string_view::npos ? 0 : line)));
  std::string word;
  int most = 0;
  if (!(header >> word >> width >> height >> most) || word != magic || most != maximum || width < 1 || height < 1)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: not a `{} width height {}` image", file.string(), magic, maximum));
  if (width > kMaxSide || height > kMaxSide)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: size = {} x {}, expected at most {} a side", file.string(), width, height, kMaxSide));
  const std::size_t expected = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * pixel_bytes;
  if (bytes.size() - line - 1 != expected)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: pixels = {} bytes, expected {}", file.string(), bytes.size() - line - 1, expected));
  return bytes.substr(line + 1);
}

}  // namespace

bool is_fakenect_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "INDEX.txt", error);
}

Result<std::vector<ReplayEntry>> list_fakenect_folder(const fs::path& folder) {
  const Result<std::string> index = read_file(folder / "INDEX.txt", kMaxIndexBytes);
  if (!index) return tl::unexpected<Error>(index.error());
  std::vector<Listed> depths, colors;
  std::istringstream lines(*index);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    const std::string where = fmt::format("{}:{}", (folder / "INDEX.txt").string(), number);
    std::optional<Listed> listed = parse_name(folder, line);
    if (!listed) return failure(ErrorCode::kCorruptData, fmt::format("{}: file = '{}', expected d-<seconds>-<ticks>.pgm or the like", where, line.substr(0, 80)));
    std::error_code error;
    if (!fs::is_regular_file(listed->file, error)) return failure(ErrorCode::kNotFound, fmt::format("{}: {}: no such file", where, listed->file.string()));
    if (depths.size() + colors.size() >= kMaxReplayEntries) return failure(ErrorCode::kTooLarge, fmt::format("{}: more than {} files", where, kMaxReplayEntries));
    if (listed->kind == 'd') depths.push_back(std::move(*listed));
    else if (listed->kind == 'r') colors.push_back(std::move(*listed));
  }
  if (depths.empty()) return failure(ErrorCode::kCorruptData, fmt::format("{}: depth frames = 0, expected at least 1", (folder / "INDEX.txt").string()));
  std::stable_sort(colors.begin(), colors.end(), [](const Listed& a, const Listed& b) { return a.stamp < b.stamp; });
  std::vector<ReplayEntry> entries;
  for (const Listed& depth : depths) entries.push_back({ReplayFormat::kFakenect, depth.file, nearest_color(colors, depth.stamp), {}, depth.stamp, kKinectDepthScale_m});
  return entries;
}

Result<Image<std::uint16_t>> read_fakenect_raw(const fs::path& file) {
  const Result<std::string> bytes = read_file(file, kMaxImageBytes);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  int width = 0, height = 0;
  const auto pixels = netpbm_pixels(*bytes, "P5", 65535, 2, file, width, height);
  if (!pixels) return tl::unexpected<Error>(pixels.error());
  Image<std::uint16_t> image(width, height);
  std::memcpy(image.pixels.data(), pixels->data(), pixels->size());
  return image;
}

Result<Image<Rgb8>> read_fakenect_color(const fs::path& file) {
  const Result<std::string> bytes = read_file(file, kMaxImageBytes);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  int width = 0, height = 0;
  const auto pixels = netpbm_pixels(*bytes, "P6", 255, 3, file, width, height);
  if (!pixels) return tl::unexpected<Error>(pixels.error());
  static_assert(sizeof(Rgb8) == 3);
  Image<Rgb8> image(width, height);
  std::memcpy(static_cast<void*>(image.pixels.data()), pixels->data(), pixels->size());
  return image;
}

DepthImage depth_of_raw(const Image<std::uint16_t>& raw, const KinectDepthTable& table) {
  DepthImage depth{Image<std::uint16_t>(raw.width, raw.height), kKinectDepthScale_m};
  std::transform(raw.pixels.begin(), raw.pixels.end(), depth.pixels.pixels.begin(),
                 [&](std::uint16_t value) { return value < table.size() ? table[value] : std::uint16_t{0}; });
  return depth;
}

}  // namespace gfp
