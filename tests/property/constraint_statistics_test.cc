// What the controls do to the heights: fidelity, roughness by region, discrete
// constraints with their buffering, and the bounds of both mappings. "How a
// result is judged" of docs/terrain.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/noise/counter_hash.h"
#include "core/noise/normal.h"
#include "core/terrain/displacement.h"
#include "tests/property/terrain_patch.h"

namespace terrane::core {
namespace {

constexpr int kLevel = 8;
constexpr Window kWindow = {-256, -256, 512, 512};  // [-1, 1)^2 in the world

TerrainSpec HillySpec(FractalSource source, HeightMapping mapping) {
  TerrainSpec spec;
  spec.seed = 42;
  spec.source = source;
  spec.mapping = mapping;
  spec.macro.base = 100;
  spec.macro.parts.push_back(
      {MacroCombine::kAdd, GaussianHill{{0.2, -0.1}, 0.5, 0.3, 40}});
  return spec;
}

ContinuousConstraint SquareRegion(ConstraintQuantity quantity, double target,
                                  double half_side, double reach) {
  ContinuousConstraint region;
  region.quantity = quantity;
  region.target = target;
  region.reach = reach;
  region.kind = SourceKind::kPolygon;
  region.vertices = {{-half_side, -half_side},
                     {half_side, -half_side},
                     {half_side, half_side},
                     {-half_side, half_side}};
  return region;
}

double MeanDeviation(const Patch& heights, const Patch& macro) {
  double sum = 0;
  for (std::size_t k = 0; k < heights.values.size(); ++k) {
    sum += std::fabs(static_cast<double>(heights.values[k]) -
                     static_cast<double>(macro.values[k]));
  }
  return sum / static_cast<double>(heights.values.size());
}

double MeanDeviation(const TerrainSpec& spec, const Window& window = kWindow) {
  const auto terrain = MakeTerrain(spec);
  return MeanDeviation(HeightPatch(*terrain, kLevel, window),
                       MacroPatch(*terrain, kLevel, window));
}

// --- Fidelity ---------------------------------------------------------------

struct Chain {
  FractalSource source;
  HeightMapping mapping;
};
class BothMappings : public testing::TestWithParam<Chain> {
 protected:
  TerrainSpec Spec() const {
    return HillySpec(GetParam().source, GetParam().mapping);
  }
};

TEST_P(BothMappings, AtZeroFidelityGiveTheMacroShape) {
  TerrainSpec spec = Spec();
  spec.fidelity = 0;
  const auto terrain = MakeTerrain(spec);
  EXPECT_EQ(HeightPatch(*terrain, kLevel, kWindow).values,
            MacroPatch(*terrain, kLevel, kWindow).values);
}

TEST_P(BothMappings, DeviateAsTheRootOfFidelity) {
  TerrainSpec spec = Spec();
  spec.fidelity = 1;
  const double one = MeanDeviation(spec);
  for (const double fidelity : {0.01, 0.3, 9.0, 400.0}) {
    spec.fidelity = fidelity;
    EXPECT_NEAR(MeanDeviation(spec) / one, std::sqrt(fidelity),
                1e-3 * std::sqrt(fidelity));
  }
}

TEST_P(BothMappings, StayCloserInsideARegionOfSmallerFidelity) {
  TerrainSpec spec = Spec();
  spec.fidelity = 0.30;
  const double without = MeanDeviation(spec);
  spec.continuous_constraints.push_back(
      SquareRegion(ConstraintQuantity::kFidelity, 0.05, 2, 1e-3));
  // The same samples with and without the region around them.
  EXPECT_NEAR(MeanDeviation(spec) / without, std::sqrt(0.05 / 0.30), 1e-3);
  // And beyond its reach nothing changes.
  const Window outside = {4096, 4096, 128, 128};
  const TerrainSpec with = spec;
  spec.continuous_constraints.clear();
  EXPECT_EQ(HeightPatch(*MakeTerrain(with), kLevel, outside).values,
            HeightPatch(*MakeTerrain(spec), kLevel, outside).values);
}

TEST_P(BothMappings, FollowTheirEquation) {
  TerrainSpec spec = Spec();
  spec.fidelity = 2.5;
  spec.delta = 0.01;
  const auto terrain = MakeTerrain(spec);
  const Patch p = FractalPatch(*terrain, kLevel, kWindow);
  const Patch d = MacroPatch(*terrain, kLevel, kWindow);
  const Patch heights = HeightPatch(*terrain, kLevel, kWindow);
  const double z = 1 / (std::sqrt(6) + 0.01);
  for (std::size_t k = 0; k < p.values.size(); ++k) {
    const auto fractal = static_cast<double>(p.values[k]);
    const double cut = std::min(std::fabs(fractal), std::sqrt(6));
    const double expected =
        spec.mapping == HeightMapping::kLinear
            ? std::sqrt(2.5) * fractal
            : std::copysign(std::sqrt(-2 * 2.5 * std::log1p(-z * cut)),
                            fractal);
    ASSERT_NEAR(static_cast<double>(heights.values[k]),
                static_cast<double>(d.values[k]) + expected, 3e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, BothMappings,
    testing::Values(Chain{FractalSource::kMidpoint, HeightMapping::kBoltzmann},
                    Chain{FractalSource::kSubdivision, HeightMapping::kLinear},
                    Chain{FractalSource::kSuccessive,
                          HeightMapping::kBoltzmann}));

double LargestDeviation(const TerrainSpec& spec) {
  const auto terrain = MakeTerrain(spec);
  double largest = 0;
  // Level 0 holds the largest values of P: independent draws.
  for (const int level : {0, 6}) {
    const Patch heights = HeightPatch(*terrain, level, kWindow);
    const Patch macro = MacroPatch(*terrain, level, kWindow);
    for (std::size_t k = 0; k < heights.values.size(); ++k) {
      largest = std::max(
          largest,
          static_cast<double>(std::fabs(heights.values[k] - macro.values[k])));
    }
  }
  return largest;
}

TEST(Bounds, OfBoltzmannAreMetAndNeverPassed) {
  TerrainSpec spec;
  spec.source = FractalSource::kMidpoint;
  spec.mapping = HeightMapping::kBoltzmann;
  spec.fidelity = 1.5;
  for (const double delta : {1.0, 0.05, 1e-3}) {
    spec.delta = delta;
    const double bound = *MakeTerrain(spec)->DeviationBound();
    EXPECT_NEAR(bound, std::sqrt(-3 * std::log(delta / (std::sqrt(6) + delta))),
                1e-9);
    const double largest = LargestDeviation(spec);
    EXPECT_LE(largest, bound * (1 + 1e-4));
    EXPECT_GT(largest, bound * 0.999);  // one in 70 draws of level 0 is cut
  }
}

TEST(Bounds, OfTheSoftLimitAreNeverPassedAndSmallDeviationsAreKept) {
  TerrainSpec spec;
  spec.fidelity = 100;
  const auto free = MakeTerrain(spec);
  EXPECT_FALSE(free->DeviationBound().has_value());
  spec.soft_limit = 12;
  const auto limited = MakeTerrain(spec);
  EXPECT_EQ(limited->DeviationBound(), 12);
  EXPECT_LT(LargestDeviation(spec), 12);
  EXPECT_GT(LargestDeviation(spec), 10);
  const Patch all = HeightPatch(*free, kLevel, kWindow);
  const Patch cut = HeightPatch(*limited, kLevel, kWindow);
  for (std::size_t k = 0; k < all.values.size(); ++k) {
    const auto u = static_cast<double>(all.values[k]);
    ASSERT_NEAR(static_cast<double>(cut.values[k]),
                u / std::sqrt(1 + u * u / 144), 2e-5);
  }
}

// --- Roughness by region ----------------------------------------------------

TEST(RoughnessRegion, IsAsSmoothInsideAsItsHSays) {
  for (const double inside_h : {0.65, 0.95}) {
    Variogram inside({1, 2, 3, 4, 6, 8}, 1, 0);
    Variogram outside({1, 2, 3, 4, 6, 8}, 1, 0);
    for (int k = 0; k < 24; ++k) {
      TerrainSpec spec;
      spec.seed = k;
      spec.roughness = 0.8;
      spec.continuous_constraints.push_back(
          SquareRegion(ConstraintQuantity::kRoughness, inside_h, 6, 0.5));
      const auto terrain = MakeTerrain(spec);
      inside.Add(FractalPatch(*terrain, kLevel, kWindow));
      outside.Add(FractalPatch(*terrain, kLevel, {20000, 20000, 512, 512}));
    }
    RecordProperty("inside_" + std::to_string(inside_h),
                   std::to_string(inside.Hurst()));
    RecordProperty("outside_" + std::to_string(inside_h),
                   std::to_string(outside.Hurst()));
    EXPECT_NEAR(inside.Hurst(), inside_h, 0.03);
    EXPECT_NEAR(outside.Hurst(), 0.8, 0.03);
    // The coarse levels are alike, so the region of larger H has the smaller
    // increments.
    EXPECT_EQ(inside.MeanSquare(0) < outside.MeanSquare(0), inside_h > 0.8);
  }
}

// --- Discrete constraints ---------------------------------------------------

TEST(DiscreteConstraints, AreMetToTheBitAtEveryLevelFromTheirOwn) {
  for (const int dimensions : {1, 2}) {
    for (const bool bounded : {false, true}) {
      TerrainSpec spec =
          HillySpec(FractalSource::kMidpoint, HeightMapping::kBoltzmann);
      spec.dimensions = dimensions;
      if (bounded) spec.domain = Domain{4, 4};
      for (const int level : {0, 1, 3, 6}) {
        for (const int k : {1, 3}) {
          DiscreteConstraint c;
          c.level = level;
          c.point = {k + std::ldexp(1, -level), k - std::ldexp(1, -level)};
          spec.discrete_constraints.push_back(c);
        }
      }
      const auto terrain = MakeTerrain(spec);
      for (const DiscreteConstraint& c : spec.discrete_constraints) {
        for (const int level : {*c.level, *c.level + 1, 9, 30}) {
          const auto index = [&](double x) {
            return static_cast<std::int64_t>(std::ldexp(x, level));
          };
          const Window at = {index(c.point.x),
                             dimensions == 1 ? 0 : index(c.point.y), 1, 1};
          EXPECT_EQ(HeightPatch(*terrain, level, at).values,
                    MacroPatch(*terrain, level, at).values);
          EXPECT_EQ(FractalPatch(*terrain, level, at).values[0], 0.0f);
        }
      }
    }
  }
}

TEST(DiscreteConstraints, SnapToTheNearestPointOfTheCoarsestLevelInRadius) {
  TerrainSpec spec;
  spec.source = FractalSource::kMidpoint;
  DiscreteConstraint c;
  c.point = {3.2, -1.4};
  c.radius = 0.3;  // level 2, spacing 0.25
  spec.discrete_constraints.push_back(c);
  const auto terrain = MakeTerrain(spec);
  EXPECT_EQ(FractalPatch(*terrain, 2, {13, -6, 1, 1}).values[0], 0.0f);
  EXPECT_NE(FractalPatch(*terrain, 2, {12, -6, 1, 1}).values[0], 0.0f);
}

// The mean squared increment around a point, by lag: up to half the distance to
// its parents, where the buffered points lie.
using Increments = std::vector<double>;

constexpr int kRealisations = 3000;
constexpr int kFiner = 4;  // levels below the constraint's that are looked at

void AddIncrements(const std::vector<float>& line, std::size_t middle,
                   Increments* sums) {
  sums->resize(std::size_t{1} << (kFiner - 1));
  for (std::size_t lag = 1; lag <= sums->size(); ++lag) {
    for (const float end : {line[middle - lag], line[middle + lag]}) {
      const double d = static_cast<double>(end - line[middle]);
      (*sums)[lag - 1] += d * d;
    }
  }
}

// Core's lines, constrained or not, at a point that appears at `level`.
Increments CoreIncrements(int level, double roughness, bool constrained) {
  Increments sums;
  for (int k = 0; k < kRealisations; ++k) {
    TerrainSpec spec;
    spec.dimensions = 1;
    spec.source = FractalSource::kMidpoint;
    spec.roughness = roughness;
    // Worlds of their own: the ratio is one of independent means.
    spec.seed = 2 * k + (constrained ? 1 : 0);
    const std::int64_t index = (std::int64_t{1} << level) / 2 + 1;  // odd
    if (constrained) {
      spec.discrete_constraints.push_back(
          {{std::ldexp(static_cast<double>(index), -level), 0}, level, {}});
    }
    const std::int64_t reach = std::int64_t{1} << kFiner;
    const Patch line =
        FractalPatch(*MakeTerrain(spec), level + kFiner,
                     {index * reach - reach, 0, 2 * reach + 1, 1});
    AddIncrements(line.values, static_cast<std::size_t>(reach), &sums);
  }
  return sums;
}

// Midpoint displacement of [0, 1] written once more, to try other buffers than
// eq. 11's: `share` of P(p*) goes to both neighbours' initial values (eq. 11:
// -1/2; none: 0; the opposite sign: +1/2). No constraint: a share of nothing.
Increments ControlIncrements(int level, double roughness, double share) {
  Increments sums;
  for (int k = 0; k < kRealisations; ++k) {
    const auto normal = [&](std::size_t draw) {
      return NormalFromBits(
          HashLane(ColumnWord(static_cast<std::int64_t>(draw)),
                   MakeRowKey(StreamKey(1'000'000 + k, 0), 0)));
    };
    const int finest = level + kFiner;
    const std::size_t size = std::size_t{1} << finest;
    std::vector<float> line(size + 1);
    line[0] = normal(0);
    line[size] = normal(size);
    const std::size_t point = ((size >> kFiner) / 2 + 1) << kFiner;
    float buffer = 0;
    for (int n = 1; n <= finest; ++n) {
      const std::size_t step = size >> n;
      const auto deviation = static_cast<float>(DisplacementDeviation(
          FractalSource::kMidpoint, 1, roughness, n, HalfStep::kEdge));
      for (std::size_t i = step; i < size; i += 2 * step) {
        line[i] = (line[i - step] + line[i + step]) / 2 + normal(i) * deviation;
        if (n == level + 1 && (i + step == point || i - step == point)) {
          line[i] += buffer;
        }
      }
      if (n == level) {
        buffer = static_cast<float>(share) * line[point];
        line[point] = 0;
      }
    }
    AddIncrements(line, point, &sums);
  }
  return sums;
}

// Smallest and largest ratio over the lags.
struct Ratio {
  double smallest = 1e300;
  double largest = 0;

  void Add(const Increments& constrained, const Increments& free) {
    for (std::size_t k = 0; k < free.size(); ++k) {
      smallest = std::min(smallest, constrained[k] / free[k]);
      largest = std::max(largest, constrained[k] / free[k]);
    }
  }
  std::string Text() const {
    return std::to_string(smallest) + " to " + std::to_string(largest);
  }
};

TEST(RegionBuffering, KeepsTheIncrementsAroundAConstraintAsTheyWere) {
  Ratio printed, control, opposite, none;
  for (const double roughness : {0.5, 0.8}) {
    for (const int level : {2, 4, 7}) {
      const Increments free = CoreIncrements(level, roughness, false);
      printed.Add(CoreIncrements(level, roughness, true), free);
      control.Add(ControlIncrements(level, roughness, -0.5), free);
      opposite.Add(ControlIncrements(level, roughness, 0.5), free);
      none.Add(ControlIncrements(level, roughness, 0), free);
    }
  }
  RecordProperty("printed_sign", printed.Text());
  RecordProperty("printed_sign_control", control.Text());
  RecordProperty("opposite_sign", opposite.Text());
  RecordProperty("no_buffering", none.Text());
  // The method page's figures; other buffers tear the neighbourhood apart.
  EXPECT_GE(printed.smallest, 0.95);
  EXPECT_LE(printed.largest, 1.11);
  EXPECT_GE(control.smallest, 0.95);
  EXPECT_LE(control.largest, 1.11);
  EXPECT_GT(opposite.smallest, 1.5);
  EXPECT_GT(none.smallest, 1.11);
  EXPECT_GT(opposite.largest, 1000);
  EXPECT_GT(none.largest, 300);
}

}  // namespace
}  // namespace terrane::core
