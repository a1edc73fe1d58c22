#include "core/grid/line_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using Vertex = LineDistance::Vertex;
using Form = LineDistance::Form;
using Norm = LineDistance::Norm;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SampleGrid GridAt(std::vector<double> x, std::vector<double> y) {
  SampleGrid grid;
  grid.x = std::move(x);
  grid.y = std::move(y);
  return grid;
}

std::vector<double> Axis(double first, double step, int count) {
  std::vector<double> axis;
  for (int i = 0; i < count; ++i) axis.push_back(first + step * i);
  return axis;
}

std::vector<double> All(const LineDistance& line, const SampleGrid& grid,
                        double reach = kInfinity) {
  std::vector<double> out(grid.x.size() * grid.y.size());
  line.Squared(grid, AllSamples(grid), reach, out.data());
  return out;
}

double One(const LineDistance& line, double x, double y) {
  return std::sqrt(All(line, GridAt({x}, {y}))[0]);
}

// The distance to a segment by looking at many of its points.
double SlowDistance(const std::vector<Vertex>& vertices, bool closed, Norm norm,
                    double x, double y) {
  double least = kInfinity;
  const std::size_t segments = vertices.size() - (closed ? 0 : 1);
  for (std::size_t k = 0; k < segments; ++k) {
    const Vertex& a = vertices[k];
    const Vertex& b = vertices[(k + 1) % vertices.size()];
    for (int step = 0; step <= 2000; ++step) {
      const double t = step / 2000.0;
      const double dx = std::fabs(x - a.x - t * (b.x - a.x));
      const double dy = std::fabs(y - a.y - t * (b.y - a.y));
      least = std::min(least, norm == Norm::kL1 ? dx + dy : std::hypot(dx, dy));
    }
  }
  return least;
}

TEST(LineDistanceTest, APoint) {
  const std::vector<Vertex> point{{3, 4}};
  EXPECT_EQ(One({point, Form::kPolyline, Norm::kL2, 2}, 0, 0), 5);
  EXPECT_EQ(One({point, Form::kPolyline, Norm::kL1, 2}, 0, 0), 7);
}

TEST(LineDistanceTest, AgreesWithManyPointsOfTheLine) {
  const std::vector<Vertex> line{{0, 0}, {4, 1}, {5, 5}, {5, 5}, {-2, 6}};
  for (const Norm norm : {Norm::kL1, Norm::kL2}) {
    const LineDistance distance(line, Form::kPolyline, norm, 2);
    for (double y = -3; y < 9; y += 1.37) {
      for (double x = -5; x < 9; x += 1.13) {
        EXPECT_NEAR(One(distance, x, y), SlowDistance(line, false, norm, x, y),
                    5e-3);
      }
    }
  }
}

TEST(LineDistanceTest, PolygonsAreFullByTheEvenOddRule) {
  // A pentagram: its middle is wound twice, so it is outside.
  std::vector<Vertex> star;
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * 2 * M_PI * k / 5 + M_PI / 2;
    star.push_back({10 * std::cos(angle), 10 * std::sin(angle)});
  }
  const LineDistance distance(star, Form::kPolygon, Norm::kL2, 2);
  EXPECT_EQ(One(distance, 0, 7), 0);
  EXPECT_NEAR(One(distance, 0, 0), SlowDistance(star, true, Norm::kL2, 0, 0),
              1e-3);
  EXPECT_GT(One(distance, 0, 0), 1);
  EXPECT_GT(One(distance, 9, 9), 1);
}

TEST(LineDistanceTest, APolygonsRowsThroughItsVerticesDoNotLeak) {
  const std::vector<Vertex> diamond{{0, -3}, {3, 0}, {0, 3}, {-3, 0}};
  const LineDistance distance(diamond, Form::kPolygon, Norm::kL1, 2);
  EXPECT_EQ(One(distance, 1, 0), 0);
  EXPECT_EQ(One(distance, 5, 0), 2);
  EXPECT_EQ(One(distance, -5, 0), 2);
  EXPECT_EQ(One(distance, 4, 3), 4);
}

TEST(LineDistanceTest, BeyondTheReachIsInfinite) {
  const std::vector<Vertex> point{{0, 0}};
  const LineDistance distance(point, Form::kPolyline, Norm::kL2, 2);
  const SampleGrid grid = GridAt({1, 2, 3}, {0});
  EXPECT_EQ(All(distance, grid, 2), (std::vector<double>{1, 4, kInfinity}));
}

TEST(LineDistanceTest, OnALineOnlyXCounts) {
  const std::vector<Vertex> vertices{{5, 100}, {2, -7}, {3, 1e9}};
  for (const Form form : {Form::kPolyline, Form::kPolygon}) {
    const LineDistance distance(vertices, form, Norm::kL1, 1);
    EXPECT_EQ(One(distance, 0, 55), 2);
    EXPECT_EQ(One(distance, 4, -1e12), 0);
    EXPECT_EQ(One(distance, 6.5, 0), 1.5);
  }
}

// A long random walk, so that leaving segments out matters.
std::vector<Vertex> Walk(int count) {
  std::mt19937 random(11);
  std::normal_distribution<double> step(0, 5);
  std::vector<Vertex> walk{{0, 0}};
  while (static_cast<int>(walk.size()) < count) {
    walk.push_back(
        {walk.back().x + step(random), walk.back().y + step(random)});
  }
  return walk;
}

TEST(LineDistanceTest, LeavingSegmentsOutChangesNoBit) {
  const std::vector<Vertex> walk = Walk(500);
  for (const Norm norm : {Norm::kL1, Norm::kL2}) {
    for (const Form form : {Form::kPolyline, Form::kPolygon}) {
      const LineDistance distance(walk, form, norm, 2);
      const SampleGrid grid =
          GridAt(Axis(-300, 13.7, 45), Axis(280, -11.3, 50));
      for (const double reach : {kInfinity, 20.0}) {
        const std::vector<double> all = All(distance, grid, reach);
        for (std::size_t j = 0; j < grid.y.size(); ++j) {
          for (std::size_t i = 0; i < grid.x.size(); ++i) {
            // One sample alone takes another way through the segments.
            EXPECT_EQ(
                all[j * grid.x.size() + i],
                All(distance, GridAt({grid.x[i]}, {grid.y[j]}), reach)[0]);
          }
        }
      }
    }
  }
}

TEST(LineDistanceTest, ARectangleIsACutOfTheWhole) {
  const std::vector<Vertex> walk = Walk(100);
  const LineDistance distance(walk, Form::kPolygon, Norm::kL2, 2);
  const SampleGrid grid = GridAt(Axis(-90, 4.1, 40), Axis(-80, 3.7, 50));
  const std::vector<double> all = All(distance, grid);
  const SampleRect rect{7, 31, 12, 44};
  std::vector<double> cut(rect.columns() * rect.rows());
  distance.Squared(grid, rect, kInfinity, cut.data());
  for (std::size_t j = 0; j < rect.rows(); ++j) {
    for (std::size_t i = 0; i < rect.columns(); ++i) {
      EXPECT_EQ(cut[j * rect.columns() + i], all[(j + 12) * 40 + i + 7]);
    }
  }
}

}  // namespace
}  // namespace terrane::core
