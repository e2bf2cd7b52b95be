#include "gfp/core/box_normals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gfp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kLanes = 32;  // pixels of one inner loop
constexpr float kMinReadings = 6;

// The rectangle grown by the box, in rows of `stride` floats: 1/z (0 where there is no reading) and, for the clean boxes,
// the rows' moments. Outside the image there are no readings.
struct Tile {
  int width, height, stride;
  std::vector<float> inverse, broken, row_sum, row_moment, row_broken;

  Tile(int w, int h) : width(w), height(h), stride(w + kLanes) {
    for (auto* plane : {&inverse, &broken, &row_sum, &row_moment, &row_broken})
      plane->assign(static_cast<std::size_t>(stride) * static_cast<std::size_t>(h), 0.0F);
  }
  std::size_t at(int row, int column) const { return static_cast<std::size_t>(row) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(column); }
};

__attribute__((target_clones("arch=x86-64-v3", "default")))
void invert_row(const float* z, int count, float* __restrict inverse) {
  for (int i = 0; i < count; ++i) inverse[i] = z[i] > 0.0F ? 1.0F / z[i] : 0.0F;
}

// A pixel is broken where it has no reading or where its right or lower neighbour is on another surface (or has none).
__attribute__((target_clones("arch=x86-64-v3", "default")))
void break_row(const float* w, const float* below, int count, float step, float* __restrict broken) {
  for (int i = 0; i < count; ++i) {
    const float right = std::abs(w[i + 1] - w[i]), down = std::abs(below[i] - w[i]), limit = step * w[i];
    broken[i] = ((w[i] > 0.0F) & (right <= limit) & (down <= limit)) ? 0.0F : 1.0F;
  }
}

// Sums over the 2r + 1 pixels around each of `count` pixels of a row: of w, of offset * w, and of the broken flags.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void row_moments(const float* w, const float* broken, int count, int radius, float* __restrict sum, float* __restrict moment, float* __restrict breaks) {
  for (int i = 0; i < count; ++i) {
    sum[i] = w[i];
    moment[i] = 0.0F;
    breaks[i] = broken[i];
  }
  for (int k = 1; k <= radius; ++k) {
    const float offset = static_cast<float>(k);
    for (int i = 0; i < count; ++i) {
      sum[i] += w[i + k] + w[i - k];
      moment[i] += offset * (w[i + k] - w[i - k]);
      breaks[i] += broken[i + k] + broken[i - k];
    }
  }
}

struct Slopes {
  float du[kLanes], dv[kLanes], mean[kLanes], clean[kLanes];  // of 1/z per pixel; 1/z at the centre; whether the box is whole
};

__attribute__((target_clones("arch=x86-64-v3", "default")))
void clean_slopes(const float* sum, const float* moment, const float* breaks, std::ptrdiff_t stride, int radius, Slopes& out) {
  float total[kLanes], mu[kLanes], mv[kLanes], broken[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    total[i] = sum[i];
    mu[i] = moment[i];
    mv[i] = 0.0F;
    broken[i] = breaks[i];
  }
  for (int k = 1; k <= radius; ++k) {
    const float offset = static_cast<float>(k);
    const std::ptrdiff_t down = k * stride;
    for (int i = 0; i < kLanes; ++i) {
      total[i] += sum[i + down] + sum[i - down];
      mu[i] += moment[i + down] + moment[i - down];
      mv[i] += offset * (sum[i + down] - sum[i - down]);
      broken[i] += breaks[i + down] + breaks[i - down];
    }
  }
  const float side = static_cast<float>(2 * radius + 1);
  const float second = side * static_cast<float>(radius * (radius + 1) * (2 * radius + 1)) / 3.0F;  // sum of offset^2 over the box
  for (int i = 0; i < kLanes; ++i) {
    out.du[i] = mu[i] / second;
    out.dv[i] = mv[i] / second;
    out.mean[i] = total[i] / (side * side);
    out.clean[i] = broken[i] == 0.0F ? 1.0F : 0.0F;
  }
}

// The same where the box is not whole: least squares over the taps on the centre's surface. Not enough of them: NaN.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void masked_slopes(const float* w, std::ptrdiff_t stride, int radius, float step, Slopes& out) {
  float n[kLanes] = {}, su[kLanes] = {}, sv[kLanes] = {}, suu[kLanes] = {}, suv[kLanes] = {}, svv[kLanes] = {};
  float sw[kLanes] = {}, suw[kLanes] = {}, svw[kLanes] = {};
  const int spacing = radius >= 4 ? 2 : 1;
  for (int dv = -radius; dv <= radius; dv += spacing)
    for (int du = -radius; du <= radius; du += spacing) {
      const float* tap = w + dv * stride + du;
      const float fu = static_cast<float>(du), fv = static_cast<float>(dv);
      for (int i = 0; i < kLanes; ++i) {
        const float difference = tap[i] - w[i];
        const float on = std::abs(difference) <= step * w[i] ? 1.0F : 0.0F;
        const float d = on * difference;
        n[i] += on;
        su[i] += on * fu;
        sv[i] += on * fv;
        suu[i] += on * (fu * fu);
        suv[i] += on * (fu * fv);
        svv[i] += on * (fv * fv);
        sw[i] += d;
        suw[i] += fu * d;
        svw[i] += fv * d;
      }
    }
  for (int i = 0; i < kLanes; ++i) {
    const float inverse_n = 1.0F / std::max(n[i], 1.0F);
    const float mu = su[i] * inverse_n, mv = sv[i] * inverse_n, mw = sw[i] * inverse_n;
    const float cuu = suu[i] - su[i] * mu, cuv = suv[i] - su[i] * mv, cvv = svv[i] - sv[i] * mv;
    const float cuw = suw[i] - su[i] * mw, cvw = svw[i] - sv[i] * mw;
    const float determinant = cuu * cvv - cuv * cuv;
    const bool solvable = (n[i] >= kMinReadings) & (determinant > 0.05F * (cuu + cvv) * (cuu + cvv) * 0.25F) & (w[i] > 0.0F);
    const float a = (cuw * cvv - cvw * cuv) / determinant, b = (cvw * cuu - cuw * cuv) / determinant;
    const bool clean = out.clean[i] != 0.0F;
    out.du[i] = clean ? out.du[i] : solvable ? a : kNaN;
    out.dv[i] = clean ? out.dv[i] : solvable ? b : kNaN;
    out.mean[i] = clean ? out.mean[i] : w[i] + mw - a * mu - b * mv;
  }
}

void clear_broken(Slopes& slopes) {
  for (int i = 0; i < kLanes; ++i)
    if (slopes.clean[i] == 0.0F) slopes.du[i] = kNaN;
}

// With undistorted rays, the slopes over the ray are f times those over the pixel.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void normals_of(const Slopes& slopes, const float* x, const float* y, const float* z, int count, float fx, float fy, float* nx, float* ny, float* nz) {
  for (int i = 0; i < count; ++i) {
    const float a = slopes.du[i] * fx, b = slopes.dv[i] * fy;
    const float c = slopes.mean[i] - (a * x[i] + b * y[i]) / z[i];
    const float scale = -1.0F / std::sqrt(a * a + b * b + c * c);
    nx[i] = a * scale;
    ny[i] = b * scale;
    nz[i] = c * scale;
  }
}

// With distorted rays, the slopes over the ray follow from the steps of the ray between neighbouring pixels.
void distorted_normal(const DepthPlanes& d, int u, int v, float du, float dv, float mean, float* n) {
  const auto at = [&](int column, int row) { return static_cast<std::size_t>(row) * static_cast<std::size_t>(d.width) + static_cast<std::size_t>(column); };
  const auto here = at(u, v);
  const auto step = [&](std::size_t there, float sign, float& sx, float& sy) {
    if (!(d.z[there] > 0)) return false;
    sx = sign * (d.x[there] / d.z[there] - d.x[here] / d.z[here]);
    sy = sign * (d.y[there] / d.z[there] - d.y[here] / d.z[here]);
    return true;
  };
  float xu = 0, yu = 0, xv = 0, yv = 0;
  const bool across = (u + 1 < d.width && step(at(u + 1, v), 1, xu, yu)) || (u > 0 && step(at(u - 1, v), -1, xu, yu));
  const bool down = (v + 1 < d.height && step(at(u, v + 1), 1, xv, yv)) || (v > 0 && step(at(u, v - 1), -1, xv, yv));
  const float determinant = xu * yv - yu * xv;
  n[0] = n[1] = n[2] = kNaN;
  if (!across || !down || !(std::abs(determinant) > 1e-12F)) return;
  const float a = (du * yv - dv * yu) / determinant, b = (dv * xu - du * xv) / determinant;
  const float c = mean - (a * d.x[here] + b * d.y[here]) / d.z[here];
  const float scale = -1.0F / std::sqrt(a * a + b * b + c * c);
  n[0] = a * scale;
  n[1] = b * scale;
  n[2] = c * scale;
}

Tile make_tile(const DepthPlanes& depth, const PixelRect& rect, int radius, float step) {
  const int pad = radius + 1;
  Tile tile(rect.width() + 2 * pad, rect.height() + 2 * pad);
  const int u0 = rect.u0 - pad, v0 = rect.v0 - pad;
  const int first = std::max(0, u0), last = std::min(depth.width, u0 + tile.width);
  for (int row = 0; row < tile.height; ++row) {
    const int v = v0 + row;
    if (v >= 0 && v < depth.height)
      invert_row(depth.z + static_cast<std::ptrdiff_t>(v) * depth.width + first, last - first, &tile.inverse[tile.at(row, first - u0)]);
  }
  for (int row = 0; row + 1 < tile.height; ++row)
    break_row(&tile.inverse[tile.at(row, 0)], &tile.inverse[tile.at(row + 1, 0)], tile.width, step, &tile.broken[tile.at(row, 0)]);
  for (int row = 0; row < tile.height; ++row)
    row_moments(&tile.inverse[tile.at(row, pad)], &tile.broken[tile.at(row, pad)], rect.width(), radius,
                &tile.row_sum[tile.at(row, pad)], &tile.row_moment[tile.at(row, pad)], &tile.row_broken[tile.at(row, pad)]);
  return tile;
}

}  // namespace

void box_normals(const DepthPlanes& depth, const BoxNormalsOptions& options, const PixelRect& wanted, float* nx, float* ny, float* nz) {
  const PixelRect rect{std::max(0, wanted.u0), std::max(0, wanted.v0), std::min(depth.width, wanted.u1), std::min(depth.height, wanted.v1)};
  if (rect.width() <= 0 || rect.height() <= 0) return;
  const int radius = std::clamp(options.radius_px, 1, kMaxBoxRadius), pad = radius + 1;
  const Tile tile = make_tile(depth, rect, radius, options.max_depth_step);
  for (int v = rect.v0; v < rect.v1; ++v)
    for (int u = rect.u0; u < rect.u1; u += kLanes) {
      const int count = std::min(kLanes, rect.u1 - u);
      const auto t = tile.at(v - rect.v0 + pad, u - rect.u0 + pad);
      const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.width) + static_cast<std::size_t>(u);
      Slopes slopes;
      clean_slopes(&tile.row_sum[t], &tile.row_moment[t], &tile.row_broken[t], tile.stride, radius, slopes);
      if (options.whole_boxes_only)
        clear_broken(slopes);
      else if (!std::all_of(slopes.clean, slopes.clean + count, [](float clean) { return clean != 0.0F; }))
        masked_slopes(&tile.inverse[t], tile.stride, radius, options.max_depth_step, slopes);
      if (depth.undistorted) {
        normals_of(slopes, depth.x + i, depth.y + i, depth.z + i, count, static_cast<float>(depth.fx), static_cast<float>(depth.fy), nx + i, ny + i, nz + i);
        continue;
      }
      for (int k = 0; k < count; ++k) {
        const auto pixel = i + static_cast<std::size_t>(k);
        float normal[3];
        distorted_normal(depth, u + k, v, slopes.du[k], slopes.dv[k], slopes.mean[k], normal);
        nx[pixel] = normal[0];
        ny[pixel] = normal[1];
        nz[pixel] = normal[2];
      }
    }
}

}  // namespace gfp
