// What the validators of a TerrainSpec share: field paths that are spelled only
// when something is wrong, ranges that print themselves, and the checks on
// them.
//
// A check adds a violation and returns false when the value is out of range;
// NaN is in no range. Safe from any thread; a Violations object belongs to one.
#ifndef TERRANE_CORE_TERRAIN_SPEC_CHECKS_H_
#define TERRANE_CORE_TERRAIN_SPEC_CHECKS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/violations.h"
#include "core/terrain/terrain_spec.h"
#include "core/terrain/validate.h"

namespace terrane::core {

// A chain of field names that ends at the field in hand. It points at its
// parent, so a Path that has a name must have a parent that has one too:
//   const Path cone = part.Field("cone");
//   checks.Number(cone.Field("radius"), ...);
class Path {
 public:
  // `prefix` stands before the whole path and must outlive it.
  explicit Path(const std::string* prefix) : prefix_(prefix) {}

  Path Field(const char* name) const { return Path(this, name, std::nullopt); }
  // Element `index` of the repeated field `name`.
  Path Element(const char* name, std::size_t index) const {
    return Path(this, name, index);
  }

  // Such as "recipe.macro.parts[2].cone.radius" for the prefix "recipe.".
  std::string Text() const;

 private:
  Path(const Path* parent, const char* name, std::optional<std::size_t> index)
      : parent_(parent), name_(name), index_(index) {}

  const std::string* prefix_ = nullptr;  // of the root only
  const Path* parent_ = nullptr;
  const char* name_ = "";
  std::optional<std::size_t> index_;
};

// An interval of numbers; a bound that is open does not belong to it.
struct Range {
  double low = 0;
  double high = 0;
  bool open_low = false;
  bool open_high = false;

  bool Holds(double value) const;
  // Such as "(0, 1]".
  std::string Text() const;
};

// Ranges that several fields share. They keep every intermediate result finite:
// squared distances, slopes times distances, sums over all parts.
inline constexpr Range kHeights{-1e9, 1e9};
inline constexpr Range kCoordinates{-1e15, 1e15};
inline constexpr Range kLengths{0, 1e12, true, false};
inline constexpr Range kFidelities{0, 1e12};
inline constexpr Range kRoughnesses{0, 1, true, true};

// The shortest text that reads back as the same number.
std::string NumberText(double value);

// One validation in progress.
class SpecChecks {
 public:
  SpecChecks(const SpecLimits& limits, int dimensions, Violations* violations)
      : limits_(limits), dimensions_(dimensions), violations_(violations) {}

  const SpecLimits& limits() const { return limits_; }
  // 1 or 2.
  int dimensions() const { return dimensions_; }

  void Violate(const Path& path, std::string description);
  bool Number(const Path& path, double value, const Range& range);
  // The same, when there is a value at all.
  bool Number(const Path& path, std::optional<double> value,
              const Range& range);
  bool Integer(const Path& path, std::int64_t value, std::int64_t low,
               std::int64_t high);
  // A repeated field with `count` elements.
  bool Count(const Path& path, std::size_t count, std::size_t low,
             std::size_t high);
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
  Violations* const violations_;
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
void ValidatePlace(const Path& path, const Point2& point,
                   const TerrainSpec& spec, SpecChecks* checks);
// validate_constraints.cc: `discrete_constraints`, `continuous_constraints`.
void ValidateDiscreteConstraints(const Path& root, const TerrainSpec& spec,
                                 SpecChecks* checks);
void ValidateContinuousConstraints(const Path& root, const TerrainSpec& spec,
                                   SpecChecks* checks);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_SPEC_CHECKS_H_
