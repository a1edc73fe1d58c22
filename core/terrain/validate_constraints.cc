#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/grid/lattice_window.h"
#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

constexpr Range kFalloffs{0, 1e12};

// World coordinates from the first to the last lattice point of an axis.
Range DomainRange(double origin, double spacing, std::int64_t cells) {
  const double end = origin + static_cast<double>(cells) * spacing;
  return {std::min(origin, end), std::max(origin, end)};
}

// What a source is made of, in the words of the recipe's oneof.
void ValidateSource(const Path& path, const ContinuousConstraint& constraint,
                    SpecChecks* checks) {
  const std::span<const Point2> vertices = constraint.vertices;
  const bool line = checks->dimensions() == 1;
  switch (constraint.kind) {
    case SourceKind::kPoint:
      if (vertices.size() == 1) {
        checks->Coordinates(path.Field("point"), vertices.front());
      } else {
        checks->Violate(path.Field("source"),
                        "must be a point, a polyline or a polygon, got none");
      }
      return;
    case SourceKind::kPolyline:
      checks->Vertices(path.Field("polyline"), vertices, 2);
      if (line && vertices.size() > 2) {
        const Path polyline = path.Field("polyline");
        checks->Violate(
            polyline.Field("vertices"),
            "must have 2 elements in a recipe of 1 dimension, got " +
                std::to_string(vertices.size()));
      }
      return;
    case SourceKind::kPolygon:
      checks->Vertices(path.Field("polygon"), vertices, 3);
      if (line) {
        checks->Violate(path.Field("polygon"),
                        "must be a point or a polyline in a recipe of 1 "
                        "dimension, got a polygon");
      }
      return;
  }
}

}  // namespace

bool ValidatePlace(const Path& path, const Point2& point,
                   const TerrainSpec& spec, SpecChecks* checks) {
  if (!checks->Coordinates(path, point)) return false;
  if (!spec.domain.has_value()) return true;
  const Frame frame = spec.frame.value_or(Frame{});
  bool good = checks->Number(
      path.Field("x"), point.x,
      DomainRange(frame.origin_x, frame.spacing_x, spec.domain->cells_x));
  if (checks->dimensions() == 2) {
    good &= checks->Number(
        path.Field("y"), point.y,
        DomainRange(frame.origin_y, frame.spacing_y, spec.domain->cells_y));
  }
  return good;
}

void ValidateDiscreteConstraints(const Path& root, const TerrainSpec& spec,
                                 SpecChecks* checks) {
  const std::size_t count = spec.discrete_constraints.size();
  if (!checks->Count(root.Field("discrete_constraints"), count, 0,
                     static_cast<std::size_t>(
                         checks->limits().max_discrete_constraints))) {
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const DiscreteConstraint& constraint = spec.discrete_constraints[i];
    const Path path = root.Element("discrete_constraints", i);
    ValidatePlace(path, constraint.point, spec, checks);
    if (constraint.level.has_value()) {
      checks->Integer(path.Field("level"), *constraint.level, 0, kMaxLevel);
    }
    checks->Number(path.Field("radius"), constraint.radius, kLengths);
  }
}

void ValidateContinuousConstraints(const Path& root, const TerrainSpec& spec,
                                   SpecChecks* checks) {
  const std::size_t count = spec.continuous_constraints.size();
  if (!checks->Count(root.Field("continuous_constraints"), count, 0,
                     static_cast<std::size_t>(
                         checks->limits().max_continuous_constraints))) {
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const ContinuousConstraint& constraint = spec.continuous_constraints[i];
    const Path path = root.Element("continuous_constraints", i);
    checks->Number(path.Field("target"), constraint.target,
                   constraint.quantity == ConstraintQuantity::kRoughness
                       ? kRoughnesses
                       : kFidelities);
    checks->Number(path.Field("falloff"), constraint.falloff, kFalloffs);
    checks->Number(path.Field("reach"), constraint.reach, kLengths);
    ValidateSource(path, constraint, checks);
  }
}

}  // namespace terrane::core
