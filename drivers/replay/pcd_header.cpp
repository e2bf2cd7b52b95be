#include "replay/pcd_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include "gfp/core/image.hpp"

namespace gfp {
namespace {

constexpr std::size_t kMaxHeaderBytes = 16384;

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

std::optional<std::uint64_t> parse_count(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// The lines of a header as they come; judged when all are there.
struct Lines {
  std::vector<std::string_view> names, sizes, types, counts;
  std::optional<std::uint64_t> width, height, points;
  std::string viewpoint, data;
};

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  Result<PcdHeader> parse() {
    return read_lines().and_then([&] { return make_fields(); }).and_then([&] { return check_size(); }).map([&] { return header_; });
  }

 private:
  tl::unexpected<Error> corrupt(const std::string& what) const {
    return failure(ErrorCode::kCorruptData, fmt::format("{}: {}", name_, what));
  }

  Result<void> read_lines() {
    const std::string_view head = bytes_.substr(0, kMaxHeaderBytes);
    for (std::size_t at = 0; at < head.size();) {
      const std::size_t end = head.find('\n', at);
      if (end == std::string_view::npos) break;
      const std::vector<std::string_view> words = split(head.substr(at, end - at));
      at = end + 1;
      if (words.empty() || words[0].starts_with('#')) continue;
      if (const Result<void> read = read_line(words); !read) return read;
      if (words[0] != "DATA") continue;
      header_.data_offset = at;
      return {};
    }
    return corrupt(fmt::format("not a PCD file: no DATA line within its first {} bytes", head.size()));
  }

  Result<void> read_line(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    if (key == "FIELDS" || key == "COLUMNS") lines_.names = values;
    else if (key == "SIZE") lines_.sizes = values;
    else if (key == "TYPE") lines_.types = values;
    else if (key == "COUNT") lines_.counts = values;
    else if (key == "VIEWPOINT") lines_.viewpoint = fmt::format("{}", fmt::join(values, " ")).substr(0, 200);
    else if (key == "DATA") return read_data_kind(values);
    else if (key == "WIDTH") return read_number(key, values, lines_.width);
    else if (key == "HEIGHT") return read_number(key, values, lines_.height);
    else if (key == "POINTS") return read_number(key, values, lines_.points);
    else if (key != "VERSION") return corrupt(fmt::format("not a PCD file: unknown header line '{}'", key.substr(0, 40)));
    return {};
  }

  Result<void> read_number(std::string_view key, const std::vector<std::string_view>& values, std::optional<std::uint64_t>& out) const {
    if (values.size() == 1) out = parse_count(values[0]);
    if (values.size() == 1 && out) return {};
    return corrupt(fmt::format("{} = '{}', expected one whole number", key, values.empty() ? "" : values[0].substr(0, 40)));
  }

  Result<void> read_data_kind(const std::vector<std::string_view>& values) {
    const std::string_view kind = values.empty() ? "" : values[0];
    if (kind == "ascii") header_.data = PcdData::kAscii;
    else if (kind == "binary") header_.data = PcdData::kBinary;
    else if (kind == "binary_compressed") header_.data = PcdData::kBinaryCompressed;
    else return corrupt(fmt::format("DATA = '{}', expected ascii, binary or binary_compressed", kind.substr(0, 40)));
    return {};
  }

  Result<void> make_fields() {
    const std::size_t n = lines_.names.size();
    if (n < 1 || n > 256) return corrupt(fmt::format("FIELDS has {} names, expected 1 to 256", n));
    if (lines_.sizes.size() != n || lines_.types.size() != n || (!lines_.counts.empty() && lines_.counts.size() != n))
      return corrupt(fmt::format("SIZE, TYPE and COUNT have {}, {} and {} entries, expected {} as FIELDS has", lines_.sizes.size(),
                                 lines_.types.size(), lines_.counts.size(), n));
    for (std::size_t i = 0; i < n; ++i) {
      const auto size = parse_count(lines_.sizes[i]);
      const auto count = lines_.counts.empty() ? std::optional<std::uint64_t>(1) : parse_count(lines_.counts[i]);
      const char type = lines_.types[i].size() == 1 ? lines_.types[i][0] : '?';
      if (!size || (*size != 1 && *size != 2 && *size != 4 && *size != 8) || (type == 'F' && *size < 4))
        return corrupt(fmt::format("SIZE of {} = '{}', expected 1, 2, 4 or 8 bytes (F: 4 or 8)", lines_.names[i], lines_.sizes[i]));
      if (type != 'F' && type != 'I' && type != 'U')
        return corrupt(fmt::format("TYPE of {} = '{}', expected I, U or F", lines_.names[i], lines_.types[i]));
      if (!count || *count < 1 || *count > kMaxPcdRecordBytes)
        return corrupt(fmt::format("COUNT of {} = '{}', expected 1 to {}", lines_.names[i], lines_.counts[i], kMaxPcdRecordBytes));
      header_.fields.push_back({std::string(lines_.names[i]), static_cast<int>(*size), type, static_cast<int>(*count), header_.record_bytes});
      header_.record_bytes += *size * *count;
    }
    if (header_.record_bytes > kMaxPcdRecordBytes)
      return failure(ErrorCode::kTooLarge, fmt::format("{}: a point has {} bytes, expected at most {}", name_, header_.record_bytes, kMaxPcdRecordBytes));
    return {};
  }

  Result<void> check_size() {
    if (!lines_.width && lines_.points) lines_.width = lines_.points;  // the oldest files have neither WIDTH nor HEIGHT
    if (!lines_.width) return corrupt("WIDTH is missing");
    const std::uint64_t width = *lines_.width, height = lines_.height.value_or(1);
    const std::uint64_t widest = height > 1 ? kMaxImageSide : kMaxUnorganisedPoints;
    if (width > widest || height > kMaxImageSide)
      return failure(ErrorCode::kTooLarge, fmt::format("{}: size = {} x {}, expected at most {} x {}", name_, width, height, widest, kMaxImageSide));
    if (width < 1 || height < 1) return corrupt(fmt::format("size = {} x {}, expected at least 1 x 1", width, height));
    if (lines_.points && *lines_.points != width * height)
      return corrupt(fmt::format("POINTS = {}, expected {} x {} = {}", *lines_.points, width, height, width * height));
    header_.width = static_cast<int>(width);
    header_.height = static_cast<int>(height);
    header_.viewpoint = lines_.viewpoint;
    return {};
  }

  std::string_view bytes_, name_;
  Lines lines_;
  PcdHeader header_;
};

}  // namespace

const PcdField* PcdHeader::find(std::string_view name) const {
  for (const PcdField& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

Result<PcdHeader> parse_pcd_header(std::string_view bytes, std::string_view name) { return HeaderParser(bytes, name).parse(); }

}  // namespace gfp
