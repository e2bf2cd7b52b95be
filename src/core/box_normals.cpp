#include "gfp/core/box_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

// Eight pixels in one register (two of SSE2's): sums over a box stay in registers from the first tap to the last.
constexpr int kGroup = 8;
typedef float Group __attribute__((vector_size(4 * kGroup), aligned(4), may_alias));
typedef std::int32_t GroupMask __attribute__((vector_size(4 * kGroup), aligned(4), may_alias));

struct Slopes {
  float du[kLanes], dv[kLanes], mean[kLanes], clean[kLanes];  // of 1/z per pixel; 1/z at the centre; whether the box is whole
};

__attribute__((target_clones("arch=x86-64-v3", "default")))
void clean_slopes(const float* sum, const float* moment, const float* breaks, std::ptrdiff_t stride, int radius, Slopes& out) {
  const float side = static_cast<float>(2 * radius + 1);
  const float second = side * static_cast<float>(radius * (radius + 1) * (2 * radius + 1)) / 3.0F;  // sum of offset^2 over the box
  const float per_second = 1.0F / second, per_pixel = 1.0F / (side * side);
  for (int g = 0; g < kLanes; g += kGroup) {
    const auto at = [g](const float* plane) __attribute__((always_inline)) -> const Group* { return reinterpret_cast<const Group*>(plane + g); };
    Group total = *at(sum), mu = *at(moment), mv = {}, broken = *at(breaks);
    for (int k = 1; k <= radius; ++k) {
      const std::ptrdiff_t down = k * stride;
      const Group below = *at(sum + down), above = *at(sum - down);
      total += below + above;
      mu += *at(moment + down) + *at(moment - down);
      mv += static_cast<float>(k) * (below - above);
      broken += *at(breaks + down) + *at(breaks - down);
    }
    *reinterpret_cast<Group*>(out.du + g) = mu * per_second;
    *reinterpret_cast<Group*>(out.dv + g) = mv * per_second;
    *reinterpret_cast<Group*>(out.mean + g) = total * per_pixel;
    for (int i = 0; i < kGroup; ++i) out.clean[g + i] = broken[i] == 0.0F ? 1.0F : 0.0F;
  }
}

// What the taps on the centre's surface sum up to, for one group of pixels.
struct MaskedSums {
  float n[kGroup], su[kGroup], sv[kGroup], suu[kGroup], suv[kGroup], svv[kGroup], sw[kGroup], suw[kGroup], svw[kGroup];
};

__attribute__((target_clones("arch=x86-64-v3", "default")))
void sum_taps(const float* w, std::ptrdiff_t stride, int radius, float step, MaskedSums& out) {
  const Group centre = *reinterpret_cast<const Group*>(w), limit = step * centre;
  Group n = {}, su = {}, sv = {}, suu = {}, suv = {}, svv = {}, sw = {}, suw = {}, svw = {};
  const int spacing = radius >= 4 ? 2 : 1;
  for (int dv = -radius; dv <= radius; dv += spacing) {
    Group row_n = {}, row_u = {}, row_uu = {}, row_w = {}, row_uw = {};
    const float* row = w + dv * stride;
    for (int du = -radius; du <= radius; du += spacing) {
      const float fu = static_cast<float>(du);
      const Group difference = *reinterpret_cast<const Group*>(row + du) - centre;
      const GroupMask mask = (difference <= limit) & (difference >= -limit);
      const Group on = -__builtin_convertvector(mask, Group), d = (Group)((GroupMask)difference & mask);
      row_n += on;
      row_u += fu * on;
      row_uu += fu * fu * on;
      row_w += d;
      row_uw += fu * d;
    }
    const float fv = static_cast<float>(dv);
    n += row_n;
    su += row_u;
    suu += row_uu;
    sw += row_w;
    suw += row_uw;
    sv += fv * row_n;
    suv += fv * row_u;
    svv += fv * fv * row_n;
    svw += fv * row_w;
  }
  const auto put = [](const Group& from, float* to) __attribute__((always_inline)) { *reinterpret_cast<Group*>(to) = from; };
  put(n, out.n), put(su, out.su), put(sv, out.sv), put(suu, out.suu), put(suv, out.suv), put(svv, out.svv), put(sw, out.sw), put(suw, out.suw), put(svw, out.svw);
}

// The same where the box is not whole: least squares over the taps on the centre's surface. Not enough of them: NaN.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void solve_masked(const float* w, const MaskedSums& s, float* __restrict du, float* __restrict dv, float* __restrict mean, const float* clean_flags) {
  for (int i = 0; i < kGroup; ++i) {
    const float inverse_n = 1.0F / std::max(s.n[i], 1.0F);
    const float mu = s.su[i] * inverse_n, mv = s.sv[i] * inverse_n, mw = s.sw[i] * inverse_n;
    const float cuu = s.suu[i] - s.su[i] * mu, cuv = s.suv[i] - s.su[i] * mv, cvv = s.svv[i] - s.sv[i] * mv;
    const float cuw = s.suw[i] - s.su[i] * mw, cvw = s.svw[i] - s.sv[i] * mw;
    const float determinant = cuu * cvv - cuv * cuv;
    const bool solvable = (s.n[i] >= kMinReadings) & (determinant > 0.05F * (cuu + cvv) * (cuu + cvv) * 0.25F) & (w[i] > 0.0F);
    const float a = (cuw * cvv - cvw * cuv) / determinant, b = (cvw * cuu - cuw * cuv) / determinant;
    const bool clean = clean_flags[i] != 0.0F;
    du[i] = clean ? du[i] : solvable ? a : kNaN;
    dv[i] = clean ? dv[i] : solvable ? b : kNaN;
    mean[i] = clean ? mean[i] : w[i] + mw - a * mu - b * mv;
  }
}

// Only for the groups in which some box is not whole.
void masked_slopes(const float* w, std::ptrdiff_t stride, int radius, float step, int count, Slopes& out) {
  for (int g = 0; g < count; g += kGroup) {
    if (std::all_of(out.clean + g, out.clean + std::min(g + kGroup, count), [](float clean) { return clean != 0.0F; })) continue;
    MaskedSums sums;
    sum_taps(w + g, stride, radius, step, sums);
    solve_masked(w + g, sums, out.du + g, out.dv + g, out.mean + g, out.clean + g);
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
      else
        masked_slopes(&tile.inverse[t], tile.stride, radius, options.max_depth_step, count, slopes);
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
