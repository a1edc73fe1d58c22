#include "core/terrain/resolve.h"

#include <utility>
#include <variant>

#include "core/terrain/calibration.h"
#include "core/terrain/spot_heights.h"

namespace terrane::core {
namespace {

constexpr double kDefaultRoughness = 0.8;
constexpr double kDefaultFidelity = 1;
constexpr double kDefaultSigma = 1;
constexpr double kDefaultDelta = 1e-3;

absl::Status ResolveRefinement(ResolvedSpec* resolved) {
  TerrainSpec& spec = resolved->spec;
  const Raster& model =
      *std::get<RasterShape>(spec.macro.parts.front().shape).raster;
  spec.domain = Domain{model.width - 1, model.height - 1};
  spec.frame = model.frame;
  absl::StatusOr<Calibration> calibration =
      CalibrateRefinement(model, spec.roughness);
  if (!calibration.ok()) return calibration.status();
  spec.roughness = calibration->roughness;
  if (!spec.fidelity) spec.fidelity = calibration->fidelity;
  if (!spec.refinement->uniform_amplitude) {
    resolved->amplitude = std::move(calibration->amplitude);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ResolvedSpec> Resolve(TerrainSpec spec) {
  ResolvedSpec resolved = {std::move(spec), {}};
  TerrainSpec& out = resolved.spec;
  if (out.refinement) {
    const absl::Status status = ResolveRefinement(&resolved);
    if (!status.ok()) return status;
  }
  if (!out.roughness) out.roughness = kDefaultRoughness;
  if (!out.fidelity) out.fidelity = kDefaultFidelity;
  if (!out.sigma) out.sigma = kDefaultSigma;
  if (!out.delta) out.delta = kDefaultDelta;
  if (!out.frame) out.frame = Frame{};
  if (!out.spots.empty() && !out.spots.level) {
    out.spots.level = DefaultSpotLevel(out.spots, *out.frame, out.dimensions);
  }
  if (!out.discrete_constraints.empty()) {
    out.discrete_method = ConditionsDiscrete(out) ? DiscreteMethod::kCondition
                                                  : DiscreteMethod::kBuffer;
  }
  return resolved;
}

}  // namespace terrane::core
