#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gfp {

/// Row-major image; pixel (u, v) is column u from the left, row v from the top.
template <class T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int width_px, int height_px, T value = {})
      : width(width_px), height(height_px),
        pixels(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), value) {}

  bool empty() const { return pixels.empty(); }
  bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
  std::size_t index(int u, int v) const {
    assert(contains(u, v));
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
  }
  T& at(int u, int v) { return pixels[index(u, v)]; }
  const T& at(int u, int v) const { return pixels[index(u, v)]; }
};

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Half-open pixel rectangle: columns [u0, u1), rows [v0, v1).
struct PixelRect {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  int width() const { return u1 - u0; }
  int height() const { return v1 - v0; }
  bool contains(int u, int v) const { return u >= u0 && v >= v0 && u < u1 && v < v1; }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// No image of ours is larger; readers refuse more before they allocate.
inline constexpr int kMaxImageSide = 8192;

}  // namespace gfp
