#include "core/surface/validate_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/field_checks.h"

namespace terrane::core {
namespace {

// They keep every intermediate result finite in single precision: 64 x 64
// weights times coordinates, and squares of those.
constexpr Range kPositions{-1e9, 1e9};
constexpr Range kWeights{-1e6, 1e6};
constexpr Range kLearningRates{0, 1e6, true, false};
constexpr int kMaxIterations = 1'000'000;
// The largest net has so many.
constexpr std::size_t kMostPoints =
    std::size_t{Basis::kMaxCount} * Basis::kMaxCount;

void CheckPoint(const Path& path, const Point3& point, FieldChecks* checks) {
  checks->Number(path.Field("x"), point.x, kPositions);
  checks->Number(path.Field("y"), point.y, kPositions);
  checks->Number(path.Field("z"), point.z, kPositions);
}

// `sides_good`: the net's columns and rows are in their ranges.
void CheckDegree(const Path& path, const PointNet& net, bool sides_good,
                 FieldChecks* checks) {
  if (!HasDegree(net.basis)) return;
  const bool good =
      checks->Integer(path, net.degree, 1, Basis::kMaxBSplineDegree);
  if (!good || !sides_good) return;
  const int fewest = std::min(net.columns, net.rows);
  if (net.degree >= fewest) {
    checks->Violate(path, "must be below the number of control points, " +
                              std::to_string(fewest) + ", got " +
                              std::to_string(net.degree));
  }
}

// Whether the net's columns and rows are in their ranges.
bool CheckNet(const Path& path, const PointNet& net, FieldChecks* checks) {
  const bool columns_good =
      checks->Integer(path.Field("columns"), net.columns, 2, Basis::kMaxCount);
  const bool rows_good =
      checks->Integer(path.Field("rows"), net.rows, 2, Basis::kMaxCount);
  const bool sides_good = columns_good && rows_good;
  CheckDegree(path.Field("degree"), net, sides_good, checks);
  if (sides_good) {
    const std::size_t expected = static_cast<std::size_t>(net.columns) *
                                 static_cast<std::size_t>(net.rows);
    if (net.points.size() != expected) {
      checks->Violate(path.Field("points"),
                      "must have rows * columns = " + std::to_string(expected) +
                          " elements, got " +
                          std::to_string(net.points.size()));
    }
  }
  const std::size_t count = std::min(net.points.size(), kMostPoints);
  for (std::size_t k = 0; k < count; ++k) {
    CheckPoint(path.Element("points", k), net.points[k], checks);
  }
  return sides_good;
}

// The weights of a network: w_ij, w_i (rows = 0) or w_j (columns = 0).
struct WeightShape {
  int columns;
  int rows;
};

// One half of a selector, on an axis of `count` weights; none when it is 0.
void CheckSelector(const Path& index_path, std::optional<int> index,
                   const Path& slope_path, double slope, int count,
                   FieldChecks* checks) {
  if (count > 0) {
    if (index.has_value()) checks->Integer(index_path, *index, 0, count - 1);
    checks->Number(slope_path, slope, kWeights);
    return;
  }
  if (index.has_value()) {
    checks->Violate(index_path,
                    "must not be set: the network has no such axis");
  }
  if (slope != 0) {
    checks->Violate(
        slope_path,
        "must be 0: the network has no such axis, got " + NumberText(slope));
  }
}

void CheckNetwork(const Path& path, const Network& network,
                  const WeightShape& shape, bool carry_over,
                  FieldChecks* checks) {
  if (checks->Count(path.Field("weights"), network.weights.size(), 0,
                    kMaxWeightRules)) {
    for (std::size_t k = 0; k < network.weights.size(); ++k) {
      const WeightRule& rule = network.weights[k];
      const Path rule_path = path.Element("weights", k);
      CheckSelector(rule_path.Field("i"), rule.i, rule_path.Field("slope_i"),
                    rule.slope_i, shape.columns, checks);
      CheckSelector(rule_path.Field("j"), rule.j, rule_path.Field("slope_j"),
                    rule.slope_j, shape.rows, checks);
      checks->Number(rule_path.Field("offset"), rule.offset, kWeights);
      checks->Number(rule_path.Field("random"), rule.random, kWeights);
      if (rule.redraw && !carry_over) {
        checks->Violate(rule_path.Field("redraw"), "needs carry_over");
      }
    }
  }
  checks->Number(path.Field("desired"), network.desired, kWeights);
  checks->Number(path.Field("desired_random"), network.desired_random,
                 kWeights);
}

// The largest |x|^2 that a network of the surface sees.
double LargestInput(const SurfaceSpec& spec) {
  const PointNet& net = spec.net;
  const double along_t =
      Basis::Of(net.basis, net.columns, net.degree).LargestSquaredSum();
  const double along_u =
      Basis::Of(net.basis, net.rows, net.degree).LargestSquaredSum();
  if (spec.method == SurfaceMethod::kProducts) return along_t * along_u;
  return HasNetworkU(spec.method) ? std::max(along_t, along_u) : along_t;
}

void CheckTraining(const Path& path, const SurfaceSpec& spec, bool net_good,
                   FieldChecks* checks) {
  const Training& training = *spec.training;
  checks->Integer(path.Field("iterations"), training.iterations, 0,
                  kMaxIterations);
  if (training.iterations == 0) return;
  const Path rate = path.Field("learning_rate");
  if (!checks->Number(rate, training.learning_rate, kLearningRates)) return;
  if (!net_good) return;
  const double input = LargestInput(spec);
  if (training.learning_rate * input >= 1) {
    checks->Violate(rate, "diverges: must be below 1 / max |x|^2 = " +
                              NumberText(1 / input) + ", got " +
                              NumberText(training.learning_rate));
  }
}

void CheckDirection(const Path& path, const Point3& direction,
                    FieldChecks* checks) {
  CheckPoint(path, direction, checks);
  const double longest = std::max(
      {std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  // Shorter ones have no exact length in double precision.
  if (longest < 1e-100) {
    checks->Violate(path, "must not be the zero vector");
  }
}

// Whether the curve through `steps`, the steps between neighbouring control
// values, rises everywhere. B-splines and Bezier curves rise when their control
// values do; a Hermite cell does when, besides, no tangent is above 3 steps
// (Fritsch and Carlson's condition).
bool Rises(SplineBasis basis, const std::vector<double>& steps) {
  if (std::any_of(steps.begin(), steps.end(),
                  [](double step) { return !(step > 0); })) {
    return false;
  }
  if (basis != SplineBasis::kBicubicHermite) return true;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const double tangent = 0.5 * (steps[k - 1] + steps[k]);
    if (tangent > 3 * std::min(steps[k - 1], steps[k])) return false;
  }
  return true;
}

}  // namespace

void ValidateSurface(const SurfaceSpec& spec, const std::string& prefix,
                     Violations* violations) {
  const Path root(&prefix);
  FieldChecks checks(violations);
  const std::size_t before = violations->total();
  const PointNet& net = spec.net;
  const bool sides_good = CheckNet(root.Field("net"), net, &checks);
  const bool net_good = sides_good && violations->total() == before;
  // What the largest net has not, no net has.
  const int columns = sides_good ? net.columns : Basis::kMaxCount;
  const int rows = sides_good ? net.rows : Basis::kMaxCount;
  const bool products = spec.method == SurfaceMethod::kProducts;
  CheckNetwork(root.Field("network"), spec.network,
               {columns, products ? rows : 0}, spec.carry_over, &checks);
  if (HasNetworkU(spec.method)) {
    CheckNetwork(root.Field("network_u"), spec.network_u, {0, rows},
                 spec.carry_over, &checks);
  }
  if (spec.training.has_value()) {
    CheckTraining(root.Field("training"), spec, net_good, &checks);
  }
  CheckDirection(root.Field("direction"), spec.direction, &checks);
  checks.Number(root.Field("hole_level"), spec.hole_level, Range{-1e30, 1e30});
}

void ValidateHeightField(const SurfaceSpec& spec, const std::string& prefix,
                         Violations* violations) {
  const Path root(&prefix);
  FieldChecks checks(violations);
  const Point3& direction = spec.direction;
  if (direction.x != 0 || direction.y != 0 || !(direction.z > 0)) {
    checks.Violate(root.Field("direction"),
                   "must be +z for a height field: only then x and y stay "
                   "where the net puts them");
  }
  const PointNet& net = spec.net;
  const Path net_path = root.Field("net");
  for (int j = 0; j < net.rows; ++j) {
    for (int i = 0; i < net.columns; ++i) {
      const Path point = net_path.Element(
          "points", static_cast<std::size_t>(j * net.columns + i));
      if (net.At(i, j).x != net.At(i, 0).x) {
        checks.Violate(point.Field("x"), "must be that of its column, " +
                                             NumberText(net.At(i, 0).x) +
                                             ", for a height field, got " +
                                             NumberText(net.At(i, j).x));
      }
      if (net.At(i, j).y != net.At(0, j).y) {
        checks.Violate(point.Field("y"), "must be that of its row, " +
                                             NumberText(net.At(0, j).y) +
                                             ", for a height field, got " +
                                             NumberText(net.At(i, j).y));
      }
    }
  }
  std::vector<double> steps_x;
  std::vector<double> steps_y;
  for (int i = 1; i < net.columns; ++i) {
    steps_x.push_back(net.At(i, 0).x - net.At(i - 1, 0).x);
  }
  for (int j = 1; j < net.rows; ++j) {
    steps_y.push_back(net.At(0, j).y - net.At(0, j - 1).y);
  }
  if (!Rises(net.basis, steps_x)) {
    checks.Violate(net_path.Field("points"),
                   "fold over: x must rise along every row for a height field");
  }
  if (!Rises(net.basis, steps_y)) {
    checks.Violate(
        net_path.Field("points"),
        "fold over: y must rise along every column for a height field");
  }
}

}  // namespace terrane::core
