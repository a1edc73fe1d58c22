// Between spot heights the ground is what the process makes when it passes
// there by itself: the conditional distribution of kriging, and increments that
// keep their free variance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

#include "core/terrain/ancestor_weights.h"
#include "core/terrain/terrain.h"
#include "tests/property/spot_terrain.h"

namespace terrane::core {
namespace {

// Rows of W times deviation, by displacement.
using Row = std::map<std::tuple<int, int, std::int64_t, std::int64_t>, double>;

Row RowOf(const TerrainSpec& spec, int level, LatticePoint point) {
  while (level > 0 && (point.x & 1) == 0 && (point.y & 1) == 0) {
    point = {point.x / 2, point.y / 2};
    --level;
  }
  AncestorWalk walk(spec.source, spec.dimensions, {spec.domain});
  walk.Start(level, point);
  Row row;
  std::vector<Ancestor> ancestors;
  while (walk.Next(&ancestors)) {
    for (const Ancestor& a : ancestors) {
      const double deviation =
          walk.level() == 0
              ? Level0Deviation(spec.source)
              : DisplacementDeviation(spec.source, spec.dimensions,
                                      *spec.roughness, walk.level(), a.step);
      row[{walk.level(), static_cast<int>(a.step), a.point.x, a.point.y}] =
          a.weight * deviation;
    }
  }
  return row;
}

double Covariance(const Row& a, const Row& b) {
  double sum = 0;
  for (const auto& [key, value] : a) {
    const auto found = b.find(key);
    if (found != b.end()) sum += value * found->second;
  }
  return sum;
}

// Solves a x = b by Gaussian elimination; a is small and positive definite.
std::vector<double> Solve(std::vector<std::vector<double>> a,
                          std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

struct Distribution {
  std::vector<double> mean;
  std::vector<std::vector<double>> covariance;
};

// Kriging with the process's own covariance.
Distribution ClosedForm(const std::vector<Row>& points,
                        const std::vector<Row>& spots,
                        const std::vector<double>& values,
                        const std::vector<double>& nuggets) {
  std::vector<std::vector<double>> gram(spots.size());
  for (std::size_t k = 0; k < spots.size(); ++k) {
    for (const Row& other : spots) {
      gram[k].push_back(Covariance(spots[k], other));
    }
    gram[k][k] += nuggets[k];
  }
  Distribution result;
  std::vector<std::vector<double>> weights;
  std::vector<std::vector<double>> crosses;
  for (const Row& point : points) {
    std::vector<double> cross;
    for (const Row& spot : spots) cross.push_back(Covariance(point, spot));
    weights.push_back(Solve(gram, cross));
    result.mean.push_back(std::inner_product(values.begin(), values.end(),
                                             weights.back().begin(), 0.0));
    crosses.push_back(cross);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.covariance.emplace_back();
    for (std::size_t j = 0; j < points.size(); ++j) {
      result.covariance[i].push_back(
          Covariance(points[i], points[j]) -
          std::inner_product(crosses[j].begin(), crosses[j].end(),
                             weights[i].begin(), 0.0));
    }
  }
  return result;
}

struct ConditionalCase {
  FractalSource source;
  int dimensions;
  double standard_error;
};

class ConditionalDistributionTest
    : public ::testing::TestWithParam<ConditionalCase> {};

TEST_P(ConditionalDistributionTest, IsTheOneOfKriging) {
  const ConditionalCase& c = GetParam();
  constexpr int kLevel = 3;
  constexpr int kSeeds = 2000;
  TerrainSpec spec;
  spec.source = c.source;
  spec.dimensions = c.dimensions;
  spec.roughness = 0.7;
  spec.domain = Domain{1, 1};
  spec.spots.level = kLevel;
  const std::int64_t side = 9;
  const std::int64_t rows = c.dimensions == 1 ? 1 : side;
  // Spots in 1/8 of the cell; two of them neighbours.
  const std::vector<LatticePoint> places =
      c.dimensions == 1
          ? std::vector<LatticePoint>{{1, 0}, {2, 0}, {6, 0}}
          : std::vector<LatticePoint>{{1, 2}, {2, 2}, {6, 7}, {8, 0}, {4, 4}};
  const std::vector<double> values = {0.8, 0.5, -1.1, 0.3, -0.4};
  std::vector<Row> spots;
  std::vector<double> nuggets;
  for (std::size_t k = 0; k < places.size(); ++k) {
    spec.spots.points.push_back({{static_cast<double>(places[k].x) / 8,
                                  static_cast<double>(places[k].y) / 8},
                                 values[k],
                                 c.standard_error});
    spots.push_back(RowOf(spec, kLevel, places[k]));
    nuggets.push_back(c.standard_error * c.standard_error);
  }
  std::vector<Row> points;
  for (std::int64_t j = 0; j < rows; ++j) {
    for (std::int64_t i = 0; i < side; ++i) {
      points.push_back(RowOf(spec, kLevel, {i, j}));
    }
  }
  const Distribution expected =
      ClosedForm(points, spots,
                 {values.begin(),
                  values.begin() + static_cast<std::ptrdiff_t>(places.size())},
                 nuggets);

  const std::size_t n = points.size();
  std::vector<double> sum(n, 0.0);
  std::vector<std::vector<double>> products(n, std::vector<double>(n, 0.0));
  for (int seed = 0; seed < kSeeds; ++seed) {
    spec.seed = seed;
    const std::vector<float> p =
        Samples(*MakeSpotTerrain(spec), kLevel, {0, 0, side, rows});
    for (std::size_t i = 0; i < n; ++i) {
      const double a = static_cast<double>(p[i]) - expected.mean[i];
      sum[i] += a;
      for (std::size_t j = 0; j <= i; ++j) {
        products[i][j] += a * (static_cast<double>(p[j]) - expected.mean[j]);
      }
    }
  }
  // Sampling errors of a mean and of a covariance, in standard deviations; the
  // bounds leave room for the largest of n and of n^2 / 2 of them.
  for (std::size_t i = 0; i < n; ++i) {
    const double vi = expected.covariance[i][i];
    EXPECT_NEAR(sum[i] / kSeeds, 0, 4.5 * std::sqrt(vi / kSeeds) + 1e-6)
        << "mean at " << i;
    for (std::size_t j = 0; j <= i; ++j) {
      const double vj = expected.covariance[j][j];
      const double cij = expected.covariance[i][j];
      const double error =
          std::sqrt(std::max(0.0, vi * vj + cij * cij) / kSeeds);
      EXPECT_NEAR(products[i][j] / kSeeds, cij, 5 * error + 1e-6)
          << "covariance of " << i << " and " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Processes, ConditionalDistributionTest,
    ::testing::Values(ConditionalCase{FractalSource::kSubdivision, 2, 0},
                      ConditionalCase{FractalSource::kMidpoint, 2, 0},
                      ConditionalCase{FractalSource::kSubdivision, 2, 0.3},
                      ConditionalCase{FractalSource::kSubdivision, 1, 0},
                      ConditionalCase{FractalSource::kMidpoint, 1, 0.2}));

// Far-apart spots that the process could well have passed through leave the
// ground beside them as rough as ground anywhere.
TEST(SpotHeightsTest, IncrementsBesideASpotKeepTheirFreeVariance) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision}) {
    constexpr int kLevel = 6;
    double conditioned[3] = {};
    double free[3] = {};
    for (int seed = 0; seed < 1500; ++seed) {
      TerrainSpec spec;
      spec.source = source;
      spec.roughness = 0.8;
      spec.domain = Domain{2, 2};
      spec.seed = seed;
      const auto without = MakeSpotTerrain(spec);
      spec.spots.level = kLevel;
      // Heights that another realisation has there.
      TerrainSpec other = spec;
      other.spots = {};
      other.seed = seed + 100000;
      const auto source_of_heights = MakeSpotTerrain(other);
      const LatticePoint at[] = {{17, 23}, {90, 37}, {51, 101}};
      for (const LatticePoint& p : at) {
        spec.spots.points.push_back(
            {{static_cast<double>(p.x) / 64, static_cast<double>(p.y) / 64},
             static_cast<double>(
                 Samples(*source_of_heights, kLevel, {p.x, p.y, 1, 1})[0])});
      }
      const auto with = MakeSpotTerrain(spec);
      for (const LatticePoint& p : at) {
        const Window window = {p.x, p.y, 5, 1};
        const std::vector<float> a = Samples(*with, kLevel, window);
        const std::vector<float> b = Samples(*without, kLevel, window);
        for (int k = 0; k < 3; ++k) {
          const std::size_t lag = std::size_t{1} << k;
          const double da = static_cast<double>(a[lag] - a[0]);
          const double db = static_cast<double>(b[lag] - b[0]);
          conditioned[k] += da * da;
          free[k] += db * db;
        }
      }
    }
    for (int k = 0; k < 3; ++k) {
      const double ratio = conditioned[k] / free[k];
      EXPECT_GT(ratio, 0.8) << "lag " << (1 << k);
      EXPECT_LT(ratio, 1.2) << "lag " << (1 << k);
    }
  }
}

}  // namespace
}  // namespace terrane::core
