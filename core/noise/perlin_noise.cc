#include "core/noise/perlin_noise.h"

#include <cstddef>
#include <utility>

#include "core/base/det_math.h"
#include "core/noise/counter_hash.h"

namespace terrane::core {
namespace {

constexpr std::uint32_t kPermutationStream = 0x50455251;
constexpr std::uint32_t kGradientStream = 0x50455247;
constexpr double kTurn = 6.283185307179586;

}  // namespace

PerlinNoise::PerlinNoise(std::int64_t seed) {
  const RowKey shuffle = MakeRowKey(StreamKey(seed, kPermutationStream), 0);
  const RowKey turn = MakeRowKey(StreamKey(seed, kGradientStream), 0);
  for (std::uint32_t i = 0; i < 256; ++i) {
    permutation_[i] = static_cast<std::uint8_t>(i);
    const double angle = kTurn * 0x1p-32 * HashLane(ColumnWord(i), turn);
    gradients_[i] = {static_cast<float>(DetCos(angle)),
                     static_cast<float>(DetSin(angle))};
  }
  for (std::uint32_t last = 255; last > 0; --last) {
    const std::uint64_t word = HashLane(ColumnWord(last), shuffle);
    const auto other = static_cast<std::size_t>((word * (last + 1)) >> 32);
    std::swap(permutation_[last], permutation_[other]);
  }
}

LatticeColumn PerlinNoise::ColumnAt(int i, int j, float y_rest) const {
  const Float2 below = GradientAt(i, j);
  const Float2 above = GradientAt(i, j + 1);
  const float back = y_rest - 1.0f;
  const float fade = NoiseFade(y_rest);
  const float fade_slope = NoiseFadeSlope(y_rest);
  const float rise = above.y * back - below.y * y_rest;
  return {below.x + fade * (above.x - below.x), below.y * y_rest + fade * rise,
          fade_slope * (above.x - below.x),
          (below.y + fade * (above.y - below.y)) + fade_slope * rise};
}

NoiseSample PerlinNoise::At(float x, float y) const {
  const float left = std::floor(x);
  const float bottom = std::floor(y);
  const int i = static_cast<int>(left);
  const int j = static_cast<int>(bottom);
  return NoiseBetween(ColumnAt(i, j, y - bottom),
                      ColumnAt(i + 1, j, y - bottom), x - left);
}

}  // namespace terrane::core
