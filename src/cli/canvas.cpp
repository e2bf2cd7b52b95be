#include "cli/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cli/font5x7.hpp"

namespace gfp {
namespace {

std::uint8_t mix(std::uint8_t under, std::uint8_t over, double alpha) {
  return static_cast<std::uint8_t>(std::lround(under + alpha * (over - under)));
}

constexpr double kFarOutsidePx = 1e5;  // a projected point beyond this is of no use, and its line would take for ever

bool drawable(const Eigen::Vector2d& point) { return point.allFinite() && point.cwiseAbs().maxCoeff() < kFarOutsidePx; }

}  // namespace

void Canvas::blend(int u, int v, Rgb8 color, double alpha) {
  if (!image_.contains(u, v)) return;
  Rgb8& pixel = image_.at(u, v);
  pixel = {mix(pixel.r, color.r, alpha), mix(pixel.g, color.g, alpha), mix(pixel.b, color.b, alpha)};
}

void Canvas::fill(const PixelRect& rect, Rgb8 color, double alpha) {
  for (int v = std::max(0, rect.v0); v < std::min(height(), rect.v1); ++v)
    for (int u = std::max(0, rect.u0); u < std::min(width(), rect.u1); ++u) blend(u, v, color, alpha);
}

void Canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Rgb8 color, double thickness_px, double alpha) {
  if (!drawable(from) || !drawable(to)) return;
  // Coverage by distance to the segment, over its bounding box walked along the longer axis.
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm(), half = 0.5 * thickness_px;
  const bool steep = std::abs(along.y()) > std::abs(along.x());
  const int major = steep ? 1 : 0, minor = 1 - major;
  const int limit = steep ? height() : width();
  const int first = std::max(0, static_cast<int>(std::floor(std::min(from[major], to[major]) - half)));
  const int last = std::min(limit - 1, static_cast<int>(std::ceil(std::max(from[major], to[major]) + half)));
  const int reach = static_cast<int>(std::ceil(1.5 * half)) + 1;
  for (int m = first; m <= last; ++m) {
    const double t = along[major] != 0 ? std::clamp((m - from[major]) / along[major], 0.0, 1.0) : 0.0;
    const int middle = static_cast<int>(std::lround(from[minor] + t * along[minor]));
    for (int n = middle - reach; n <= middle + reach; ++n) {
      const Eigen::Vector2d pixel = steep ? Eigen::Vector2d(n, m) : Eigen::Vector2d(m, n);
      const double s = length2 > 0 ? std::clamp((pixel - from).dot(along) / length2, 0.0, 1.0) : 0.0;
      const double coverage = std::clamp(half + 0.5 - (pixel - from - s * along).norm(), 0.0, 1.0);
      if (coverage > 0) blend(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()), color, alpha * coverage);
    }
  }
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius_px, Rgb8 color, double alpha) {
  if (!drawable(centre)) return;
  const int reach = static_cast<int>(std::ceil(radius_px)) + 1;
  const int u0 = static_cast<int>(std::lround(centre.x())), v0 = static_cast<int>(std::lround(centre.y()));
  for (int v = v0 - reach; v <= v0 + reach; ++v)
    for (int u = u0 - reach; u <= u0 + reach; ++u)
      blend(u, v, color, alpha * std::clamp(radius_px + 0.5 - (Eigen::Vector2d(u, v) - centre).norm(), 0.0, 1.0));
}

int Canvas::text(int u, int v, std::string_view text, Rgb8 color, int scale) {
  for (const char letter : text) {
    const Glyph& rows = glyph(letter);
    for (int row = 0; row < kTextRows; ++row)
      for (int column = 0; column < 5; ++column)
        if (rows[static_cast<std::size_t>(row)] >> (4 - column) & 1)
          fill({u + column * scale, v + row * scale, u + (column + 1) * scale, v + (row + 1) * scale}, color);
    u += 6 * scale;
  }
  return u;
}

void Canvas::label(int u, int v, std::string_view words, Rgb8 color, int scale) {
  const int pad = 2 * scale, w = text_width(words, scale) + 2 * pad, h = kTextRows * scale + 2 * pad;
  u = std::clamp(u, 0, std::max(0, width() - w));
  v = std::clamp(v, 0, std::max(0, height() - h));
  fill({u, v, u + w, v + h}, {12, 12, 16}, 0.75);
  text(u + pad, v + pad, words, color, scale);
}

void Canvas::paste(const Image<Rgb8>& other, int u, int v) {
  for (int y = 0; y < other.height; ++y)
    for (int x = 0; x < other.width; ++x)
      if (image_.contains(u + x, v + y)) image_.at(u + x, v + y) = other.at(x, y);
}

Rgb8 distinct_color(std::uint64_t index) {
  constexpr std::array<Rgb8, 12> kColors{{{255, 99, 71}, {64, 196, 255}, {124, 222, 74}, {255, 200, 40}, {214, 112, 255}, {0, 224, 190},
                                          {255, 140, 190}, {255, 150, 40}, {130, 150, 255}, {200, 230, 60}, {230, 90, 130}, {120, 220, 255}}};
  return kColors[index % kColors.size()];
}

Rgb8 shaded(Rgb8 color, double factor) {
  const auto scale = [factor](std::uint8_t value) { return static_cast<std::uint8_t>(std::clamp(std::lround(factor * value), 0L, 255L)); };
  return {scale(color.r), scale(color.g), scale(color.b)};
}

}  // namespace gfp
