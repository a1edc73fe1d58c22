// What the validators of a TerrainSpec share beyond core/base/field_checks.h:
// ranges, and checks on points and lists of vertices.
//
// Safe from any thread; a Violations object belongs to one.
#ifndef TERRANE_CORE_TERRAIN_SPEC_CHECKS_H_
#define TERRANE_CORE_TERRAIN_SPEC_CHECKS_H_

#include <cstddef>
#include <span>

#include "core/base/field_checks.h"
#include "core/base/violations.h"
#include "core/terrain/terrain_spec.h"
#include "core/terrain/validate.h"

namespace terrane::core {

// Ranges that several fields share. They keep every intermediate result finite:
// squared distances, slopes times distances, sums over all parts.
inline constexpr Range kHeights{-1e9, 1e9};
inline constexpr Range kCoordinates{-1e15, 1e15};
inline constexpr Range kLengths{0, 1e12, true, false};
inline constexpr Range kFidelities{0, 1e12};
inline constexpr Range kRoughnesses{0, 1, true, true};

// One validation in progress.
class SpecChecks : public FieldChecks {
 public:
  SpecChecks(const SpecLimits& limits, int dimensions, Violations* violations)
      : FieldChecks(violations), limits_(limits), dimensions_(dimensions) {}

  const SpecLimits& limits() const { return limits_; }
  // 1 or 2.
  int dimensions() const { return dimensions_; }

  // Coordinates x and, in a 2-D recipe, y.
  bool Coordinates(const Path& point, const Point2& value);
  // A list of at least `least` vertices and its coordinates; counts them
  // against the limit of the whole recipe before it looks at them.
  bool Vertices(const Path& path, std::span<const Point2> vertices,
                std::size_t least);
  // Counts `count` vertices against the limit of the whole recipe.
  bool SpendVertices(const Path& path, std::size_t count);

 private:
  const SpecLimits& limits_;
  const int dimensions_;
  std::size_t vertices_ = 0;
};

// The parts of ValidateSpec, by topic.

// validate.cc: a place of a lattice or of a raster in the world.
void ValidateFrame(const Path& path, const Frame& frame, SpecChecks* checks);
// validate_macro.cc: `macro` and its parts.
void ValidateMacro(const Path& path, const MacroSpec& macro,
                   SpecChecks* checks);
// validate_spots.cc: `spots`.
void ValidateSpots(const Path& root, const TerrainSpec& spec,
                   SpecChecks* checks);
// validate_constraints.cc: a point inside the domain, if there is one.
bool ValidatePlace(const Path& path, const Point2& point,
                   const TerrainSpec& spec, SpecChecks* checks);
// validate_constraints.cc: `discrete_constraints`, `continuous_constraints`.
void ValidateDiscreteConstraints(const Path& root, const TerrainSpec& spec,
                                 SpecChecks* checks);
void ValidateContinuousConstraints(const Path& root, const TerrainSpec& spec,
                                   SpecChecks* checks);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_SPEC_CHECKS_H_
