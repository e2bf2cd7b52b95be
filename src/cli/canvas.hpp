#pragma once

#include <Eigen/Core>
#include <string_view>

#include "gfp/core/image.hpp"

namespace gfp {

/// Draws into an RGB image; everything outside is clipped. Coordinates in pixels, centres at integers.
class Canvas {
 public:
  Canvas(int width, int height, Rgb8 background) : image_(width, height, background) {}

  const Image<Rgb8>& image() const { return image_; }
  int width() const { return image_.width; }
  int height() const { return image_.height; }

  /// Lays `color` over the pixel, `alpha` from 0 (nothing) to 1 (opaque).
  void blend(int u, int v, Rgb8 color, double alpha = 1);
  void fill(const PixelRect& rect, Rgb8 color, double alpha = 1);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Rgb8 color, double thickness_px = 1, double alpha = 1);
  void disc(const Eigen::Vector2d& centre, double radius_px, Rgb8 color, double alpha = 1);
  /// Upper-left corner at (u, v); letters are capitals of 5 x 7 dots, `scale` pixels a dot. Returns the column after the text.
  int text(int u, int v, std::string_view text, Rgb8 color, int scale = 2);
  /// The same on a dark plate, moved to stay inside the image.
  void label(int u, int v, std::string_view text, Rgb8 color, int scale = 2);
  void paste(const Image<Rgb8>& other, int u, int v);

  static int text_width(std::string_view text, int scale) { return 6 * scale * static_cast<int>(text.size()); }
  static constexpr int kTextRows = 7;

 private:
  Image<Rgb8> image_;
};

/// A colour that people tell apart from its neighbours in the list; the list repeats after twelve.
Rgb8 distinct_color(std::uint64_t index);

/// Darkened or lightened by `factor`.
Rgb8 shaded(Rgb8 color, double factor);

}  // namespace gfp
