#include "gfp/frame/jpeg.hpp"

#include <csetjmp>
#include <cstdio>
#include <string>
// jpeglib.h needs the types of <cstdio> before it
#include <jpeglib.h>

#include "gfp/frame/read_file.hpp"

namespace gfp {
namespace {

/// libjpeg leaves by calling error_exit, which must not return.
struct Decoder {
  jpeg_decompress_struct state{};
  jpeg_error_mgr errors{};
  std::jmp_buf leave;
  char why[JMSG_LENGTH_MAX] = {};

  Decoder() {
    state.err = jpeg_std_error(&errors);
    state.client_data = this;
    errors.error_exit = [](j_common_ptr common) {
      auto& decoder = *static_cast<Decoder*>(common->client_data);
      common->err->format_message(common, decoder.why);
      std::longjmp(decoder.leave, 1);
    };
    // Warnings (a file that was cut off) are errors too.
    errors.emit_message = [](j_common_ptr common, int level) {
      if (level < 0) common->err->error_exit(common);
    };
    jpeg_create_decompress(&state);
  }
  ~Decoder() { jpeg_destroy_decompress(&state); }
};

/// False: libjpeg refused, `decoder.why` says why. No object with a destructor may be made in here: longjmp would skip it.
bool start(Decoder& decoder, const std::string& bytes) {
  if (setjmp(decoder.leave) != 0) return false;
  jpeg_mem_src(&decoder.state, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder.state, TRUE);
  decoder.state.out_color_space = JCS_GRAYSCALE;
  return true;
}

bool decode(Decoder& decoder, Image<std::uint8_t>& image) {
  if (setjmp(decoder.leave) != 0) return false;
  jpeg_start_decompress(&decoder.state);
  while (decoder.state.output_scanline < decoder.state.output_height) {
    JSAMPROW row = &image.pixels[image.index(0, static_cast<int>(decoder.state.output_scanline))];
    jpeg_read_scanlines(&decoder.state, &row, 1);
  }
  jpeg_finish_decompress(&decoder.state);
  return true;
}

}  // namespace

Result<Image<std::uint8_t>> read_jpeg_grey(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = 64U << 20;
  const auto bytes = read_file(path, kMaxBytes);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  Decoder decoder;
  if (!start(decoder, *bytes)) return failure(ErrorCode::kCorruptData, path.string() + ": " + decoder.why);
  const auto width = decoder.state.image_width, height = decoder.state.image_height;
  if (width > kMaxImageSide || height > kMaxImageSide)
    return failure(ErrorCode::kTooLarge, path.string() + ": " + std::to_string(width) + " x " + std::to_string(height) + " pixels, expected at most " + std::to_string(kMaxImageSide) + " a side");
  Image<std::uint8_t> image(static_cast<int>(width), static_cast<int>(height));
  if (!decode(decoder, image)) return failure(ErrorCode::kCorruptData, path.string() + ": " + decoder.why);
  return image;
}

}  // namespace gfp
