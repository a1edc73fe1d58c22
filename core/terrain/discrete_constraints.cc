#include "core/terrain/discrete_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

// The coarsest level whose spacing is at most `radius`; above kMaxLevel when
// none is.
int LevelForRadius(double spacing, double radius) {
  int level = 0;
  while (level <= kMaxLevel && std::ldexp(spacing, -level) > radius) ++level;
  return level;
}

// Index of the level's lattice point nearest to `position`.
double Nearest(double position, double origin, double spacing, int level) {
  return std::nearbyint(std::ldexp((position - origin) / spacing, level));
}

struct Filed {
  int level;
  LatticePoint point;
};

// The same point at the level where it first appears.
Filed FirstAppearance(int level, LatticePoint point) {
  while (level > 0 && point.x % 2 == 0 && point.y % 2 == 0) {
    point = {point.x / 2, point.y / 2};
    --level;
  }
  return {level, point};
}

}  // namespace

absl::StatusOr<int> DiscreteLevel(const DiscreteConstraint& constraint,
                                  std::size_t index, const Frame& frame,
                                  int dimensions) {
  if (constraint.level) return *constraint.level;
  const double spacing = dimensions == 2 ? std::max(std::fabs(frame.spacing_x),
                                                    std::fabs(frame.spacing_y))
                                         : std::fabs(frame.spacing_x);
  const int level =
      LevelForRadius(spacing, constraint.radius.value_or(spacing));
  if (level <= kMaxLevel) return level;
  return ViolationError(
      "discrete_constraints[" + std::to_string(index) + "].radius",
      "must be at least the spacing of level " + std::to_string(kMaxLevel) +
          ", " + NumberText(std::ldexp(spacing, -kMaxLevel)) + ", got " +
          NumberText(*constraint.radius));
}

absl::StatusOr<DiscreteConstraints> DiscreteConstraints::Create(
    const TerrainSpec& spec, const Frame& frame) {
  const bool plane = spec.dimensions == 2;
  std::vector<std::vector<LatticePoint>> by_level;
  Violations violations;
  for (std::size_t k = 0; k < spec.discrete_constraints.size(); ++k) {
    const DiscreteConstraint& constraint = spec.discrete_constraints[k];
    const absl::StatusOr<int> chosen =
        DiscreteLevel(constraint, k, frame, spec.dimensions);
    if (!chosen.ok()) {
      for (const Violation& v : ViolationsOf(chosen.status())) {
        violations.Add(v.field, v.description);
      }
      continue;
    }
    const int level = *chosen;
    const double x =
        Nearest(constraint.point.x, frame.origin_x, frame.spacing_x, level);
    const double y = plane ? Nearest(constraint.point.y, frame.origin_y,
                                     frame.spacing_y, level)
                           : 0;
    const auto limit = static_cast<double>(kMaxIndex);
    if (!(std::fabs(x) <= limit && std::fabs(y) <= limit)) {
      violations.Add("discrete_constraints[" + std::to_string(k) + "]",
                     "must lie within 2^52 lattice steps of index 0 at "
                     "level " +
                         std::to_string(level));
      continue;
    }
    const Filed filed = FirstAppearance(
        level, {static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)});
    const auto slot = static_cast<std::size_t>(filed.level);
    if (by_level.size() <= slot) by_level.resize(slot + 1);
    by_level[slot].push_back(filed.point);
  }
  if (!violations.empty()) return violations.ToStatus();

  DiscreteConstraints result;
  for (std::vector<LatticePoint>& points : by_level) {
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
      return std::pair(a.y, a.x) < std::pair(b.y, b.x);
    });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<Box> boxes;
    for (const LatticePoint& p : points) {
      const auto x = static_cast<double>(p.x);
      const auto y = static_cast<double>(p.y);
      boxes.push_back({x, y, x, y});
    }
    result.levels_.push_back({std::move(points), BoxIndex(boxes)});
  }
  return result;
}

void DiscreteConstraints::Find(int level, const Window& window,
                               std::vector<LatticePoint>* points) const {
  const auto slot = static_cast<std::size_t>(level);
  if (slot >= levels_.size() || levels_[slot].points.empty()) return;
  std::vector<std::uint32_t> found;
  levels_[slot].index.Query(
      {static_cast<double>(window.x), static_cast<double>(window.y),
       static_cast<double>(window.x + window.width - 1),
       static_cast<double>(window.y + window.height - 1)},
      std::numeric_limits<std::size_t>::max(), &found);
  for (const std::uint32_t id : found) {
    points->push_back(levels_[slot].points[id]);
  }
}

}  // namespace terrane::core
