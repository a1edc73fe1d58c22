// TerrainSpec: everything that determines a terrain, as plain data.
//
// The C++ side of proto/terrane/v1/terrain_recipe.proto: same names, same
// units, same defaults; the proto's comments hold the ranges. Optional fields
// that are not set are filled in by Terrain::Create. A spec is only data:
// ValidateSpec (core/terrain/validate.h) says what is wrong with it,
// Terrain::Create refuses one that is not valid.
//
// Source: Tan & Chen, "A controllable fractal generation method based on FBM
// constraint model", Journal of Software 14(3), 2003.
#ifndef TERRANE_CORE_TERRAIN_TERRAIN_SPEC_H_
#define TERRANE_CORE_TERRAIN_TERRAIN_SPEC_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/grid/lattice_window.h"
#include "core/grid/raster.h"
#include "core/spline/basis.h"

namespace terrane::core {

// Revision of the terrain algorithm: the same spec and revision give the same
// bytes everywhere. New bytes need a new revision.
inline constexpr int kTerrainRevision = 1;

enum class FractalSource { kMidpoint, kSuccessive, kSubdivision };
enum class HeightMapping { kBoltzmann, kLinear };

struct Point2 {
  double x = 0;
  double y = 0;

  bool operator==(const Point2&) const = default;
};

// --- The macro shape d(p) ----------------------------------------------------

enum class Interpolation { kBilinear, kCatmullRom, kBSpline };

struct Plane {
  Point2 point;
  double height = 0;
  double slope_x = 0;
  double slope_y = 0;
};

struct Cone {
  Point2 centre;
  double radius = 0;
  double height = 0;
};

struct GaussianHill {
  Point2 centre;
  double sigma_x = 0;
  double sigma_y = 0;  // 0: the same as sigma_x
  double height = 0;
};

struct Ridge {
  std::vector<Point2> crest;
  double half_width = 0;
  double height = 0;
};

struct Boss {
  std::vector<Point2> outline;
  double flank_width = 0;
  double height = 0;
};

struct ControlNet {
  SplineBasis basis = SplineBasis::kBSplineClamped;
  int degree = 3;
  int columns = 0;
  int rows = 0;
  std::vector<double> heights;
  Point2 minimum;
  Point2 maximum;
};

struct RasterShape {
  std::shared_ptr<const Raster> raster;
  Interpolation interpolation = Interpolation::kCatmullRom;
};

struct Profile {
  std::vector<double> x;  // empty: equally spaced from first_x by step_x
  std::vector<double> heights;
  double first_x = 0;
  double step_x = 0;
  Interpolation interpolation = Interpolation::kBilinear;
};

enum class MacroCombine { kAdd, kMaximum, kMinimum };

struct MacroPart {
  MacroCombine combine = MacroCombine::kAdd;
  // monostate: no shape was given, which is a violation.
  std::variant<std::monostate, Plane, Cone, GaussianHill, Ridge, Boss,
               ControlNet, RasterShape, Profile>
      shape;
};

struct MacroSpec {
  double base = 0;
  std::vector<MacroPart> parts;
};

// --- Constraints ------------------------------------------------------------

struct DiscreteConstraint {
  Point2 point;
  std::optional<int> level;
  std::optional<double> radius;
};

// How P_fbm is brought to 0 at the discrete constraints: by the paper's region
// buffering, or as spot heights with z = d are met.
enum class DiscreteMethod { kBuffer, kCondition };

enum class ConstraintQuantity { kRoughness, kFidelity };
enum class DistanceNorm { kL1, kL2 };
enum class ReachEdge { kStep, kSmooth };
enum class SourceKind { kPoint, kPolyline, kPolygon };

struct ContinuousConstraint {
  ConstraintQuantity quantity = ConstraintQuantity::kRoughness;
  double target = 0;
  double falloff = 0;
  double reach = 0;
  DistanceNorm norm = DistanceNorm::kL1;
  ReachEdge edge = ReachEdge::kStep;
  SourceKind kind = SourceKind::kPoint;
  std::vector<Point2> vertices;
};

// --- Spot heights ------------------------------------------------------------

struct SpotHeight {
  Point2 point;
  double height = 0;
  double standard_error = 0;  // 0: met exactly

  bool operator==(const SpotHeight&) const = default;
};

struct SpotLine {
  std::vector<Point2> vertices;
  std::vector<double> heights;  // one a vertex; empty: the macro shape's
  double spacing = 0;           // 0: that of the spots' level
  double standard_error = 0;
  bool only_falls = false;
};

struct SpotHeights {
  std::vector<SpotHeight> points;
  std::shared_ptr<const std::vector<SpotHeight>> table;  // null: none
  std::vector<SpotLine> lines;
  std::optional<int> level;

  bool empty() const {
    return points.empty() && table == nullptr && lines.empty();
  }
};

// --- The whole --------------------------------------------------------------

struct Domain {
  std::int64_t cells_x = 0;
  std::int64_t cells_y = 0;

  bool operator==(const Domain&) const = default;
};

struct Refinement {
  bool uniform_amplitude = false;
};

struct TerrainSpec {
  int dimensions = 2;
  std::int64_t seed = 0;
  FractalSource source = FractalSource::kSubdivision;
  HeightMapping mapping = HeightMapping::kLinear;
  std::optional<double> roughness;
  std::optional<double> fidelity;
  std::optional<double> sigma;
  std::optional<double> delta;
  std::optional<double> soft_limit;
  std::optional<Domain> domain;
  std::optional<Frame> frame;
  MacroSpec macro;
  std::optional<Refinement> refinement;
  std::vector<DiscreteConstraint> discrete_constraints;
  std::optional<DiscreteMethod> discrete_method;
  std::vector<ContinuousConstraint> continuous_constraints;
  SpotHeights spots;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_TERRAIN_SPEC_H_
