#include "core/terrain/ancestor_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/terrain/displacement_draw.h"
#include "core/terrain/fractal_lattice.h"
#include "core/terrain/fractal_line.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kSeed = 77;
constexpr double kRoughness = 0.7;

struct Case {
  FractalSource source;
  int dimensions;
  std::optional<Domain> domain;
};

std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision,
        FractalSource::kSuccessive}) {
    for (const int dimensions : {1, 2}) {
      cases.push_back({source, dimensions, std::nullopt});
      cases.push_back({source, dimensions, Domain{1, 1}});
      cases.push_back({source, dimensions, Domain{3, 2}});
    }
  }
  return cases;
}

DeviationModel ModelOf(const Case& c) {
  DeviationModel::Config config;
  config.source = c.source;
  config.dimensions = c.dimensions;
  config.mirror = {c.domain};
  config.roughness = kRoughness;
  return DeviationModel(config);
}

double LatticeValue(const Case& c, int level, LatticePoint point) {
  if (c.dimensions == 1) {
    const FractalLine line({kSeed, c.source, {c.domain}}, ModelOf(c), {});
    FractalLine::Scratch scratch;
    return line.Points(level, point.x, 1, {}, &scratch)[0];
  }
  const FractalLattice lattice({kSeed, c.source, {c.domain}, false}, ModelOf(c),
                               {});
  FractalLattice::Scratch scratch;
  return lattice.Points(level, {point.x, point.y, 1, 1}, {}, &scratch).At(0, 0);
}

double WeightedSum(const Case& c, int level, LatticePoint point) {
  const DeviationModel model = ModelOf(c);
  AncestorWalk walk(c.source, c.dimensions, {c.domain});
  walk.Start(level, point);
  std::vector<Ancestor> ancestors;
  double sum = 0;
  while (walk.Next(&ancestors)) {
    for (const Ancestor& a : ancestors) {
      const double deviation =
          walk.level() == 0
              ? Level0Deviation(c.source)
              : DisplacementDeviation(c.source, c.dimensions, kRoughness,
                                      walk.level(), a.step);
      const std::uint32_t stream = c.dimensions == 1
                                       ? LineStream(walk.level())
                                       : PlaneStream(walk.level(), a.step);
      sum += a.weight * deviation *
             static_cast<double>(
                 DisplacementDraw(kSeed, stream, a.point.x, a.point.y));
    }
  }
  return sum;
}

std::vector<LatticePoint> PointsOf(const Case& c, int level) {
  const std::int64_t side = std::int64_t{1} << level;
  std::vector<LatticePoint> points = {{0, 0}, {1, 0}, {side / 2 + 1, 0}};
  if (!c.domain) points.push_back({-5, 0});
  if (c.dimensions == 1) return points;
  const std::vector<LatticePoint> of_plane = {{0, 1},
                                              {1, 1},
                                              {side, side - 1},
                                              {side / 2, side / 2 + 3},
                                              {side - 3, 5}};
  for (const LatticePoint& point : of_plane) points.push_back(point);
  if (!c.domain) points.push_back({-7, 1234567});
  return points;
}

TEST(AncestorWalkTest, WeightsTimesDisplacementsAreTheLatticesOwnValue) {
  for (const Case& c : Cases()) {
    for (const int level : {3, 7}) {
      for (const LatticePoint& point : PointsOf(c, level)) {
        SCOPED_TRACE(testing::Message()
                     << "source " << static_cast<int>(c.source) << " dims "
                     << c.dimensions << " bounded " << c.domain.has_value()
                     << " level " << level << " (" << point.x << ", " << point.y
                     << ")");
        EXPECT_NEAR(LatticeValue(c, level, point), WeightedSum(c, level, point),
                    3e-6);
      }
    }
  }
}

TEST(AncestorWalkTest, EveryDisplacementOccursOnceAndInsideTheBox) {
  AncestorWalk walk(FractalSource::kSubdivision, 2, {Domain{1, 1}});
  walk.Start(9, {511, 3});
  std::vector<Ancestor> ancestors;
  while (walk.Next(&ancestors)) {
    std::map<std::pair<std::int64_t, std::int64_t>, int> seen;
    for (const Ancestor& a : ancestors) {
      EXPECT_EQ(++seen[std::pair(a.point.x, a.point.y)], 1);
      EXPECT_GE(a.point.x, walk.box().x);
      EXPECT_LT(a.point.x, walk.box().x + walk.box().columns);
      EXPECT_GE(a.point.y, walk.box().y);
      EXPECT_LT(a.point.y, walk.box().y + walk.box().rows);
    }
  }
}

TEST(AncestorWalkTest, RadiusHoldsEveryAncestor) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision,
        FractalSource::kSuccessive}) {
    double farthest = 0;
    AncestorWalk walk(source, 2, {});
    std::vector<Ancestor> ancestors;
    for (std::int64_t k = 0; k < 400; ++k) {
      const int level = 16;
      const LatticePoint start = {k * 7919 % 65536, k * 104729 % 65536};
      walk.Start(level, start);
      while (walk.Next(&ancestors)) {
        const int up = level - walk.level();
        for (const Ancestor& a : ancestors) {
          const double dx = std::ldexp(static_cast<double>(start.x), -up) -
                            static_cast<double>(a.point.x);
          const double dy = std::ldexp(static_cast<double>(start.y), -up) -
                            static_cast<double>(a.point.y);
          farthest = std::max({farthest, std::fabs(dx), std::fabs(dy)});
        }
      }
    }
    EXPECT_LE(farthest, AncestorWalk::Radius(source));
    EXPECT_GE(farthest, 0.9 * AncestorWalk::Radius(source));
  }
}

TEST(AncestorWalkTest, SeparatedPointsHaveNoAncestorThatCountsInCommon) {
  constexpr int kLevel = 12;
  constexpr int kUp = 5;
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision}) {
    AncestorWalk walk(source, 2, {});
    const auto row = [&](LatticePoint point) {
      std::map<std::pair<std::int64_t, std::int64_t>, double> weights;
      std::vector<Ancestor> ancestors;
      walk.Start(kLevel, point);
      while (walk.Next(&ancestors)) {
        if (walk.level() != kLevel - kUp) continue;
        for (const Ancestor& a : ancestors) {
          weights[{a.point.x, a.point.y}] = a.weight;
        }
      }
      return weights;
    };
    const auto common = [&](double separation, std::int64_t k) {
      const LatticePoint a = {k * 7919 % 4096, k * 104729 % 4096};
      const auto apart = static_cast<std::int64_t>(separation * (1 << kUp));
      const auto first = row(a);
      const auto second = row({a.x + apart, a.y + k * 31 % apart});
      double sum = 0;
      for (const auto& [point, weight] : first) {
        const auto found = second.find(point);
        if (found != second.end()) sum += weight * found->second;
      }
      return std::fabs(sum);
    };
    double counted = 0;
    for (std::int64_t k = 0; k < 200; ++k) {
      EXPECT_LT(common(AncestorWalk::Separation(source), k), 0x1p-28);
      counted =
          std::max(counted, common(0.75 * AncestorWalk::Separation(source), k));
    }
    EXPECT_GT(counted, 0x1p-28);
  }
}

}  // namespace
}  // namespace terrane::core
