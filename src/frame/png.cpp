#include "gfp/frame/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "gfp/frame/read_file.hpp"

// libpng reports errors by longjmp. So each call into it runs inside attempt(), whose frame and callee own nothing that
// needs a destructor; whatever must be freed lives in the caller, and is freed there on both ways out.

namespace gfp {
namespace {

constexpr std::uintmax_t kMaxPngBytes = 512U << 20U;
constexpr std::size_t kHeaderBytes = 8 + 4 + 4 + 13;  // signature, length, "IHDR", fields

std::uint32_t big_endian(const char* at) {
  const auto byte = [&](int i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(at[i])); };
  return byte(0) << 24U | byte(1) << 16U | byte(2) << 8U | byte(3);
}

Result<PngHeader> parse_header(std::string_view bytes, const std::string& name) {
  static constexpr char kSignature[] = "\x89PNG\r\n\x1a\n";
  if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), kSignature, 8) != 0 || bytes.substr(12, 4) != "IHDR")
    return failure(ErrorCode::kCorruptData, fmt::format("{}: not a PNG file ({} bytes)", name, bytes.size()));
  const std::uint32_t width = big_endian(bytes.data() + 16), height = big_endian(bytes.data() + 20);
  if (width < 1 || height < 1)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: size = {} x {}, expected at least 1 x 1", name, width, height));
  if (width > kMaxImageSide || height > kMaxImageSide)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: size = {} x {}, expected at most {} a side", name, width, height, kMaxImageSide));
  return PngHeader{static_cast<int>(width), static_cast<int>(height), bytes[24], bytes[25] == PNG_COLOR_TYPE_GRAY};
}

/// What libpng's callbacks see: the bytes to read or the file to write, and where the message of an error goes.
struct Session {
  std::string_view input;
  std::FILE* output = nullptr;
  char message[128] = {};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* session = static_cast<Session*>(png_get_error_ptr(png));
  std::strncpy(session->message, message, sizeof(session->message) - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, std::size_t count) {
  auto* session = static_cast<Session*>(png_get_io_ptr(png));
  if (count > session->input.size()) png_error(png, "the file ends too early");
  std::memcpy(out, session->input.data(), count);
  session->input.remove_prefix(count);
}

template <class Step>
bool attempt(png_structp png, const Step& step) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  step();
  return true;
}

class PngReader {
 public:
  explicit PngReader(std::string_view bytes) {
    session_.input = bytes;
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &session_, on_error, on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Decodes into `pixels`, rows of `row_bytes` each, after `prepare` has set the transforms.
  template <class Prepare>
  bool read(const Prepare& prepare, png_bytep pixels, std::size_t row_bytes) {
    if (info_ == nullptr) return false;
    return attempt(png_, [&] {
      png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
      png_set_chunk_malloc_max(png_, 8U << 20U);
      png_set_read_fn(png_, &session_, on_read);
      png_read_info(png_, info_);
      prepare(png_, info_);
      const int passes = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
      if (png_get_rowbytes(png_, info_) != row_bytes) png_error(png_, "rows have an unexpected length");
      const png_uint_32 height = png_get_image_height(png_, info_);
      for (int pass = 0; pass < passes; ++pass)
        for (png_uint_32 v = 0; v < height; ++v) png_read_row(png_, pixels + v * row_bytes, nullptr);
      png_read_end(png_, nullptr);  // a file that ends before its end mark was cut
    });
  }
  std::string_view message() const { return session_.message; }

 private:
  Session session_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

template <class Pixel, class Prepare>
Result<Image<Pixel>> decode(std::string_view bytes, const PngHeader& header, const std::string& name, const Prepare& prepare) {
  Image<Pixel> image(header.width, header.height);
  PngReader reader(bytes);
  const std::size_t row_bytes = static_cast<std::size_t>(header.width) * sizeof(Pixel);
  if (!reader.read(prepare, reinterpret_cast<png_bytep>(image.pixels.data()), row_bytes))
    return failure(ErrorCode::kCorruptData, fmt::format("{}: damaged PNG: {}", name, reader.message()));
  return image;
}

struct PngFile {
  std::string bytes;
  PngHeader header;
};

Result<PngFile> load(const std::filesystem::path& path) {
  Result<std::string> bytes = read_file(path, kMaxPngBytes);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  const Result<PngHeader> header = parse_header(*bytes, path.string());
  if (!header) return tl::unexpected<Error>(header.error());
  return PngFile{std::move(*bytes), *header};
}

tl::unexpected<Error> wrong_pixels(const std::string& name, const PngHeader& header, std::string_view expected) {
  return failure(ErrorCode::kUnsupported, fmt::format("{}: pixels are {} bit {}, expected {}", name, header.bit_depth,
                                                      header.grey ? "grey" : "colour", expected));
}

void write_all(png_structp png, png_infop info, const Session& session, const std::uint8_t* pixels, int width, int height,
               int bit_depth, int color_type, std::size_t row_bytes) {
  png_init_io(png, session.output);
  png_set_compression_level(png, 3);  // pictures and tests: fast matters more than the last tenth of the size
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bit_depth, color_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (bit_depth == 16) png_set_swap(png);
  for (int v = 0; v < height; ++v) png_write_row(png, pixels + static_cast<std::size_t>(v) * row_bytes);
  png_write_end(png, info);
}

template <class Pixel>
Result<void> write(const std::filesystem::path& path, const Image<Pixel>& image, int bit_depth, int color_type) {
  const auto side_ok = [](int side) { return side >= 1 && side <= kMaxImageSide; };
  if (!side_ok(image.width) || !side_ok(image.height))
    return failure(ErrorCode::kInvalidArgument, fmt::format("{}: image is {} x {}, expected 1 to {} a side", path.string(),
                                                            image.width, image.height, kMaxImageSide));
  Session session;
  session.output = std::fopen(path.c_str(), "wb");
  if (session.output == nullptr)
    return failure(ErrorCode::kIo, fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &session, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(image.pixels.data());
  const std::size_t row_bytes = static_cast<std::size_t>(image.width) * sizeof(Pixel);
  const bool written = info != nullptr && attempt(png, [&] {
    write_all(png, info, session, pixels, image.width, image.height, bit_depth, color_type, row_bytes);
  });
  png_destroy_write_struct(&png, &info);
  const bool closed = std::fclose(session.output) == 0;
  if (!written || !closed) return failure(ErrorCode::kIo, fmt::format("{}: cannot be written: {}", path.string(), session.message));
  return {};
}

}  // namespace

Result<PngHeader> read_png_header(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return failure(ErrorCode::kNotFound, fmt::format("{}: no such file", path.string()));
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kHeaderBytes, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return parse_header(bytes, path.string());
}

Result<Image<std::uint16_t>> read_png_depth(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path, kMaxPngBytes);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  return decode_png_depth(*bytes, path.string());
}

Result<Image<std::uint16_t>> decode_png_depth(std::string_view bytes, const std::string& name) {
  const Result<PngHeader> header = parse_header(bytes, name);
  if (!header) return tl::unexpected<Error>(header.error());
  if (!header->grey || header->bit_depth != 16) return wrong_pixels(name, *header, "16 bit grey (depth)");
  return decode<std::uint16_t>(bytes, *header, name, [](png_structp png, png_infop) { png_set_swap(png); });
}

Result<Image<std::uint8_t>> read_png_grey(const std::filesystem::path& path) {
  const Result<PngFile> file = load(path);
  if (!file) return tl::unexpected<Error>(file.error());
  if (!file->header.grey || file->header.bit_depth > 8) return wrong_pixels(path.string(), file->header, "8 bit grey");
  return decode<std::uint8_t>(file->bytes, file->header, path.string(), [](png_structp png, png_infop) { png_set_packing(png); });
}

Result<Image<Rgb8>> read_png_color(const std::filesystem::path& path) {
  const Result<PngFile> file = load(path);
  if (!file) return tl::unexpected<Error>(file.error());
  return decode<Rgb8>(file->bytes, file->header, path.string(), [](png_structp png, png_infop) {
    png_set_expand(png);
    png_set_strip_16(png);
    png_set_strip_alpha(png);
    png_set_gray_to_rgb(png);
  });
}

Result<void> write_png(const std::filesystem::path& path, const Image<Rgb8>& image) {
  return write(path, image, 8, PNG_COLOR_TYPE_RGB);
}
Result<void> write_png(const std::filesystem::path& path, const Image<std::uint16_t>& image) {
  return write(path, image, 16, PNG_COLOR_TYPE_GRAY);
}
Result<void> write_png(const std::filesystem::path& path, const Image<std::uint8_t>& image) {
  return write(path, image, 8, PNG_COLOR_TYPE_GRAY);
}

}  // namespace gfp
