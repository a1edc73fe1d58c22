#include "core/terrain/terrain_bounds.h"

#include <algorithm>
#include <cmath>

#include "core/base/det_math.h"
#include "core/terrain/displacement.h"

namespace terrane::core {
namespace {

constexpr double kSqrt6 = 2.449489742783178;

// Deviations beyond this many standard deviations are rarer than one in 10^8.
constexpr double kLikelyDeviations = 6;

}  // namespace

std::optional<double> LargestDeviationOf(const TerrainSpec& spec,
                                         const ConstraintField& fidelity) {
  if (spec.mapping == HeightMapping::kBoltzmann) {
    const double delta = *spec.delta;
    return std::sqrt(-2 * static_cast<double>(fidelity.maximum()) *
                     DetLog(delta / (kSqrt6 + delta)));
  }
  return spec.soft_limit;
}

HeightRange LikelyHeights(const ResolvedSpec& resolved, const MacroShape& macro,
                          const ConstraintField& fidelity,
                          double largest_spot_deviation) {
  const TerrainSpec& spec = resolved.spec;
  // The variance of P is at most the sum of the displacements' along a chain of
  // ancestors: the stencils average.
  double variance = Level0Deviation(spec.source) * Level0Deviation(spec.source);
  const ConstraintField roughness(spec.continuous_constraints,
                                  ConstraintQuantity::kRoughness,
                                  *spec.roughness, spec.dimensions);
  const auto h = static_cast<double>(roughness.minimum());
  for (int level = 1; level <= kMaxLevel; ++level) {
    for (const HalfStep step : {HalfStep::kCentre, HalfStep::kEdge}) {
      const double d =
          DisplacementDeviation(spec.source, spec.dimensions, h, level, step);
      variance += d * d;
    }
  }
  const double amplitude =
      resolved.amplitude.empty()
          ? 1.0
          : static_cast<double>(*std::max_element(resolved.amplitude.begin(),
                                                  resolved.amplitude.end()));
  const double likely =
      kLikelyDeviations * amplitude *
      std::sqrt(static_cast<double>(fidelity.maximum()) * variance);
  // Around a spot the ground is pulled as far as the spot, and a little beyond.
  const double pulled = likely + 2 * largest_spot_deviation;
  const double deviation =
      std::min(pulled, LargestDeviationOf(spec, fidelity).value_or(pulled));

  constexpr double kEverywhereInPlane = 1e300;
  MacroShape::Bounds bounds =
      macro.BoundsIn(-kEverywhereInPlane, -kEverywhereInPlane,
                     kEverywhereInPlane, kEverywhereInPlane);
  if (spec.domain) {
    const Frame& frame = *spec.frame;
    const double x1 =
        frame.origin_x +
        static_cast<double>(spec.domain->cells_x) * frame.spacing_x;
    const double y1 =
        frame.origin_y +
        static_cast<double>(spec.domain->cells_y) * frame.spacing_y;
    bounds = macro.BoundsIn(
        std::min(frame.origin_x, x1), std::min(frame.origin_y, y1),
        std::max(frame.origin_x, x1), std::max(frame.origin_y, y1));
  }
  return {static_cast<float>(bounds.minimum - deviation),
          static_cast<float>(bounds.maximum + deviation)};
}

}  // namespace terrane::core
