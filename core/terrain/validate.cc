#include "core/terrain/validate.h"

#include <cstdint>
#include <string>
#include <variant>

#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kMaxCells = std::int64_t{1} << 20;
constexpr Range kSigmas{0, 1e6, true, false};
constexpr Range kDeltas{0, 1, true, false};
constexpr Range kSoftLimits{0, 1e9, true, false};
constexpr Range kSpacings{-1e12, 1e12};
// Finer than any ground, coarse enough to divide by.
constexpr double kLeastSpacing = 1e-12;

const char* SourceName(FractalSource source) {
  switch (source) {
    case FractalSource::kMidpoint:
      return "MIDPOINT";
    case FractalSource::kSuccessive:
      return "SUCCESSIVE";
    case FractalSource::kSubdivision:
      return "SUBDIVISION";
  }
  return "UNKNOWN";
}

void ValidateSpacing(const Path& path, double spacing, SpecChecks* checks) {
  if (!checks->Number(path, spacing, kSpacings)) return;
  if (spacing < kLeastSpacing && spacing > -kLeastSpacing) {
    checks->Violate(path, "must be at least " + NumberText(kLeastSpacing) +
                              " in size, got " + NumberText(spacing));
  }
}

void ValidateDomain(const Path& path, const Domain& domain,
                    SpecChecks* checks) {
  checks->Integer(path.Field("cells_x"), domain.cells_x, 1, kMaxCells);
  if (checks->dimensions() == 2) {
    checks->Integer(path.Field("cells_y"), domain.cells_y, 1, kMaxCells);
  }
}

// The raster that a refinement refines; nothing, with violations, when the
// macro shape is not the one raster part that a refinement takes.
const Raster* RefinedRaster(const Path& path, const MacroSpec& macro,
                            SpecChecks* checks) {
  if (macro.base != 0) {
    checks->Violate(path.Field("base"), "must be 0 with a refinement, got " +
                                            NumberText(macro.base));
  }
  const RasterShape* shape =
      macro.parts.size() == 1
          ? std::get_if<RasterShape>(&macro.parts.front().shape)
          : nullptr;
  if (shape == nullptr) {
    checks->Violate(
        path.Field("parts"),
        "must be one raster part with a refinement, got " +
            std::to_string(macro.parts.size()) +
            (macro.parts.size() == 1 ? " part of another shape" : " parts"));
    return nullptr;
  }
  const Path part = path.Element("parts", 0);
  if (macro.parts.front().combine != MacroCombine::kAdd) {
    checks->Violate(part.Field("combine"), "must be ADD with a refinement");
  }
  const Path raster = part.Field("raster");
  if (shape->interpolation == Interpolation::kBSpline) {
    checks->Violate(raster.Field("interpolation"),
                    "must be BILINEAR or CATMULL_ROM with a refinement, got "
                    "BSPLINE");
  }
  return shape->raster.get();
}

// A refinement's lattice is the model's: what the recipe says of it must agree.
void ValidateRefinedLattice(const Path& root, const TerrainSpec& spec,
                            const Raster& raster, SpecChecks* checks) {
  const Domain posts{raster.width - 1, raster.height - 1};
  if (posts.cells_x > kMaxCells || posts.cells_y > kMaxCells) {
    const Path macro = root.Field("macro");
    const Path part = macro.Element("parts", 0);
    checks->Violate(part.Field("raster"),
                    "must have at most " + std::to_string(kMaxCells + 1) +
                        " posts a side with a refinement, got " +
                        std::to_string(raster.width) + " x " +
                        std::to_string(raster.height));
  }
  if (spec.domain.has_value() && *spec.domain != posts) {
    checks->Violate(root.Field("domain"),
                    "must be the cells of the refined raster, " +
                        std::to_string(posts.cells_x) + " x " +
                        std::to_string(posts.cells_y) + ", got " +
                        std::to_string(spec.domain->cells_x) + " x " +
                        std::to_string(spec.domain->cells_y));
  }
  if (spec.frame.has_value() && *spec.frame != raster.frame) {
    checks->Violate(root.Field("frame"),
                    "must be the frame of the refined raster, or not be set");
  }
}

void ValidateRefinement(const Path& root, const TerrainSpec& spec,
                        SpecChecks* checks) {
  if (spec.dimensions == 1) {
    checks->Violate(root.Field("dimensions"),
                    "must be 2 with a refinement, got 1");
  }
  if (spec.source != FractalSource::kSubdivision) {
    checks->Violate(root.Field("source"),
                    std::string("must be SUBDIVISION with a refinement, got ") +
                        SourceName(spec.source));
  }
  if (spec.mapping != HeightMapping::kLinear) {
    checks->Violate(root.Field("mapping"),
                    "must be LINEAR with a refinement, got BOLTZMANN");
  }
  const Raster* raster = RefinedRaster(root.Field("macro"), spec.macro, checks);
  if (raster != nullptr) ValidateRefinedLattice(root, spec, *raster, checks);
}

void ValidateDiscreteMethod(const Path& root, const TerrainSpec& spec,
                            SpecChecks* checks) {
  if (spec.discrete_method != DiscreteMethod::kBuffer) return;
  const Path path = root.Field("discrete_method");
  if (spec.source != FractalSource::kMidpoint) {
    checks->Violate(path, std::string("must be CONDITION with source ") +
                              SourceName(spec.source) + ", got BUFFER");
  } else if (!spec.spots.empty()) {
    checks->Violate(path, "must be CONDITION with spot heights, got BUFFER");
  }
}

}  // namespace

void ValidateFrame(const Path& path, const Frame& frame, SpecChecks* checks) {
  checks->Number(path.Field("origin_x"), frame.origin_x, kCoordinates);
  checks->Number(path.Field("origin_y"), frame.origin_y, kCoordinates);
  ValidateSpacing(path.Field("spacing_x"), frame.spacing_x, checks);
  ValidateSpacing(path.Field("spacing_y"), frame.spacing_y, checks);
}

void ValidateSpec(const TerrainSpec& spec, const SpecLimits& limits,
                  const std::string& prefix, Violations* violations) {
  const Path root(&prefix);
  SpecChecks checks(limits, spec.dimensions == 1 ? 1 : 2, violations);
  checks.Integer(root.Field("dimensions"), spec.dimensions, 1, 2);
  checks.Number(root.Field("roughness"), spec.roughness, kRoughnesses);
  checks.Number(root.Field("fidelity"), spec.fidelity, kFidelities);
  checks.Number(root.Field("sigma"), spec.sigma, kSigmas);
  checks.Number(root.Field("delta"), spec.delta, kDeltas);
  checks.Number(root.Field("soft_limit"), spec.soft_limit, kSoftLimits);
  if (spec.domain.has_value()) {
    ValidateDomain(root.Field("domain"), *spec.domain, &checks);
  }
  if (spec.frame.has_value()) {
    ValidateFrame(root.Field("frame"), *spec.frame, &checks);
  }
  ValidateMacro(root.Field("macro"), spec.macro, &checks);
  if (spec.refinement.has_value()) ValidateRefinement(root, spec, &checks);
  ValidateDiscreteMethod(root, spec, &checks);
  ValidateDiscreteConstraints(root, spec, &checks);
  ValidateContinuousConstraints(root, spec, &checks);
  ValidateSpots(root, spec, &checks);
}

}  // namespace terrane::core
