#include "core/raytrace/tone.h"

#include <cmath>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

constexpr double kShoulder = 0.8;

double Bent(double x) {
  if (x <= kShoulder) return x;
  const double y = (x - kShoulder) / (1 - kShoulder);
  return kShoulder + (1 - kShoulder) * (1 - 1 / (1 + y));
}

// IEC 61966-2-1.
double SrgbOf(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear
                             : 1.055 * DetPow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

void ToSrgb8(std::span<const float> linear, float exposure,
             std::span<std::uint8_t> bytes) {
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double value = Bent(static_cast<double>(exposure * linear[i]));
    bytes[i] = static_cast<std::uint8_t>(std::nearbyint(255 * SrgbOf(value)));
  }
}

}  // namespace terrane::core
