#include "core/terrain/height_inverse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/grid/grid_view.h"

namespace terrane::core {
namespace {

constexpr double kFidelity = 2.25;

HeightMap Map(HeightMapping mapping, float soft_limit) {
  HeightMap map;
  map.mapping = mapping;
  map.inverse_soft_limit = soft_limit > 0 ? 1 / soft_limit : 0;
  map.z = static_cast<float>(1 / (std::sqrt(6.0) + 1e-3));
  map.deviation = static_cast<float>(std::sqrt(kFidelity));
  return map;
}

std::vector<HeightMap> Maps() {
  return {Map(HeightMapping::kLinear, 0), Map(HeightMapping::kLinear, 4),
          Map(HeightMapping::kBoltzmann, 0)};
}

double Mapped(const HeightMap& map, double fractal) {
  std::vector<float> row(1 + kRowSlack, static_cast<float>(fractal));
  MapRow(map, row.data(), nullptr, 0, nullptr, 1, row.data());
  return static_cast<double>(row[0]);
}

TEST(HeightInverseTest, TheMappingTakesItBack) {
  for (const HeightMap& map : Maps()) {
    for (const double deviation : {-3.7, -1.0, -0.01, 0.0, 0.3, 2.0, 3.9}) {
      const FractalValue p = FractalOfDeviation(map, kFidelity, deviation);
      EXPECT_NEAR(Mapped(map, p.value), deviation,
                  3e-6 * (1 + std::fabs(deviation)));
      // The slope is what a small step says.
      const double step = 1e-5;
      const double difference =
          FractalOfDeviation(map, kFidelity, deviation + step).value -
          FractalOfDeviation(map, kFidelity, deviation - step).value;
      EXPECT_NEAR(p.slope, difference / (2 * step), 1e-4);
    }
  }
}

TEST(HeightInverseTest, NothingLiesBeyondTheLargestDeviation) {
  for (const HeightMap& map : Maps()) {
    const double most = LargestDeviation(map, kFidelity);
    const double reached = Mapped(map, 1e6);
    if (std::isinf(most)) {
      EXPECT_GT(reached, 1e6);
    } else {
      EXPECT_NEAR(reached, most, 1e-4 * most);
    }
  }
}

}  // namespace
}  // namespace terrane::core
