#include "wire/quantise.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

// Loops over blocks of a fixed length, which the compiler makes into several numbers at a time.

namespace gfp::wire {
namespace {

constexpr std::size_t kLanes = 24;   ///< A multiple of every vector's length,
constexpr std::size_t kBlock = 384;  ///< and of three.

/// Truncation of what was made positive is rounding down: no library call, and the same bits on every machine.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void quantise_block(const double* values, const double* origins, double per_unit, std::size_t count, std::int16_t* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const double units = (values[i] - origins[i]) * per_unit;
    const double above = units > -32767.0 ? units : -32767.0;
    out[i] = static_cast<std::int16_t>(static_cast<std::int32_t>((above < 32767.0 ? above : 32767.0) + 32768.5) - 32768);
  }
}

__attribute__((target_clones("arch=x86-64-v3", "default"))) void quantise_block(const float* values, float per_unit, std::size_t count, std::uint16_t* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const float units = values[i] * per_unit;
    const float above = units > 0.0F ? units : 0.0F;
    out[i] = static_cast<std::uint16_t>(static_cast<std::int32_t>((above < 65535.0F ? above : 65535.0F) + 0.5F));
  }
}

__attribute__((target_clones("arch=x86-64-v3", "default"))) void raise_to(const float* values, std::size_t blocks, float* largest) {
  for (std::size_t block = 0; block < blocks; ++block, values += kLanes)
    for (std::size_t i = 0; i < kLanes; ++i) largest[i] = values[i] > largest[i] ? values[i] : largest[i];
}

/// Block by block, in memory of the numbers' own type.
template <class Out, class In, class Quantise>
void put_blocks(std::span<const In> values, std::string& bytes, Quantise&& quantise) {
  bytes.resize(values.size() * sizeof(Out));
  std::array<Out, kBlock> block;
  for (std::size_t done = 0; done < values.size(); done += kBlock) {
    const std::size_t count = std::min(kBlock, values.size() - done);
    quantise(values.data() + done, count, block.data());
    std::memcpy(bytes.data() + done * sizeof(Out), block.data(), count * sizeof(Out));
  }
}

}  // namespace

void quantise_points(std::span<const double> xyz, const double origin[3], double scale, std::string& bytes) {
  std::array<double, kBlock> origins;
  for (std::size_t i = 0; i < kBlock; ++i) origins[i] = origin[i % 3];
  put_blocks<std::int16_t>(xyz, bytes, [&](const double* values, std::size_t count, std::int16_t* out) { quantise_block(values, origins.data(), 1.0 / scale, count, out); });
}

void quantise_lengths(std::span<const float> values, double scale, std::string& bytes) {
  put_blocks<std::uint16_t>(values, bytes, [&](const float* block, std::size_t count, std::uint16_t* out) { quantise_block(block, static_cast<float>(1.0 / scale), count, out); });
}

float largest_of(std::span<const float> values) {
  std::array<float, kLanes> largest{};
  const std::size_t blocks = values.size() / kLanes;
  raise_to(values.data(), blocks, largest.data());
  for (std::size_t i = blocks * kLanes; i < values.size(); ++i) largest[0] = std::max(largest[0], values[i]);
  return *std::max_element(largest.begin(), largest.end());
}

}  // namespace gfp::wire
