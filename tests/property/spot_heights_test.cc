// Spot heights: met to the bit, everywhere they can be seen from; and between
// them the process as it would have been had it passed there by itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/violations.h"
#include "core/terrain/ancestor_weights.h"
#include "core/terrain/displacement_draw.h"
#include "core/terrain/terrain.h"

namespace terrane::core {
namespace {

TerrainSpec Spec(FractalSource source, HeightMapping mapping, int dimensions) {
  TerrainSpec spec;
  spec.dimensions = dimensions;
  spec.seed = 11;
  spec.source = source;
  spec.mapping = mapping;
  spec.fidelity = 400;
  spec.roughness = 0.75;
  spec.domain = Domain{4, 3};
  spec.frame = Frame{1000, 5000, 64, -64};
  spec.macro.base = 312.5;
  ContinuousConstraint rough;
  rough.quantity = ConstraintQuantity::kRoughness;
  rough.target = 0.95;
  rough.reach = 90;
  rough.vertices = {{1100, 4950}};
  spec.continuous_constraints.push_back(rough);
  return spec;
}

// `count` distinct lattice points of `level` with heights around the macro
// shape.
void AddSpots(int count, int level, TerrainSpec* spec) {
  std::mt19937_64 engine(7);
  std::set<std::pair<std::int64_t, std::int64_t>> taken;
  auto table = std::make_shared<std::vector<SpotHeight>>();
  const auto draw = [&](std::int64_t most) {
    return static_cast<std::int64_t>(engine() %
                                     static_cast<std::uint64_t>(most + 1));
  };
  while (table->size() < static_cast<std::size_t>(count)) {
    const std::int64_t x = draw(spec->domain->cells_x << level);
    const std::int64_t y =
        spec->dimensions == 1 ? 0 : draw(spec->domain->cells_y << level);
    if (!taken.insert({x, y}).second) continue;
    SpotHeight spot;
    spot.point = {
        spec->frame->origin_x +
            std::ldexp(static_cast<double>(x), -level) * spec->frame->spacing_x,
        spec->frame->origin_y + std::ldexp(static_cast<double>(y), -level) *
                                    spec->frame->spacing_y};
    spot.height = spec->macro.base + static_cast<double>(draw(4000)) / 100 - 20;
    table->push_back(spot);
  }
  spec->spots.table = std::move(table);
  spec->spots.level = level;
}

std::shared_ptr<const Terrain> Make(const TerrainSpec& spec) {
  auto terrain = Terrain::Create(spec);
  EXPECT_TRUE(terrain.ok()) << terrain.status();
  return *terrain;
}

std::vector<float> Samples(const Terrain& terrain, int level,
                           const Window& window,
                           Sampling sampling = Sampling::kPoint) {
  std::vector<float> heights(
      static_cast<std::size_t>(window.width * window.height));
  TileScratch scratch;
  const absl::Status status =
      terrain.Generate({level, sampling, window}, {}, &scratch, heights);
  EXPECT_TRUE(status.ok()) << status;
  return heights;
}

// The spot's index at a level, if that level's lattice holds it.
std::optional<std::pair<std::int64_t, std::int64_t>> IndexAt(
    const TerrainSpec& spec, const SpotHeight& spot, int level) {
  const double x = std::ldexp(
      (spot.point.x - spec.frame->origin_x) / spec.frame->spacing_x, level);
  const double y = spec.dimensions == 1
                       ? 0
                       : std::ldexp((spot.point.y - spec.frame->origin_y) /
                                        spec.frame->spacing_y,
                                    level);
  if (x != std::floor(x) || y != std::floor(y)) return std::nullopt;
  return std::pair(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
}

struct MetCase {
  FractalSource source;
  HeightMapping mapping;
  int dimensions;
  int count;
  bool bounded;
};

class SpotsAreMetTest : public ::testing::TestWithParam<MetCase> {};

TEST_P(SpotsAreMetTest, ToTheBitAtEveryLevelThatHoldsThem) {
  const MetCase& c = GetParam();
  TerrainSpec spec = Spec(c.source, c.mapping, c.dimensions);
  const int spot_level = c.dimensions == 1 ? 10 : 7;
  AddSpots(c.count, spot_level, &spec);
  if (!c.bounded) spec.domain.reset();
  const auto terrain = Make(spec);
  EXPECT_EQ(terrain->spots()->spots, c.count);
  EXPECT_LT(terrain->spots()->largest_move, 1e-9);
  std::int64_t seen = 0;
  std::mt19937_64 engine(3);
  for (int level = 0; level <= spot_level + 6; ++level) {
    for (const SpotHeight& spot : *spec.spots.table) {
      const auto index = IndexAt(spec, spot, level);
      if (!index || (level > spot_level + 1 && engine() % 8 != 0)) continue;
      // A random small window around it, cut to the domain.
      const std::optional<Window> extent =
          terrain->Extent(level, Sampling::kPoint);
      Window window = {
          index->first - static_cast<std::int64_t>(engine() % 5),
          c.dimensions == 1
              ? 0
              : index->second - static_cast<std::int64_t>(engine() % 5),
          6, c.dimensions == 1 ? 1 : 6};
      if (extent) {
        window.x = std::max<std::int64_t>(window.x, 0);
        window.y = std::max<std::int64_t>(window.y, 0);
        window.width = std::min(window.width, extent->width - window.x);
        window.height = std::min(window.height, extent->height - window.y);
      }
      const std::vector<float> heights = Samples(*terrain, level, window);
      const float met = heights[static_cast<std::size_t>(
          (index->second - window.y) * window.width + index->first - window.x)];
      ASSERT_EQ(std::bit_cast<std::uint32_t>(met),
                std::bit_cast<std::uint32_t>(static_cast<float>(spot.height)))
          << "level " << level;
      ++seen;
    }
  }
  EXPECT_GE(seen, 2 * c.count);
}

// The pins do not hide a lattice that misses: P_fbm itself, which is not
// pinned, gives the height up to float arithmetic.
TEST(SpotHeightsTest, TheProcessItselfPassesThroughThem) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision,
        FractalSource::kSuccessive}) {
    for (const int dimensions : {1, 2}) {
      TerrainSpec spec = Spec(source, HeightMapping::kLinear, dimensions);
      const int level = dimensions == 1 ? 10 : 7;
      AddSpots(60, level, &spec);
      const auto terrain = Make(spec);
      TileScratch scratch;
      for (const SpotHeight& spot : *spec.spots.table) {
        const auto index = IndexAt(spec, spot, level);
        float fractal = 0;
        ASSERT_TRUE(terrain
                        ->GenerateFractal({level,
                                           Sampling::kPoint,
                                           {index->first, index->second, 1, 1}},
                                          {}, &scratch, {&fractal, 1})
                        .ok());
        EXPECT_NEAR(spec.macro.base + 20 * static_cast<double>(fractal),
                    spot.height, 2e-4);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Spots, SpotsAreMetTest,
    ::testing::Values(
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 2, 1,
                true},
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 2, 100,
                true},
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 2, 100,
                false},
        MetCase{FractalSource::kSubdivision, HeightMapping::kBoltzmann, 2, 100,
                true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kLinear, 2, 100, true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kBoltzmann, 2, 100,
                false},
        MetCase{FractalSource::kSuccessive, HeightMapping::kLinear, 2, 100,
                true},
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 1, 60,
                true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kLinear, 1, 60, true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kBoltzmann, 1, 60,
                false},
        MetCase{FractalSource::kSuccessive, HeightMapping::kLinear, 1, 60,
                true}));

TEST(SpotHeightsTest, AnAreaSampleThatIsASpotHasItsHeight) {
  TerrainSpec spec =
      Spec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  spec.spots.points = {{{1000 + 64 * 1.25, 5000 - 64 * 0.75}, 300.25}};
  const auto terrain = Make(spec);
  EXPECT_EQ(terrain->spots()->level, 2);
  // (5, 3) of level 2 is the centre of cell (2, 1) of level 1.
  EXPECT_EQ(Samples(*terrain, 1, {2, 1, 1, 1}, Sampling::kArea)[0], 300.25f);
}

// --- The conditional distribution -------------------------------------------

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
        Samples(*Make(spec), kLevel, {0, 0, side, rows});
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
      const auto without = Make(spec);
      spec.spots.level = kLevel;
      // Heights that another realisation has there.
      TerrainSpec other = spec;
      other.spots = {};
      other.seed = seed + 100000;
      const auto source_of_heights = Make(other);
      const LatticePoint at[] = {{17, 23}, {90, 37}, {51, 101}};
      for (const LatticePoint& p : at) {
        spec.spots.points.push_back(
            {{static_cast<double>(p.x) / 64, static_cast<double>(p.y) / 64},
             static_cast<double>(
                 Samples(*source_of_heights, kLevel, {p.x, p.y, 1, 1})[0])});
      }
      const auto with = Make(spec);
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

// --- Discrete constraints, lines, refinements -------------------------------

TEST(SpotHeightsTest, DiscreteConstraintsAreMetWithEverySource) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision,
        FractalSource::kSuccessive}) {
    TerrainSpec spec = Spec(source, HeightMapping::kLinear, 2);
    spec.macro.parts.push_back(
        {MacroCombine::kAdd, Plane{{1000, 5000}, 0, 0.37, -0.21}});
    spec.discrete_method = DiscreteMethod::kCondition;
    spec.discrete_constraints = {{.point = {1100, 4900}, .level = 5},
                                 {.point = {1200, 4850}, .level = 3}};
    const auto terrain = Make(spec);
    EXPECT_EQ(terrain->spots()->spots, 2);
    TileScratch scratch;
    for (const auto& [index, level] :
         {std::pair(std::pair(50, 50), 5), std::pair(std::pair(25, 19), 3)}) {
      const TileRequest request = {
          level, Sampling::kPoint, {index.first, index.second, 1, 1}};
      float macro = 0;
      ASSERT_TRUE(terrain->GenerateMacro(request, &scratch, {&macro, 1}).ok());
      EXPECT_EQ(Samples(*terrain, level, request.window)[0], macro);
      EXPECT_EQ(Samples(*terrain, level + 4,
                        {16 * index.first, 16 * index.second, 1, 1})[0],
                macro);
    }
  }
}

TEST(SpotHeightsTest, ARiverOnlyFalls) {
  TerrainSpec spec =
      Spec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  SpotLine river;
  river.vertices = {{1010, 4990}, {1100, 4930}, {1180, 4840}};
  river.only_falls = true;
  // Over a macro shape that rises on the way.
  spec.macro.parts.push_back(
      {MacroCombine::kAdd, GaussianHill{{1100, 4930}, 30, 30, 80}});
  spec.spots.lines = {river};
  spec.spots.level = 6;
  const auto terrain = Make(spec);
  EXPECT_GT(terrain->spots()->spots, 150);
  float last = std::numeric_limits<float>::infinity();
  int falls = 0;
  for (int leg = 0; leg < 2; ++leg) {
    const Point2& a = river.vertices[static_cast<std::size_t>(leg)];
    const Point2& b = river.vertices[static_cast<std::size_t>(leg) + 1];
    const int steps =
        static_cast<int>(std::ceil(std::hypot(b.x - a.x, b.y - a.y)));
    for (int s = 0; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      const auto x = static_cast<std::int64_t>(
          std::nearbyint(a.x + t * (b.x - a.x) - 1000));
      const auto y = static_cast<std::int64_t>(
          std::nearbyint(5000 - (a.y + t * (b.y - a.y))));
      const float height = Samples(*terrain, 6, {x, y, 1, 1})[0];
      EXPECT_LE(height, last);
      falls += height < last ? 1 : 0;
      last = height;
    }
  }
  EXPECT_GT(falls, 10);
}

// --- What is refused --------------------------------------------------------

std::string Refusal(const TerrainSpec& spec) {
  const auto terrain = Terrain::Create(spec);
  return terrain.ok() ? "" : std::string(terrain.status().message());
}

TEST(SpotHeightsTest, ErrorsNameTheRows) {
  const TerrainSpec good =
      Spec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  const auto with = [&](std::vector<SpotHeight> points) {
    TerrainSpec spec = good;
    spec.spots.points = std::move(points);
    return spec;
  };
  TerrainSpec spec = with({{{1001, 4999}, 300}, {{1001, 4999}, 301}});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[1]"));
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[0]"));
  spec = with({{{1001, 4999}, 300}, {{1001, 4999}, 300}});
  EXPECT_EQ(Make(spec)->spots()->merged, 1);

  spec = with({{{999, 4999}, 300}});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[0].x"));
  spec = with({{{1001, 4999}, std::nan("")}});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[0].height"));
  spec = with({{{1001, 4999}, 300}});
  spec.fidelity = 0;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("fidelity T is 0"));
  spec.spots.points[0].height = 312.5;
  EXPECT_EQ(Refusal(spec), "");
  spec = with({{{1001, 4999}, 312.5 + 100}});
  spec.mapping = HeightMapping::kBoltzmann;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("what the mapping reaches"));
  spec = with({{{1001, 4999}, 300}});
  spec.soft_limit = 5;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("what the mapping reaches"));
  spec = good;
  spec.spots.points.resize(10'001, {{1001, 4999}, 300});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("at most 10000"));
  spec = good;
  spec.spots.table = std::make_shared<std::vector<SpotHeight>>(
      100'001, SpotHeight{{1001, 4999}, 300, 0});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.table"));
  spec = good;
  spec.spots.lines = {{{{1001, 4999}, {1200, 4900}}, {300, 310}, 0, 0, true}};
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.lines[0].heights[1]"));
  spec.spots.lines = {
      {{{1001, 4999}, {1200, 4900}}, {300, 290}, 1e-9, 0, true}};
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("at most 100000"));
  spec = with({{{1001, 4999}, 300}});
  spec.source = FractalSource::kMidpoint;
  spec.discrete_method = DiscreteMethod::kBuffer;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("discrete_method"));
}

TEST(SpotHeightsTest, PointsTooCloseForTheirHeightsAreRefused) {
  // One sample apart at level 30, 100 m of difference, on nearly smooth ground.
  TerrainSpec spec;
  spec.roughness = 0.99;
  spec.spots.level = 30;
  spec.spots.points = {{{0.5, 0.5}, 0}, {{0.5 + 0x1p-30, 0.5}, 100}};
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("too close together"));
}

TEST(SpotHeightsTest, PreparationTellsHowFarItIsAndCanBeStopped) {
  TerrainSpec spec =
      Spec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  AddSpots(500, 7, &spec);
  double last = 0;
  int calls = 0;
  Preparation watched;
  watched.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    ++calls;
  };
  ASSERT_TRUE(Terrain::Create(spec, watched).ok());
  EXPECT_GT(calls, 20);
  EXPECT_GT(last, 0.9);

  // Stopped at each stage, it ends there.
  for (const double at : {0.05, 0.5, 0.95}) {
    std::stop_source stop;
    Preparation ended;
    ended.stop = stop.get_token();
    ended.progress = [&](double fraction) {
      if (fraction >= at) stop.request_stop();
    };
    EXPECT_EQ(Terrain::Create(spec, ended).status().code(),
              absl::StatusCode::kCancelled);
  }
}

}  // namespace
}  // namespace terrane::core
