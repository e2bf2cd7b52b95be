#include "gfp/core/box_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace gfp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kMinReadings = 6;
constexpr float kMaxInverse = 16;  // 1/m

// Eight pixels in one register (two of SSE2's).
constexpr int kGroup = 8;
typedef std::int32_t Ints __attribute__((vector_size(4 * kGroup), aligned(4), may_alias));
typedef float Floats __attribute__((vector_size(4 * kGroup), aligned(4), may_alias));

// The loops below read and write whole groups: rows are this much longer than what they hold.
constexpr int kSpare = 4 * kGroup;

// 1/z in steps of `per_step` metres^-1; 0 where there is no reading.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void invert_row(const float* z, int count, float steps_per_m, std::int32_t* __restrict inverse) {
  constexpr float kNearest = 1.0F / kMaxInverse;
  for (int i = 0; i < count; ++i) inverse[i] = z[i] >= kNearest ? static_cast<std::int32_t>(steps_per_m / z[i] + 0.5F) : 0;
}

// A pixel is broken where it has no reading or where its right or lower neighbour is on another surface (or has none).
__attribute__((target_clones("arch=x86-64-v3", "default")))
void break_row(const std::int32_t* w, const std::int32_t* below, int count, float step, std::uint8_t* __restrict broken) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t right = std::abs(w[i + 1] - w[i]), down = std::abs(below[i] - w[i]);
    const auto limit = static_cast<std::int32_t>(step * static_cast<float>(w[i]));
    broken[i] = static_cast<std::uint8_t>((w[i] <= 0) | (right > limit) | (down > limit));
  }
}

// to[i] |= from[i], for rows that are moved against each other.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void mark_row(const std::uint8_t* from, int count, std::uint8_t* __restrict to) {
  for (int i = 0; i < count; ++i) to[i] |= from[i];
}

// Sums over the 2r + 1 pixels around each pixel of a row: of w and of offset * w.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void row_moments(const std::int32_t* w, int count, int radius, std::int32_t* __restrict sum, std::int32_t* __restrict moment) {
  for (int i = 0; i < count; i += kGroup) {
    const auto at = [&](int offset) __attribute__((always_inline)) -> const Ints* { return reinterpret_cast<const Ints*>(w + i + offset); };
    Ints total = *at(0), further = {}, weighted = {};
    for (int k = radius; k >= 1; --k) {  // offset k is counted in k of the partial sums
      const Ints right = *at(k), left = *at(-k);
      total += right + left;
      further += right - left;
      weighted += further;
    }
    *reinterpret_cast<Ints*>(sum + i) = total;
    *reinterpret_cast<Ints*>(moment + i) = weighted;
  }
}

// Per column, sums over the box around the row that is looked at: of w, of its column offset and of its row offset times w.
struct Sums {
  std::int32_t *total, *across, *down;
};

// A row's sums over the box's columns.
struct RowSums {
  const std::int32_t *total, *across;
};

// One row further down: `in` joins the box, `out` leaves it. Every row's offset shrinks by one, which takes the total from `down`.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void slide(Sums sums, RowSums in, RowSums out, int count, int radius) {
  for (int i = 0; i < count; i += kGroup) {
    const auto at = [i](const std::int32_t* row) __attribute__((always_inline)) -> const Ints* { return reinterpret_cast<const Ints*>(row + i); };
    const auto to = [i](std::int32_t* row) __attribute__((always_inline)) -> Ints* { return reinterpret_cast<Ints*>(row + i); };
    const Ints joins = *at(in.total), leaves = *at(out.total), before = *at(sums.total);
    *to(sums.down) += radius * (joins + leaves) + leaves - before;
    *to(sums.total) = before + joins - leaves;
    *to(sums.across) += *at(in.across) - *at(out.across);
  }
}

// Of 1/z (in steps): its slopes per pixel and its value at the centre.
struct Slopes {
  float *du, *dv, *mean;
};

__attribute__((target_clones("arch=x86-64-v3", "default")))
void whole_slopes(const Sums& sums, int count, float per_second, float per_pixel, const Slopes& out) {
  const std::int32_t *total = sums.total, *across = sums.across, *down = sums.down;
  float *__restrict du = out.du, *__restrict dv = out.dv, *__restrict mean = out.mean;
  for (int i = 0; i < count; ++i) {
    du[i] = static_cast<float>(across[i]) * per_second;
    dv[i] = static_cast<float>(down[i]) * per_second;
    mean[i] = static_cast<float>(total[i]) * per_pixel;
  }
}

constexpr int kTaps = 2;  // to each side

// The five rows of taps around a row, and the columns between two taps.
struct TapRows {
  const std::int32_t* row[2 * kTaps + 1];
  int spacing;
};

// Where the box is not whole: least squares over the taps on the centre's surface. Not enough of them: NaN.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void broken_slopes(const TapRows& taps, const std::uint8_t* broken, int count, float step, const Slopes& out) {
  for (int i = 0; i < count; i += kGroup) {
    std::uint64_t any;
    std::memcpy(&any, broken + i, sizeof any);
    if (any == 0) continue;
    const Ints centre = *reinterpret_cast<const Ints*>(taps.row[kTaps] + i);
    const Ints limit = __builtin_convertvector(step * __builtin_convertvector(centre, Floats), Ints);
    Ints n = {}, u = {}, v = {}, uu = {}, uv = {}, vv = {}, w = {}, uw = {}, vw = {};  // n to vv of masks: negative counts
#pragma GCC unroll 5
    for (int row = -kTaps; row <= kTaps; ++row) {
      Ints mask[2 * kTaps + 1], difference[2 * kTaps + 1];
#pragma GCC unroll 5
      for (int tap = 0; tap <= 2 * kTaps; ++tap) {
        const Ints d = *reinterpret_cast<const Ints*>(taps.row[row + kTaps] + i + (tap - kTaps) * taps.spacing) - centre;
        mask[tap] = (d <= limit) & (d >= -limit);
        difference[tap] = d & mask[tap];
      }
      const Ints outer = mask[0] + mask[4], inner = mask[1] + mask[3];
      const Ints row_n = outer + inner + mask[2], row_u = 2 * (mask[4] - mask[0]) + mask[3] - mask[1];
      const Ints row_w = difference[0] + difference[1] + difference[2] + difference[3] + difference[4];
      n += row_n;
      u += row_u;
      uu += 4 * outer + inner;
      w += row_w;
      uw += 2 * (difference[4] - difference[0]) + difference[3] - difference[1];
      v += row * row_n;
      uv += row * row_u;
      vv += row * row * row_n;
      vw += row * row_w;
    }
#define GFP_REAL(sum) __builtin_convertvector(sum, Floats)
    const Floats readings = -GFP_REAL(n), per_reading = 1.0F / readings;
    const Floats su = -GFP_REAL(u), sv = -GFP_REAL(v), mu = su * per_reading, mv = sv * per_reading, mw = GFP_REAL(w) * per_reading;
    const Floats cuu = -GFP_REAL(uu) - su * mu, cuv = -GFP_REAL(uv) - su * mv, cvv = -GFP_REAL(vv) - sv * mv;
    const Floats cuw = GFP_REAL(uw) - su * mw, cvw = GFP_REAL(vw) - sv * mw;
    const Floats determinant = cuu * cvv - cuv * cuv, per_determinant = 1.0F / determinant, trace = cuu + cvv;
    const Floats a = (cuw * cvv - cvw * cuv) * per_determinant, b = (cvw * cuu - cuw * cuv) * per_determinant;
    const Floats mean = GFP_REAL(centre) + mw - a * mu - b * mv;
#undef GFP_REAL
    const Ints solvable = (readings >= kMinReadings) & (determinant > 0.0125F * trace * trace) & (centre > 0);
    const float per_spacing = 1.0F / static_cast<float>(taps.spacing);
    for (int k = 0; k < kGroup; ++k) {
      if (broken[i + k] == 0) continue;
      out.du[i + k] = solvable[k] != 0 ? a[k] * per_spacing : kNaN;
      out.dv[i + k] = b[k] * per_spacing;
      out.mean[i + k] = mean[k];
    }
  }
}

void clear_broken(const std::uint8_t* broken, int count, const Slopes& slopes) {
  for (int i = 0; i < count; ++i)
    if (broken[i] != 0) slopes.du[i] = kNaN;
}

// With undistorted rays, the slopes over the ray are f times those over the pixel.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void normals_of(const Slopes& slopes, int count, float fx, float fy, float right_of_centre, float below_centre, float* __restrict nx, float* __restrict ny,
                float* __restrict nz) {
  const float *du = slopes.du, *dv = slopes.dv, *mean = slopes.mean;
  for (int i = 0; i < count; ++i) {
    const float a = du[i] * fx, b = dv[i] * fy;
    const float c = mean[i] - (du[i] * (right_of_centre + static_cast<float>(i)) + dv[i] * below_centre);
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

// The rows of a rectangle, from the top one, with what is around them: rings that hold as many rows as a box is high, and one more.
class Window {
 public:
  Window(const DepthPlanes& depth, const BoxNormalsOptions& options, const PixelRect& rect)
      : depth_(depth), rect_(rect), radius_(std::clamp(options.radius_px, kMinBoxRadius, kMaxBoxRadius)), step_(options.max_depth_step) {
    // Sums of |offset| w over a box stay below 2^31.
    const float weight = static_cast<float>((2 * radius_ + 1) * radius_ * (radius_ + 1)) * kMaxInverse;
    steps_per_m_ = std::exp2(std::floor(std::log2(2147483648.0F / weight)));
    pad_ = radius_ + 1;
    stride_ = rect.width() + 2 * pad_ + kSpare;
    const auto ring = static_cast<std::size_t>(rows()) * static_cast<std::size_t>(stride_);
    for (auto* plane : {&inverse_, &sum_, &moment_}) plane->assign(ring, 0);
    marked_.assign(ring, 1);
    broken_.assign(static_cast<std::size_t>(stride_), 1);
    for (auto* row : {&total_, &across_, &down_}) row->assign(static_cast<std::size_t>(stride_), 0);
    for (auto* row : {&du_, &dv_, &mean_}) row->assign(static_cast<std::size_t>(stride_), 0.0F);
    for (int v = rect.v0 - pad_; v < rect.v0 + radius_; ++v) take(v);
  }

  Slopes slopes() { return {du_.data(), dv_.data(), mean_.data()}; }

  /// Slopes of row v; v goes up by one from call to call, from the rectangle's first.
  void look_at(int v, bool whole_boxes_only) {
    take(v + radius_);
    const int width = rect_.width(), side = 2 * radius_ + 1;
    const float second = static_cast<float>(side * radius_ * (radius_ + 1) * side) / 3.0F;  // sum of offset^2 over the box
    whole_slopes(sums(), width, 1.0F / second, 1.0F / static_cast<float>(side * side), slopes());
    std::fill(broken_.begin(), broken_.end(), std::uint8_t{0});
    for (int row = v - radius_; row <= v + radius_; ++row) mark_row(&marked_[at(row)], width, broken_.data());
    if (whole_boxes_only) return clear_broken(broken_.data(), width, slopes());
    TapRows taps{{}, radius_ / kTaps};
    for (int k = -kTaps; k <= kTaps; ++k) taps.row[k + kTaps] = &inverse_[at(v + k * taps.spacing)] + pad_;
    broken_slopes(taps, broken_.data(), width, step_, slopes());
  }

 private:
  int rows() const { return 2 * radius_ + 3; }
  Sums sums() { return {total_.data(), across_.data(), down_.data()}; }
  std::size_t at(int v) const { return static_cast<std::size_t>((v - rect_.v0 + 2 * rows()) % rows()) * static_cast<std::size_t>(stride_); }

  void invert(int v) {
    std::int32_t* const row = &inverse_[at(v)];
    std::fill(row, row + stride_, 0);
    if (v < 0 || v >= depth_.height) return;
    const int first = std::max(0, rect_.u0 - pad_), last = std::min(depth_.width, rect_.u1 + pad_);
    invert_row(depth_.z + static_cast<std::ptrdiff_t>(v) * depth_.width + first, last - first, steps_per_m_, row + first - (rect_.u0 - pad_));
  }

  /// Row v comes into the sums, row v - 2r - 1 leaves them; row v + 1 is read, since a step down to it breaks row v.
  void take(int v) {
    invert(v + 1);
    if (v == rect_.v0 - pad_) return;
    const int width = rect_.width();
    const std::size_t in = at(v), out = at(v - 2 * radius_ - 1);
    row_moments(&inverse_[in] + pad_, width, radius_, &sum_[in], &moment_[in]);
    slide(sums(), {&sum_[in], &moment_[in]}, {&sum_[out], &moment_[out]}, width, radius_);
    break_row(&inverse_[in], &inverse_[at(v + 1)], stride_ - kSpare, step_, broken_.data());
    std::uint8_t* const marked = &marked_[in];
    std::fill(marked, marked + stride_, std::uint8_t{0});
    for (int k = 0; k <= 2 * radius_; ++k) mark_row(broken_.data() + 1 + k, width, marked);
  }

  const DepthPlanes& depth_;
  PixelRect rect_;
  int radius_, pad_, stride_;
  float step_, steps_per_m_;
  std::vector<std::int32_t> inverse_, sum_, moment_;  ///< Rings: 1/z from pad_ left of the rectangle on; moments from its left edge on.
  std::vector<std::uint8_t> marked_;                  ///< Ring: whether a pixel of the row within the radius is broken.
  std::vector<std::uint8_t> broken_;
  std::vector<std::int32_t> total_, across_, down_;
  std::vector<float> du_, dv_, mean_;
};

}  // namespace

void box_normals(const DepthPlanes& depth, const BoxNormalsOptions& options, const PixelRect& wanted, float* nx, float* ny, float* nz) {
  const PixelRect rect{std::max(0, wanted.u0), std::max(0, wanted.v0), std::min(depth.width, wanted.u1), std::min(depth.height, wanted.v1)};
  if (rect.width() <= 0 || rect.height() <= 0) return;
  Window window(depth, options, rect);
  const Slopes slopes = window.slopes();
  for (int v = rect.v0; v < rect.v1; ++v) {
    window.look_at(v, options.whole_boxes_only);
    const auto i = static_cast<std::ptrdiff_t>(v) * depth.width + rect.u0;
    if (depth.undistorted) {
      normals_of(slopes, rect.width(), static_cast<float>(depth.fx), static_cast<float>(depth.fy), static_cast<float>(rect.u0 - depth.cx),
                 static_cast<float>(v - depth.cy), nx + i, ny + i, nz + i);
      continue;
    }
    for (int k = 0; k < rect.width(); ++k) {
      float normal[3];
      distorted_normal(depth, rect.u0 + k, v, slopes.du[k], slopes.dv[k], slopes.mean[k], normal);
      nx[i + k] = normal[0];
      ny[i + k] = normal[1];
      nz[i + k] = normal[2];
    }
  }
}

}  // namespace gfp
