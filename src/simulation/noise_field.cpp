#include "simulation/noise_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gfp {
namespace {

constexpr int kSide = NoiseField::kSide;
constexpr int kMask = kSide - 1;
constexpr int kWindowColumns = 8, kWindowRows = 4;  // what correlates as a Kinect does
constexpr double kWhiteShare = 0.08;                // of the variance; disparity steps add the rest of what is white

/// Sum of four uniform numbers: near enough to normal, since windows are summed over it.
float nearly_normal(Random& random) {
  const std::uint64_t bits = random.next();
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += static_cast<double>((bits >> (16 * k)) & 0xFFFFU) / 65535.0 - 0.5;
  return static_cast<float>(sum * std::sqrt(3.0));
}

/// Mean over `window` neighbours along rows (stride 1) or columns (stride kSide), around the end.
std::vector<float> windowed(const std::vector<float>& in, int window, bool along_rows) {
  std::vector<float> out(in.size());
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u) {
      float sum = 0;
      for (int k = 0; k < window; ++k)
        sum += along_rows ? in[static_cast<std::size_t>(v * kSide + ((u + k) & kMask))] : in[static_cast<std::size_t>(((v + k) & kMask) * kSide + u)];
      out[static_cast<std::size_t>(v * kSide + u)] = sum;
    }
  return out;
}

std::vector<float> make_field() {
  Random random(20101104);
  std::vector<float> white(static_cast<std::size_t>(kSide) * kSide);
  for (float& value : white) value = nearly_normal(random);
  std::vector<float> field = windowed(windowed(white, kWindowColumns, true), kWindowRows, false);
  const auto smooth_weight = static_cast<float>(std::sqrt((1 - kWhiteShare) / (kWindowColumns * kWindowRows)));
  const auto white_weight = static_cast<float>(std::sqrt(kWhiteShare));
  for (float& value : field) value = smooth_weight * value + white_weight * nearly_normal(random);
  return field;
}

const std::vector<float>& field() {
  static const std::vector<float> made = make_field();
  return made;
}

}  // namespace

NoiseField::NoiseField(Random& random) : u0_(random.below(kSide)), v0_(random.below(kSide)) {}

void NoiseField::copy_row(int v, int count, float* out) const {
  const float* row = field().data() + static_cast<std::size_t>((v + v0_) & kMask) * kSide;
  for (int done = 0; done < count;) {
    const int from = (u0_ + done) & kMask, run = std::min(count - done, kSide - from);
    std::memcpy(out + done, row + from, static_cast<std::size_t>(run) * sizeof(float));
    done += run;
  }
}

float NoiseField::at(int u, int v) const {
  return field()[static_cast<std::size_t>((v + v0_) & kMask) * kSide + static_cast<std::size_t>((u + u0_) & kMask)];
}

}  // namespace gfp
