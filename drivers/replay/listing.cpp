#include "replay/listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <set>

#include "gfp/frame/png.hpp"
#include "replay/fakenect.hpp"
#include "replay/tum.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;

bool parse_digits(std::string_view text, std::int64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return !text.empty() && error == std::errc{} && end == text.data() + text.size() && text[0] != '-';
}

/// ".814212" as nanoseconds: digits after the point, any number of them.
bool parse_fraction(std::string_view digits, std::int64_t& nanoseconds) {
  std::string nine(digits.substr(0, 9));
  nine.resize(9, '0');
  return !digits.empty() && parse_digits(nine, nanoseconds);
}

std::optional<Nanoseconds> stamp_from_seconds(std::string_view text) {
  const std::size_t point = text.find('.');
  std::int64_t seconds = 0, nanoseconds = 0;
  constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // what 64 bits of nanoseconds hold
  if (point == std::string_view::npos || !parse_digits(text.substr(0, point), seconds) || seconds > kMaxSeconds ||
      !parse_fraction(text.substr(point + 1), nanoseconds))
    return std::nullopt;
  return std::chrono::seconds(seconds) + Nanoseconds(nanoseconds);
}

/// 20121214T142255.814212
std::optional<Nanoseconds> stamp_from_date(std::string_view text) {
  if (text.size() < 17 || text[8] != 'T' || text[15] != '.') return std::nullopt;
  constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kParts{{{0, 4}, {4, 2}, {6, 2}, {9, 2}, {11, 2}, {13, 2}}};
  std::array<std::int64_t, 6> part{};
  for (std::size_t i = 0; i < part.size(); ++i)
    if (!parse_digits(text.substr(kParts[i].first, kParts[i].second), part[i])) return std::nullopt;
  std::int64_t nanoseconds = 0;
  if (!parse_fraction(text.substr(16), nanoseconds)) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(part[0])), std::chrono::month(static_cast<unsigned>(part[1])),
                                         std::chrono::day(static_cast<unsigned>(part[2]))};
  if (!date.ok() || part[0] < 1970 || part[0] > 2200 || part[3] > 23 || part[4] > 59 || part[5] > 60) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch() + std::chrono::hours(part[3]) + std::chrono::minutes(part[4]) +
         std::chrono::seconds(part[5]) + Nanoseconds(nanoseconds);
}

/// `stem` with one of the given endings exchanged for one of the others, if such a file exists.
fs::path sibling(const fs::path& file, std::initializer_list<const char*> endings, std::initializer_list<const char*> others, const char* extension) {
  const std::string stem = file.stem().string();
  for (const std::string_view ending : endings) {
    if (!stem.ends_with(ending)) continue;
    for (const char* other : others) {
      const fs::path candidate = file.parent_path() / (stem.substr(0, stem.size() - ending.size()) + other + extension);
      if (fs::exists(candidate)) return candidate;
    }
  }
  return {};
}

bool named_depth(const fs::path& file) {
  const std::string stem = file.stem().string();
  return stem.ends_with("-depth") || stem.ends_with("_depth") || stem.ends_with(".depth");
}

ReplayEntry make_entry(const fs::path& file, ReplayFormat format) {
  const std::string stem = file.stem().string();
  std::string name = stem;
  if (named_depth(file)) name.resize(stem.size() - std::string_view("-depth").size());
  ReplayEntry entry{format, file, {}, {}, stamp_from_name(name), 0.001};
  if (format == ReplayFormat::kPclzf) {
    entry.color = sibling(file, {"_depth"}, {"_rgb"}, ".pclzf");
    entry.calibration = sibling(file, {"_depth"}, {""}, ".xml");
  } else if (format == ReplayFormat::kPng) {
    entry.color = sibling(file, {"-depth", "_depth", ".depth"}, {"-color", "_color", ".color", "-rgb", "_rgb", ".rgb"}, ".png");
  }
  return entry;
}

Result<std::vector<ReplayEntry>> list_file(const fs::path& file) {
  std::array<char, 64> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  const std::string_view begin(head.data(), static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
  if (begin.starts_with("PCLZF")) return std::vector{make_entry(file, ReplayFormat::kPclzf)};
  if (begin.starts_with("\x89PNG")) return std::vector{make_entry(file, ReplayFormat::kPng)};
  if (begin.starts_with("# .PCD") || begin.starts_with("VERSION") || file.extension() == ".pcd") return std::vector{make_entry(file, ReplayFormat::kPcd)};
  if (file.extension() == ".pclzf") return std::vector{make_entry(file, ReplayFormat::kPclzf)};
  if (file.extension() == ".png") return std::vector{make_entry(file, ReplayFormat::kPng)};
  return failure(ErrorCode::kUnsupported, fmt::format("{}: neither a PCD, a PCLZF nor a PNG file (nor a folder of these)", file.string()));
}

Result<std::vector<fs::path>> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (files.size() >= 4 * kMaxReplayEntries)
      return failure(ErrorCode::kTooLarge, fmt::format("{}: more than {} files", folder.string(), 4 * kMaxReplayEntries));
    files.push_back(it->path());
  }
  if (error) return failure(ErrorCode::kIo, fmt::format("{}: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

Result<std::vector<ReplayEntry>> list_folder(const fs::path& folder) {
  const Result<std::vector<fs::path>> files = files_in(folder);
  if (!files) return tl::unexpected<Error>(files.error());
  const bool depth_by_name = std::any_of(files->begin(), files->end(), [](const fs::path& f) { return f.extension() == ".png" && named_depth(f); });
  std::set<std::string> pclzf_stems;
  for (const fs::path& file : *files)
    if (file.extension() == ".pclzf" && named_depth(file)) pclzf_stems.insert(file.stem().string());
  std::vector<ReplayEntry> entries;
  for (const fs::path& file : *files) {
    if (file.extension() == ".pcd" && !pclzf_stems.contains(file.stem().string() + "_depth")) entries.push_back(make_entry(file, ReplayFormat::kPcd));
    if (file.extension() == ".pclzf" && named_depth(file)) entries.push_back(make_entry(file, ReplayFormat::kPclzf));
    if (file.extension() != ".png") continue;
    const Result<PngHeader> header = depth_by_name ? Result<PngHeader>{} : read_png_header(file);
    const bool is_depth = depth_by_name ? named_depth(file) : header && header->grey && header->bit_depth == 16;
    if (is_depth) entries.push_back(make_entry(file, ReplayFormat::kPng));
  }
  if (entries.empty())
    return failure(ErrorCode::kUnsupported, fmt::format("{}: frames = 0, expected .pcd, _depth.pclzf or 16-bit .png files", folder.string()));
  return entries;
}

}  // namespace

std::optional<Nanoseconds> stamp_from_name(const std::string& stem) {
  if (const auto seconds = stamp_from_seconds(stem)) return seconds;
  const std::size_t underscore = stem.rfind('_');
  return stamp_from_date(underscore == std::string::npos ? std::string_view(stem) : std::string_view(stem).substr(underscore + 1));
}

Result<std::vector<ReplayEntry>> list_replay(const fs::path& input) {
  std::error_code error;
  const fs::file_status status = fs::status(input, error);
  if (!fs::exists(status)) return failure(ErrorCode::kNotFound, fmt::format("{}: no such file or folder", input.string()));
  if (fs::is_directory(status)) return is_tum_folder(input) ? list_tum_folder(input) : is_fakenect_folder(input) ? list_fakenect_folder(input) : list_folder(input);
  if (!fs::is_regular_file(status)) return failure(ErrorCode::kUnsupported, fmt::format("{}: neither a file nor a folder", input.string()));
  return list_file(input);
}

}  // namespace gfp
