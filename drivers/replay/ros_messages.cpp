#include "replay/ros_messages.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "gfp/frame/png.hpp"
#include "replay/cdr.hpp"
#include "replay/load_frame.hpp"

namespace gfp {
namespace {

struct Header {
  Nanoseconds stamp{};
  std::string_view frame_id;
};

Header read_header(CdrReader& cdr) {
  Header header;
  const auto seconds = cdr.number<std::int32_t>();
  header.stamp = std::chrono::seconds(seconds) + Nanoseconds(cdr.number<std::uint32_t>());
  header.frame_id = cdr.text();
  return header;
}

struct RosImage {
  std::uint32_t width = 0, height = 0, step = 0;
  std::string_view encoding, data;
  bool is_big_endian = false;
};

tl::unexpected<Error> no_message(std::string_view what) { return failure(ErrorCode::kCorruptData, fmt::format("the bytes are no {}", what)); }

Result<RosImage> read_image(std::string_view message) {
  CdrReader cdr(message);
  read_header(cdr);
  RosImage image;
  image.height = cdr.number<std::uint32_t>();
  image.width = cdr.number<std::uint32_t>();
  image.encoding = cdr.text();
  image.is_big_endian = cdr.number<std::uint8_t>() != 0;
  image.step = cdr.number<std::uint32_t>();
  image.data = cdr.octets();
  if (!cdr.ok()) return no_message("sensor_msgs/Image");
  if (image.width > kMaxImageSide || image.height > kMaxImageSide)
    return failure(ErrorCode::kTooLarge, fmt::format("image is {} x {}, expected at most {} a side", image.width, image.height, kMaxImageSide));
  return image;
}

Result<void> check_rows(const RosImage& image, std::size_t bytes_per_pixel) {
  const bool fits = image.width > 0 && image.height > 0 && image.step >= image.width * bytes_per_pixel && std::uint64_t{image.step} * image.height <= image.data.size();
  if (!fits)
    return failure(ErrorCode::kCorruptData, fmt::format("image of {} x {} with rows of {} bytes has {} bytes", image.width, image.height, image.step, image.data.size()));
  if (image.is_big_endian && bytes_per_pixel != 1 && bytes_per_pixel != 3) return failure(ErrorCode::kUnsupported, "image is big-endian, expected little-endian");
  return {};
}

template <class Pixel>
std::vector<Pixel> pixels_of(const RosImage& image) {
  std::vector<Pixel> pixels(static_cast<std::size_t>(image.width) * image.height);
  for (std::size_t v = 0; v < image.height; ++v)
    std::memcpy(static_cast<void*>(&pixels[v * image.width]), image.data.data() + v * image.step, image.width * sizeof(Pixel));
  return pixels;
}

DepthImage depth_of_metres(int width, int height, const std::vector<float>& z_m) { return quantise_depth(width, height, z_m); }

/// What compressed_depth_image_transport puts before the PNG: how inverse depth of 32FC1 was quantised, z = a / (value - b).
struct DepthCoding {
  std::uint32_t format = 0;
  float a = 0, b = 0;
};

}  // namespace

Result<Nanoseconds> ros_stamp(std::string_view message) {
  CdrReader cdr(message);
  const Header header = read_header(cdr);
  if (!cdr.ok()) return no_message("stamped message");
  return header.stamp;
}

Result<DepthImage> depth_from_ros_image(std::string_view message, double scale_m) {
  const auto image = read_image(message);
  if (!image) return tl::unexpected(image.error());
  const int width = static_cast<int>(image->width), height = static_cast<int>(image->height);
  const bool is_float = image->encoding == "32FC1";
  if (!is_float && image->encoding != "16UC1" && image->encoding != "mono16")
    return failure(ErrorCode::kUnsupported, fmt::format("depth encoding {}, expected 16UC1, mono16 or 32FC1", image->encoding.substr(0, 32)));
  if (auto fits = check_rows(*image, is_float ? 4 : 2); !fits) return tl::unexpected(fits.error());
  if (is_float) return depth_of_metres(width, height, pixels_of<float>(*image));
  DepthImage depth{{}, scale_m};
  depth.pixels.width = width;
  depth.pixels.height = height;
  depth.pixels.pixels = pixels_of<std::uint16_t>(*image);
  return depth;
}

Result<DepthImage> depth_from_ros_compressed(std::string_view message, double scale_m) {
  CdrReader cdr(message);
  read_header(cdr);
  const std::string_view format = cdr.text(), data = cdr.octets();
  if (!cdr.ok()) return no_message("sensor_msgs/CompressedImage");
  const bool is_float = format.starts_with("32FC1"), is_depth = format.find("compressedDepth") != std::string_view::npos;
  if (!is_depth || (!is_float && !format.starts_with("16UC1")) || format.find("rvl") != std::string_view::npos)
    return failure(ErrorCode::kUnsupported, fmt::format("format `{}`, expected 16UC1 or 32FC1 compressedDepth png", format.substr(0, 64)));
  DepthCoding coding;
  if (data.size() < sizeof coding) return no_message("compressedDepth image");
  std::memcpy(&coding, data.data(), sizeof coding);
  auto pixels = decode_png_depth(data.substr(sizeof coding), "compressedDepth");
  if (!pixels) return tl::unexpected(pixels.error());
  if (!is_float) return DepthImage{std::move(*pixels), scale_m};
  std::vector<float> z_m(pixels->pixels.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < z_m.size(); ++i)
    if (pixels->pixels[i] != 0) z_m[i] = coding.a / (static_cast<float>(pixels->pixels[i]) - coding.b);
  return depth_of_metres(pixels->width, pixels->height, z_m);
}

Result<Image<Rgb8>> color_from_ros_image(std::string_view message) {
  const auto image = read_image(message);
  if (!image) return tl::unexpected(image.error());
  const bool is_bgr = image->encoding == "bgr8", is_grey = image->encoding == "mono8";
  if (image->encoding != "rgb8" && !is_bgr && !is_grey)
    return failure(ErrorCode::kUnsupported, fmt::format("colour encoding {}, expected rgb8, bgr8 or mono8", image->encoding.substr(0, 32)));
  if (auto fits = check_rows(*image, is_grey ? 1 : 3); !fits) return tl::unexpected(fits.error());
  Image<Rgb8> color;
  color.width = static_cast<int>(image->width);
  color.height = static_cast<int>(image->height);
  if (is_grey) {
    for (const std::uint8_t grey : pixels_of<std::uint8_t>(*image)) color.pixels.push_back({grey, grey, grey});
    return color;
  }
  color.pixels = pixels_of<Rgb8>(*image);
  if (is_bgr)
    for (Rgb8& pixel : color.pixels) std::swap(pixel.r, pixel.b);
  return color;
}

Result<CameraModel> camera_from_ros_info(std::string_view message) {
  CdrReader cdr(message);
  read_header(cdr);
  const auto height = cdr.number<std::uint32_t>(), width = cdr.number<std::uint32_t>();
  const std::string model(cdr.text());
  std::vector<double> distortion(std::min(cdr.number<std::uint32_t>(), 64U));
  for (double& value : distortion) value = cdr.number<double>();
  std::array<double, 9> K{};
  for (double& value : K) value = cdr.number<double>();
  if (!cdr.ok()) return no_message("sensor_msgs/CameraInfo");
  return camera_from_matrix(width, height, K, model, std::move(distortion));
}

}  // namespace gfp
