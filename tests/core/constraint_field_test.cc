// Continuous constraints against eqs. 13-15 of Tan & Chen 2003.
#include "core/terrain/constraint_field.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using Constraints = std::vector<ContinuousConstraint>;

constexpr double kBackground = 0.8;

ContinuousConstraint PointAt(double x, double y, double target, double falloff,
                             double reach) {
  return {.target = target,
          .falloff = falloff,
          .reach = reach,
          .vertices = {{x, y}}};
}

SampleGrid GridOf(std::vector<double> x, std::vector<double> y) {
  SampleGrid grid;
  grid.u = grid.x = std::move(x);
  grid.v = grid.y = std::move(y);
  return grid;
}

std::vector<double> Axis(double first, double step, std::size_t count) {
  std::vector<double> axis;
  for (std::size_t i = 0; i < count; ++i) {
    axis.push_back(first + step * static_cast<double>(i));
  }
  return axis;
}

// The field on a grid; the background where nothing reaches.
std::vector<float> Evaluate(const ConstraintField& field,
                            const SampleGrid& grid) {
  std::vector<float> out(grid.x.size() * grid.y.size(), field.background());
  field.Evaluate(grid, out.data(), static_cast<std::ptrdiff_t>(grid.x.size()));
  return out;
}

float ValueAt(const Constraints& constraints, double x, double y,
              int dimensions = 2) {
  return Evaluate(ConstraintField(constraints, ConstraintQuantity::kRoughness,
                                  kBackground, dimensions),
                  GridOf({x}, {y}))[0];
}

float F(double value) { return static_cast<float>(value); }

// Eq. 14: one source.
double One(double target, double falloff, double distance) {
  return (target - kBackground) / (1 + falloff * distance * distance);
}

TEST(ConstraintFieldTest, OneSourceFollowsEquation14) {
  const Constraints one{PointAt(10, 20, 0.5, 0.25, 4)};
  EXPECT_FLOAT_EQ(ValueAt(one, 10, 20), 0.5f);
  EXPECT_FLOAT_EQ(ValueAt(one, 12, 21), F(0.8 - 0.3 / (1 + 0.25 * 9)));
  // On the border of the diamond, where it is not 0, and just beyond it.
  EXPECT_FLOAT_EQ(ValueAt(one, 12, 22), F(0.8 - 0.3 / (1 + 0.25 * 16)));
  EXPECT_EQ(ValueAt(one, 12, 22.001), F(0.8));
}

TEST(ConstraintFieldTest, OverlappingSourcesFollowEquation15) {
  const Constraints two{PointAt(0, 0, 0.5, 0.5, 5),
                        PointAt(4, 0, 0.95, 0.125, 3)};
  // Only the first one, then both, then only the second one.
  EXPECT_FLOAT_EQ(ValueAt(two, 0.5, 0), F(0.8 + One(0.5, 0.5, 0.5)));
  EXPECT_FLOAT_EQ(ValueAt(two, 3, 1),
                  F(0.8 + One(0.5, 0.5, 4) / 2 + One(0.95, 0.125, 2) / 2));
  EXPECT_FLOAT_EQ(ValueAt(two, 6, 0), F(0.8 + One(0.95, 0.125, 2)));
  // Equal sources in one place are as one.
  const Constraints same(3, PointAt(0, 0, 0.5, 0, 5));
  EXPECT_FLOAT_EQ(ValueAt(same, 1, 1), 0.5f);
}

TEST(ConstraintFieldTest, TheNormShapesTheReach) {
  Constraints one{PointAt(0, 0, 0.5, 1, 5)};
  EXPECT_EQ(ValueAt(one, 3, 4), F(0.8));
  one[0].norm = DistanceNorm::kL2;
  EXPECT_FLOAT_EQ(ValueAt(one, 3, 4), F(0.8 + One(0.5, 1, 5)));
}

TEST(ConstraintFieldTest, ASmoothEdgeFadesToNothing) {
  Constraints one{PointAt(0, 0, 0.5, 0, 4)};
  one[0].edge = ReachEdge::kSmooth;
  EXPECT_FLOAT_EQ(ValueAt(one, 0, 0), 0.5f);
  EXPECT_FLOAT_EQ(ValueAt(one, 2, 0), F(0.8 - 0.3 * 0.75 * 0.75));
  EXPECT_FLOAT_EQ(ValueAt(one, 4, 0), F(0.8));
}

TEST(ConstraintFieldTest, ASmoothSourceDoesNotWeakenOthersWhereItBegins) {
  Constraints two{PointAt(0, 0, 0.5, 0, 20), PointAt(10, 0, 0.9, 0, 4)};
  const auto step_at_border = [&] {
    return std::fabs(ValueAt(two, 6.001, 0) - ValueAt(two, 5.999, 0));
  };
  EXPECT_GT(step_at_border(), 0.1f);  // eq. 15: M jumps from 1 to 2
  two[1].edge = ReachEdge::kSmooth;
  EXPECT_LT(step_at_border(), 1e-5f);
  EXPECT_FLOAT_EQ(ValueAt(two, 10, 0), F(0.8 + (0.5 - 0.8 + 0.9 - 0.8) / 2));
}

TEST(ConstraintFieldTest, LinesAndAreas) {
  ContinuousConstraint line = PointAt(0, 0, 0.5, 1, 3);
  line.kind = SourceKind::kPolyline;
  line.vertices = {{0, 0}, {10, 0}};
  EXPECT_FLOAT_EQ(ValueAt({line}, 7, 2), F(0.8 + One(0.5, 1, 2)));
  EXPECT_FLOAT_EQ(ValueAt({line}, 11, 1), F(0.8 + One(0.5, 1, 2)));

  ContinuousConstraint area = line;
  area.kind = SourceKind::kPolygon;
  area.vertices = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  EXPECT_FLOAT_EQ(ValueAt({area}, 5, 5), 0.5f);
  EXPECT_FLOAT_EQ(ValueAt({area}, 12, 5), F(0.8 + One(0.5, 1, 2)));
  EXPECT_EQ(ValueAt({area}, 14, 5), F(0.8));
}

TEST(ConstraintFieldTest, OnALineOnlyXCounts) {
  ContinuousConstraint interval = PointAt(0, 0, 0.5, 1, 3);
  interval.kind = SourceKind::kPolyline;
  interval.vertices = {{8, 50}, {4, -1e6}};
  EXPECT_FLOAT_EQ(ValueAt({interval}, 5, 0, 1), 0.5f);
  EXPECT_FLOAT_EQ(ValueAt({interval}, 10, 123, 1), F(0.8 + One(0.5, 1, 2)));
  EXPECT_EQ(ValueAt({interval}, 11.5, 0, 1), F(0.8));
}

TEST(ConstraintFieldTest, TakesOnlyItsQuantity) {
  Constraints constraints{PointAt(0, 0, 0.5, 0, 5), PointAt(0, 0, 9, 0, 5)};
  constraints[1].quantity = ConstraintQuantity::kFidelity;
  EXPECT_FLOAT_EQ(ValueAt(constraints, 0, 0), 0.5f);
  const ConstraintField fidelity(constraints, ConstraintQuantity::kFidelity, 1,
                                 2);
  EXPECT_FLOAT_EQ(Evaluate(fidelity, GridOf({0}, {0}))[0], 9.0f);
  EXPECT_EQ(fidelity.minimum(), 1.0f);
  EXPECT_EQ(fidelity.maximum(), 9.0f);
}

TEST(ConstraintFieldTest, SaysWhenNothingReaches) {
  const ConstraintField none({}, ConstraintQuantity::kRoughness, 0.7, 2);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.background(), 0.7f);
  float out = -1;
  EXPECT_FALSE(none.Evaluate(GridOf({0}, {0}), &out, 1));

  const Constraints one{PointAt(0, 0, 0.5, 1, 5)};
  const ConstraintField field(one, ConstraintQuantity::kRoughness, 0.7, 2);
  EXPECT_FALSE(field.empty());
  EXPECT_FALSE(field.Evaluate(GridOf({6}, {0}), &out, 1));
  // In the box of the reach, not in its diamond.
  EXPECT_FALSE(field.Evaluate(GridOf({4}, {4}), &out, 1));
  EXPECT_EQ(out, -1);
  EXPECT_TRUE(field.Evaluate(GridOf({4}, {1}), &out, 1));
}

// 10,000 sources of every kind over 1000 x 1000.
Constraints ManySources(double reach) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> place(0, 1000);
  std::uniform_real_distribution<double> size(-5, 5);
  std::uniform_real_distribution<double> share(0, 1);
  Constraints constraints;
  for (int n = 0; n < 10'000; ++n) {
    ContinuousConstraint constraint =
        PointAt(place(random), place(random), 0.5 + 0.45 * share(random),
                share(random), reach * (0.5 + share(random)));
    constraint.norm = n % 2 == 0 ? DistanceNorm::kL1 : DistanceNorm::kL2;
    constraint.edge = n % 3 == 0 ? ReachEdge::kSmooth : ReachEdge::kStep;
    constraint.kind = static_cast<SourceKind>(n % 4 == 3 ? 2 : n % 4 == 2);
    for (int k = 0; constraint.kind != SourceKind::kPoint && k < 3; ++k) {
      const Point2 last = constraint.vertices.back();
      constraint.vertices.push_back(
          {last.x + size(random), last.y + size(random)});
    }
    constraints.push_back(constraint);
  }
  return constraints;
}

TEST(ConstraintFieldTest, ManySourcesAgreeWithEachOnItsOwn) {
  Constraints constraints = ManySources(12);
  // A smooth source's share of M does not show in its value alone.
  for (ContinuousConstraint& constraint : constraints) {
    constraint.edge = ReachEdge::kStep;
  }
  const ConstraintField all(constraints, ConstraintQuantity::kRoughness,
                            kBackground, 2);
  std::vector<ConstraintField> alone;
  for (const ContinuousConstraint& constraint : constraints) {
    alone.emplace_back(std::span(&constraint, 1),
                       ConstraintQuantity::kRoughness, kBackground, 2);
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-20, 1020);
  int overlaps = 0;
  for (int n = 0; n < 60; ++n) {
    const SampleGrid here = GridOf({place(random)}, {place(random)});
    double sum = 0;
    int reached = 0;
    for (const ConstraintField& field : alone) {
      float value = 0;
      if (!field.Evaluate(here, &value, 1)) continue;
      sum += static_cast<double>(value) - kBackground;
      ++reached;
    }
    const double expected = kBackground + (reached > 0 ? sum / reached : 0);
    EXPECT_NEAR(Evaluate(all, here)[0], expected, 1e-6);
    overlaps += reached > 1;
  }
  EXPECT_GT(overlaps, 30);
}

TEST(ConstraintFieldTest, EveryWayThroughTheSourcesGivesTheSameBits) {
  const Constraints constraints = ManySources(12);
  const ConstraintField field(constraints, ConstraintQuantity::kRoughness,
                              kBackground, 2);
  // So fine a grid goes by source; its rows cut out and every 40th sample of
  // it, with far more sources than samples, go by sample.
  const std::size_t side = 121;
  const SampleGrid fine = GridOf(Axis(-10, 8.5, side), Axis(1015, -8.5, side));
  const std::vector<float> all = Evaluate(field, fine);
  std::size_t reached = 0;
  const std::size_t step = 40;
  SampleGrid coarse;
  for (std::size_t i = 0; i < side; i += step) {
    coarse.x.push_back(fine.x[i]);
    coarse.y.push_back(fine.y[i]);
  }
  const std::vector<float> few = Evaluate(field, coarse);
  for (std::size_t j = 0; j < coarse.y.size(); ++j) {
    for (std::size_t i = 0; i < coarse.x.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(few[j * coarse.x.size() + i]),
                std::bit_cast<std::uint32_t>(all[j * step * side + i * step]));
    }
  }
  for (std::size_t j = 0; j < side; j += 7) {
    const std::vector<float> row = Evaluate(field, GridOf(fine.x, {fine.y[j]}));
    for (std::size_t i = 0; i < side; ++i) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(row[i]),
                std::bit_cast<std::uint32_t>(all[j * side + i]));
      reached += row[i] != field.background();
    }
  }
  EXPECT_GT(reached, 1000u);
}

TEST(ConstraintFieldTest, ValuesStayInTheRangeItTells) {
  const Constraints constraints = ManySources(40);
  const ConstraintField field(constraints, ConstraintQuantity::kRoughness,
                              kBackground, 2);
  for (const float value :
       Evaluate(field, GridOf(Axis(100, 1.7, 60), Axis(100, 1.3, 60)))) {
    EXPECT_GE(value, field.minimum());
    EXPECT_LE(value, field.maximum());
  }
}

}  // namespace
}  // namespace terrane::core
