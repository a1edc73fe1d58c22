#include "core/grid/height_codec.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace terrane::core {
namespace {

// Independent accumulators: a compiler may not reorder one chain of minima
// (NaN, signed zero), but it may run these side by side in vector registers.
constexpr std::size_t kLanes = 16;

// Heights a block: a lane's 32-bit counter cannot overflow in one.
constexpr std::size_t kBlock = std::size_t{1} << 20;

struct Lanes {
  std::array<float, kLanes> minimum;
  std::array<float, kLanes> maximum;
  std::array<std::int32_t, kLanes> nodata;
};

// `size` is a multiple of kLanes. NaN loses every comparison, so it only
// counts.
Lanes MeasureLanes(const float* heights, std::size_t size) {
  Lanes lanes;
  lanes.minimum.fill(std::numeric_limits<float>::infinity());
  lanes.maximum.fill(-std::numeric_limits<float>::infinity());
  lanes.nodata.fill(0);
  for (std::size_t i = 0; i < size; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float height = heights[i + k];
      lanes.minimum[k] = height < lanes.minimum[k] ? height : lanes.minimum[k];
      lanes.maximum[k] = height > lanes.maximum[k] ? height : lanes.maximum[k];
      lanes.nodata[k] += height != height ? 1 : 0;
    }
  }
  return lanes;
}

void Include(const Lanes& lanes, HeightStats* stats) {
  for (std::size_t k = 0; k < kLanes; ++k) {
    stats->minimum = std::min(stats->minimum, lanes.minimum[k]);
    stats->maximum = std::max(stats->maximum, lanes.maximum[k]);
    stats->nodata_samples += lanes.nodata[k];
  }
}

constexpr float kTop16 = 65535.0F;
constexpr std::size_t kEncodeBlock = 1024;

// The range in single precision: height - minimum is (height - high) + low
// without the rounding of `minimum` to float, so a value is within 0.01 of
// where double precision has it.
struct CodeScale {
  float high;
  float low;
  float scale;
};

// One block of EncodeUint16 in 32 bits: loops of one width vectorise.
std::int32_t Quantise(const float* heights, std::size_t size,
                      const CodeScale& code, std::int32_t* values) {
  std::int32_t clipped = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const float exact = ((heights[i] - code.high) + code.low) * code.scale;
    // NaN loses the comparison and becomes 0.
    const float above = exact > 0.0F ? exact : 0.0F;
    const float inside = above < kTop16 ? above : kTop16;
    values[i] = static_cast<std::int32_t>(inside + 0.5F);
    clipped += (exact < -0.5F ? 1 : 0) + (exact > kTop16 + 0.5F ? 1 : 0);
  }
  return clipped;
}

}  // namespace

HeightStats MeasureHeights(std::span<const float> heights) {
  HeightStats stats{std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity(), 0};
  const std::size_t whole = heights.size() / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kBlock) {
    Include(MeasureLanes(heights.data() + i, std::min(kBlock, whole - i)),
            &stats);
  }
  // The rest, padded with a height that changes nothing.
  if (whole < heights.size()) {
    std::array<float, kLanes> rest;
    rest.fill(heights[whole]);
    std::copy(heights.begin() + static_cast<std::ptrdiff_t>(whole),
              heights.end(), rest.begin());
    Lanes lanes = MeasureLanes(rest.data(), kLanes);
    std::fill(lanes.nodata.begin() +
                  static_cast<std::ptrdiff_t>(heights.size() - whole),
              lanes.nodata.end(), 0);
    Include(lanes, &stats);
  }
  if (stats.minimum > stats.maximum) {
    stats.minimum = stats.maximum = std::numeric_limits<float>::quiet_NaN();
  }
  return stats;
}

std::int64_t EncodeUint16(std::span<const float> heights, double minimum,
                          double maximum, std::span<std::uint16_t> values) {
  const float high = static_cast<float>(minimum);
  const CodeScale code{
      high, static_cast<float>(static_cast<double>(high) - minimum),
      static_cast<float>(static_cast<double>(kTop16) / (maximum - minimum))};
  std::int64_t clipped = 0;
  std::array<std::int32_t, kEncodeBlock> block;
  for (std::size_t at = 0; at < heights.size(); at += kEncodeBlock) {
    const std::size_t size = std::min(kEncodeBlock, heights.size() - at);
    clipped += Quantise(heights.data() + at, size, code, block.data());
    for (std::size_t i = 0; i < size; ++i) {
      values[at + i] = static_cast<std::uint16_t>(block[i]);
    }
  }
  return clipped;
}

float DecodeUint16(std::uint16_t value, double minimum, double maximum) {
  return static_cast<float>(minimum + static_cast<double>(value) *
                                          (maximum - minimum) / 65535.0);
}

}  // namespace terrane::core
