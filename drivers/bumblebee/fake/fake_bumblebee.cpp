#include "bumblebee/fake/fake_bumblebee.hpp"

#include <fmt/format.h>

#include <utility>

namespace gfp {
namespace {

constexpr std::uint32_t kMono8 = 0x01080001, kMono16 = 0x01100007;  // PFNC

std::vector<std::uint8_t> interleaved(const StereoPair& pair) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * pair.left.pixels.size());
  for (std::size_t i = 0; i < pair.left.pixels.size(); ++i) {
    bytes.push_back(pair.right.pixels[i]);
    bytes.push_back(pair.left.pixels[i]);
  }
  return bytes;
}

std::vector<std::uint8_t> one_after_the_other(const StereoPair& pair) {
  std::vector<std::uint8_t> bytes = pair.left.pixels;
  bytes.insert(bytes.end(), pair.right.pixels.begin(), pair.right.pixels.end());
  return bytes;
}

}  // namespace

Result<std::unique_ptr<FakeBumblebee>> FakeBumblebee::start(const std::vector<StereoPair>& pairs, const FakeBumblebeeOptions& options) {
  if (pairs.empty()) return failure(ErrorCode::kInvalidArgument, "fake bumblebee: no pictures");
  const int width = pairs.front().left.width, height = pairs.front().left.height;
  GigeFormat format{width, height, kMono8, 1};
  if (options.layout == "interleaved") format.pixel_format = kMono16;
  else if (options.layout == "stacked") format.height = 2 * height;
  else if (options.layout == "parts") format.parts = 2;
  else if (options.layout != "left" && options.layout != "right")
    return failure(ErrorCode::kInvalidArgument, fmt::format("fake bumblebee: layout = {}, expected interleaved, stacked, parts, left or right", options.layout));
  std::vector<std::vector<std::uint8_t>> transfers;
  for (const StereoPair& pair : pairs) {
    if (pair.left.width != width || pair.left.height != height || pair.right.width != width || pair.right.height != height)
      return failure(ErrorCode::kInvalidArgument, "fake bumblebee: pictures of different sizes");
    transfers.push_back(options.layout == "interleaved" ? interleaved(pair) : options.layout == "left" ? pair.left.pixels : options.layout == "right" ? pair.right.pixels : one_after_the_other(pair));
  }
  return GigeCamera::start(format, std::move(transfers), options.camera).map([](std::unique_ptr<GigeCamera> camera) { return std::unique_ptr<FakeBumblebee>(new FakeBumblebee(std::move(camera))); });
}

}  // namespace gfp
