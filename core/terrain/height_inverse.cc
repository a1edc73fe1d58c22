#include "core/terrain/height_inverse.h"

#include <cmath>
#include <limits>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

// The mapping cuts |P| here.
constexpr double kLargestFractal = 2.44948974278317810;

}  // namespace

double LargestDeviation(const HeightMap& map, double fidelity) {
  if (map.mapping == HeightMapping::kBoltzmann) {
    const double z = static_cast<double>(map.z);
    return std::sqrt(-2 * fidelity * DetLog(1 - z * kLargestFractal));
  }
  return map.inverse_soft_limit > 0
             ? 1 / static_cast<double>(map.inverse_soft_limit)
             : std::numeric_limits<double>::infinity();
}

FractalValue FractalOfDeviation(const HeightMap& map, double fidelity,
                                double deviation) {
  if (map.mapping == HeightMapping::kBoltzmann) {
    const double z = static_cast<double>(map.z);
    const double fall = DetExp(-deviation * deviation / (2 * fidelity));
    const double size = (1 - fall) / z;
    return {deviation < 0 ? -size : size,
            std::fabs(deviation) / fidelity * fall / z};
  }
  const double root = std::sqrt(fidelity);
  const double share = deviation * static_cast<double>(map.inverse_soft_limit);
  const double rest = 1 - share * share;  // 1 without a soft limit
  return {deviation / std::sqrt(rest) / root,
          1 / (rest * std::sqrt(rest) * root)};
}

}  // namespace terrane::core
