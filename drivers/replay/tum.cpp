#include "replay/tum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "gfp/frame/read_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxListBytes = 64U << 20U;
constexpr double kTumScale_m = 1.0 / 5000.0;
constexpr Nanoseconds kMaxColorLag = std::chrono::milliseconds(20);

/// A line of depth.txt or rgb.txt, or one half of a line of associations.txt.
struct Listed {
  Nanoseconds stamp{};
  fs::path file;
};

/// Lists come with the recording and are not trusted: they name files below the folder, nothing else.
bool stays_inside(const fs::path& relative) {
  return !relative.empty() && relative.is_relative() && std::none_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
}

Result<Listed> parse_pair(const fs::path& folder, const std::string& stamp, const std::string& file, const std::string& where) {
  const std::optional<Nanoseconds> time = stamp_from_name(stamp);
  if (!time) return failure(ErrorCode::kCorruptData, fmt::format("{}: time stamp = '{}', expected seconds", where, stamp.substr(0, 40)));
  if (!stays_inside(file))
    return failure(ErrorCode::kInvalidArgument, fmt::format("{}: file = '{}', expected a path inside the folder", where, file.substr(0, 80)));
  return Listed{*time, folder / file};
}

/// All lines of a list with `pairs` (stamp, file) pairs each; comments begin with #.
Result<std::vector<std::vector<Listed>>> read_list(const fs::path& folder, const char* name, std::size_t pairs) {
  const Result<std::string> text = read_file(folder / name, kMaxListBytes);
  if (!text) return tl::unexpected<Error>(text.error());
  std::vector<std::vector<Listed>> rows;
  std::istringstream lines(*text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = fmt::format("{}:{}", (folder / name).string(), ++number);
    std::istringstream words(line);
    std::vector<Listed> row;
    for (std::string stamp, file; row.size() < pairs && words >> stamp && !stamp.starts_with('#');) {
      words >> file;
      Result<Listed> listed = parse_pair(folder, stamp, file, where);
      if (!listed) return tl::unexpected<Error>(listed.error());
      row.push_back(std::move(*listed));
    }
    if (row.empty()) continue;
    if (row.size() != pairs) return failure(ErrorCode::kCorruptData, fmt::format("{}: {} time stamps, expected {}", where, row.size(), pairs));
    if (rows.size() >= kMaxReplayEntries)
      return failure(ErrorCode::kTooLarge, fmt::format("{}: more than {} frames", where, kMaxReplayEntries));
    rows.push_back(std::move(row));
  }
  return rows;
}

ReplayEntry make_entry(const Listed& depth, fs::path color) {
  return {ReplayFormat::kPng, depth.file, std::move(color), {}, depth.stamp, kTumScale_m};
}

Result<std::vector<ReplayEntry>> from_associations(const fs::path& folder) {
  const auto rows = read_list(folder, "associations.txt", 2);
  if (!rows) return tl::unexpected<Error>(rows.error());
  std::vector<ReplayEntry> entries;
  for (const auto& row : *rows) {  // either may come first; the folder's name tells
    const bool depth_first = row[0].file.parent_path().filename().string().starts_with("depth");
    entries.push_back(make_entry(row[depth_first ? 0 : 1], row[depth_first ? 1 : 0].file));
  }
  return entries;
}

/// The colour image nearest in time, if it is near enough. `colors` ascend in time.
fs::path nearest_color(const std::vector<Listed>& colors, Nanoseconds stamp) {
  const auto after = std::lower_bound(colors.begin(), colors.end(), stamp, [](const Listed& c, Nanoseconds t) { return c.stamp < t; });
  const Listed* best = nullptr;
  for (auto it = after == colors.begin() ? after : after - 1; it != colors.end() && it <= after; ++it)
    if (best == nullptr || std::chrono::abs(it->stamp - stamp) < std::chrono::abs(best->stamp - stamp)) best = &*it;
  return best != nullptr && std::chrono::abs(best->stamp - stamp) <= kMaxColorLag ? best->file : fs::path{};
}

void sort_by_time(std::vector<Listed>& listed) {
  std::stable_sort(listed.begin(), listed.end(), [](const Listed& a, const Listed& b) { return a.stamp < b.stamp; });
}

std::vector<ReplayEntry> matched(const std::vector<Listed>& depths, const std::vector<Listed>& colors) {
  std::vector<ReplayEntry> entries;
  for (const Listed& depth : depths) entries.push_back(make_entry(depth, nearest_color(colors, depth.stamp)));
  return entries;
}

Result<std::vector<Listed>> read_sorted_list(const fs::path& folder, const char* name) {
  const auto rows = read_list(folder, name, 1);
  if (!rows) return tl::unexpected<Error>(rows.error());
  std::vector<Listed> listed;
  for (const auto& row : *rows) listed.push_back(row.front());
  sort_by_time(listed);
  return listed;
}

Result<std::vector<ReplayEntry>> from_depth_list(const fs::path& folder) {
  const auto depths = read_sorted_list(folder, "depth.txt");
  if (!depths) return tl::unexpected<Error>(depths.error());
  std::vector<Listed> colors;
  if (fs::exists(folder / "rgb.txt")) {
    auto listed = read_sorted_list(folder, "rgb.txt");
    if (!listed) return tl::unexpected<Error>(listed.error());
    colors = std::move(*listed);
  }
  return matched(*depths, colors);
}

std::vector<fs::path> png_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end && files.size() < kMaxReplayEntries; it.increment(error))
    if (it->path().extension() == ".png") files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<ReplayEntry> from_folders(const fs::path& folder) {
  std::vector<Listed> colors;
  for (const fs::path& file : png_files(folder / "rgb"))
    if (const auto stamp = stamp_from_name(file.stem().string())) colors.push_back({*stamp, file});
  sort_by_time(colors);
  std::vector<ReplayEntry> entries;
  for (const fs::path& file : png_files(folder / "depth")) {
    const std::optional<Nanoseconds> stamp = stamp_from_name(file.stem().string());
    const fs::path same_name = folder / "rgb" / file.filename();
    ReplayEntry entry{ReplayFormat::kPng, file, {}, {}, stamp, kTumScale_m};
    if (fs::exists(same_name)) entry.color = same_name;
    else if (stamp) entry.color = nearest_color(colors, *stamp);
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace

bool is_tum_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "associations.txt", error) || fs::is_regular_file(folder / "depth.txt", error) ||
         fs::is_directory(folder / "depth", error);
}

Result<std::vector<ReplayEntry>> list_tum_folder(const fs::path& folder) {
  Result<std::vector<ReplayEntry>> entries = fs::exists(folder / "associations.txt") ? from_associations(folder)
                                             : fs::exists(folder / "depth.txt")      ? from_depth_list(folder)
                                                                                     : from_folders(folder);
  if (entries && entries->empty())
    return failure(ErrorCode::kUnsupported, fmt::format("{}: frames = 0, expected at least one depth image", folder.string()));
  return entries;
}

}  // namespace gfp
