#include "replay/pcd.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>

#include "gfp/frame/read_file.hpp"
#include "replay/lzf.hpp"

static_assert(std::endian::native == std::endian::little, "PCD's binary data are little-endian");

namespace gfp {
namespace {

/// The points' bytes: record after record, or (planar) field after field.
struct Records {
  std::string decoded;       ///< Empty where the records lie in the file itself.
  std::string_view in_file;
  bool planar = false;

  const char* begin() const { return decoded.empty() ? in_file.data() : decoded.data(); }
};

Result<Records> binary_records(const PcdHeader& header, std::string_view body, std::string_view name) {
  const std::size_t needed = header.points() * header.record_bytes;
  if (body.size() < needed)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: data = {} bytes, expected {} for {} x {} points of {} bytes", name,
                                                        body.size(), needed, header.width, header.height, header.record_bytes));
  return Records{{}, body.substr(0, needed), false};
}

Result<Records> compressed_records(const PcdHeader& header, std::string_view body, std::string_view name) {
  std::uint32_t sizes[2] = {};  // compressed, uncompressed
  if (body.size() < sizeof(sizes)) return failure(ErrorCode::kCorruptData, fmt::format("{}: the file ends before its data", name));
  std::memcpy(sizes, body.data(), sizeof(sizes));
  body.remove_prefix(sizeof(sizes));
  if (sizes[0] > body.size())
    return failure(ErrorCode::kCorruptData, fmt::format("{}: compressed data = {} bytes, expected {}", name, body.size(), sizes[0]));
  const std::size_t needed = header.points() * header.record_bytes;
  if (sizes[1] != needed)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: uncompressed size = {} bytes, expected {} for {} x {} points of {} bytes", name,
                                                        sizes[1], needed, header.width, header.height, header.record_bytes));
  Result<std::string> bytes = decompress_lzf(body.substr(0, sizes[0]), needed, name);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  return Records{std::move(*bytes), {}, true};
}

std::string_view next_word(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  text.remove_prefix(begin);
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
  text.remove_prefix(word.size());
  return word;
}

template <class Number, class Stored>
bool store_as(std::string_view word, char* out) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return false;
  const auto stored = static_cast<Stored>(value);
  std::memcpy(out, &stored, sizeof(stored));
  return true;
}

/// Writes an ascii value as binary data would hold it.
bool store(std::string_view word, const PcdField& field, char* out) {
  if (field.type == 'F') return field.size == 4 ? store_as<double, float>(word, out) : store_as<double, double>(word, out);
  switch (field.size) {
    case 1: return field.type == 'I' ? store_as<std::int8_t, std::int8_t>(word, out) : store_as<std::uint8_t, std::uint8_t>(word, out);
    case 2: return field.type == 'I' ? store_as<std::int16_t, std::int16_t>(word, out) : store_as<std::uint16_t, std::uint16_t>(word, out);
    case 4: return field.type == 'I' ? store_as<std::int32_t, std::int32_t>(word, out) : store_as<std::uint32_t, std::uint32_t>(word, out);
    default: return field.type == 'I' ? store_as<std::int64_t, std::int64_t>(word, out) : store_as<std::uint64_t, std::uint64_t>(word, out);
  }
}

/// Ascii becomes the same records as binary, so that what follows is written once.
Result<Records> ascii_records(const PcdHeader& header, std::string_view body, std::string_view name) {
  std::size_t values = 0;
  for (const PcdField& field : header.fields) values += static_cast<std::size_t>(field.count);
  const std::size_t fewest_bytes = 2 * values * header.points() - 1;  // a digit and a separator each
  if (body.size() < fewest_bytes)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: data = {} bytes, expected at least {} for {} x {} points", name, body.size(),
                                                        fewest_bytes, header.width, header.height));
  Records records{std::string(header.points() * header.record_bytes, '\0'), {}, false};
  char* out = records.decoded.data();
  for (std::size_t point = 0; point < header.points(); ++point)
    for (const PcdField& field : header.fields)
      for (int k = 0; k < field.count; ++k, out += field.size) {
        const std::string_view word = next_word(body);
        if (!store(word, field, out))
          return failure(ErrorCode::kCorruptData, fmt::format("{}: point {}, field {} = '{}', expected a number of type {}{}", name, point,
                                                              field.name, word.substr(0, 40), field.type, field.size));
      }
  return records;
}

Result<Records> read_records(const PcdHeader& header, std::string_view body, std::string_view name) {
  if (header.points() * header.record_bytes > kMaxPcdBytes)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: {} x {} points of {} bytes, expected at most {} bytes", name, header.width,
                                                     header.height, header.record_bytes, kMaxPcdBytes));
  switch (header.data) {
    case PcdData::kAscii: return ascii_records(header, body, name);
    case PcdData::kBinary: return binary_records(header, body, name);
    case PcdData::kBinaryCompressed: return compressed_records(header, body, name);
  }
  return failure(ErrorCode::kUnsupported, std::string(name));
}

/// One field of all points.
class Column {
 public:
  Column(const PcdHeader& header, const PcdField& field, const Records& records)
      : type_(field.type), size_(field.size),
        first_(records.begin() + field.offset * (records.planar ? header.points() : 1)),
        stride_(records.planar ? static_cast<std::size_t>(field.size * field.count) : header.record_bytes) {}

  template <class T>
  T raw(std::size_t point) const {
    T value;
    std::memcpy(&value, first_ + point * stride_, sizeof(value));
    return value;
  }
  /// The value as a number of type T, whatever the file stores.
  template <class T>
  T number(std::size_t point) const {
    if (type_ == 'F') return size_ == 4 ? cast<T, float>(point) : cast<T, double>(point);
    const bool is_signed = type_ == 'I';
    switch (size_) {
      case 1: return is_signed ? cast<T, std::int8_t>(point) : cast<T, std::uint8_t>(point);
      case 2: return is_signed ? cast<T, std::int16_t>(point) : cast<T, std::uint16_t>(point);
      case 4: return is_signed ? cast<T, std::int32_t>(point) : cast<T, std::uint32_t>(point);
      default: return is_signed ? cast<T, std::int64_t>(point) : cast<T, std::uint64_t>(point);
    }
  }

 private:
  template <class T, class Stored>
  T cast(std::size_t point) const { return static_cast<T>(raw<Stored>(point)); }

  char type_;
  int size_;
  const char* first_;
  std::size_t stride_;
};

Image<Rgb8> color_of(const PcdHeader& header, const Column& column) {
  Image<Rgb8> color(header.width, header.height);
  for (std::size_t i = 0; i < color.pixels.size(); ++i) {
    const auto bits = column.raw<std::uint32_t>(i);  // 0xAARRGGBB, whether the type says U or F
    color.pixels[i] = {static_cast<std::uint8_t>(bits >> 16U), static_cast<std::uint8_t>(bits >> 8U), static_cast<std::uint8_t>(bits)};
  }
  return color;
}

PcdCloud make_cloud(const PcdHeader& header, const Records& records) {
  PcdCloud cloud;
  cloud.width = header.width, cloud.height = header.height;
  cloud.viewpoint = header.viewpoint;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Column column(header, *header.find(std::string_view("xyz").substr(axis, 1)), records);
    cloud.xyz[axis].resize(header.points());
    for (std::size_t i = 0; i < header.points(); ++i) cloud.xyz[axis][i] = column.number<float>(i);
  }
  for (const char* name : {"rgb", "rgba"})
    if (const PcdField* field = header.find(name); field != nullptr && field->size == 4)
      cloud.color = color_of(header, Column(header, *field, records));
  if (const PcdField* field = header.find("label"); field != nullptr && field->type != 'F') {
    cloud.labels = Image<std::uint32_t>(header.width, header.height);
    const Column column(header, *field, records);
    for (std::size_t i = 0; i < header.points(); ++i) cloud.labels.pixels[i] = column.number<std::uint32_t>(i);
  }
  return cloud;
}

}  // namespace

Result<PcdCloud> decode_pcd(std::string_view bytes, std::string_view name) {
  const Result<PcdHeader> header = parse_pcd_header(bytes, name);
  if (!header) return tl::unexpected<Error>(header.error());
  if (header->height == 1)
    return failure(ErrorCode::kUnsupported, fmt::format("{}: the cloud is unorganised ({} x 1), expected one point per pixel (HEIGHT above 1)",
                                                        name, header->width));
  for (const char* axis : {"x", "y", "z"})
    if (header->find(axis) == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("{}: no field {}, expected x, y and z", name, axis));
  const Result<Records> records = read_records(*header, bytes.substr(header->data_offset), name);
  if (!records) return tl::unexpected<Error>(records.error());
  return make_cloud(*header, *records);
}

Result<PcdCloud> read_pcd(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path, kMaxPcdBytes);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  return decode_pcd(*bytes, path.string());
}

Result<Image<std::uint32_t>> read_pcd_labels(const std::filesystem::path& path) {
  Result<PcdCloud> cloud = read_pcd(path);
  if (!cloud) return tl::unexpected<Error>(cloud.error());
  if (cloud->labels.empty()) return failure(ErrorCode::kUnsupported, fmt::format("{}: no field label of whole numbers", path.string()));
  return std::move(cloud->labels);
}

}  // namespace gfp
