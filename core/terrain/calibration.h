// Calibration of a refinement: how much detail an elevation model would have
// between its posts, judged from its own posts.
//
// The model's odd-odd posts are predicted from its even posts with the 4 x 4
// Deslauriers-Dubuc weights that SUBDIVISION uses. The local root mean square
// of that residual (7 x 7 box, then smoothed) is the amplitude map; how the
// residual scales between two levels of the model gives H. See docs/terrain.md,
// "Refining a real elevation model".
#ifndef TERRANE_CORE_TERRAIN_CALIBRATION_H_
#define TERRANE_CORE_TERRAIN_CALIBRATION_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "core/grid/raster.h"

namespace terrane::core {

struct Calibration {
  // H as measured, before it is cut; reported, not used. Above 1 for models
  // that were smoothed; 1 where nothing is left to measure (a plane); NaN when
  // the model is too small to measure and `roughness` was given.
  double measured_roughness = 0;
  // H to generate with: the measured one cut to [0.5, 0.95], or the one given.
  double roughness = 0;
  // Root mean square of the residual over the model, in height units.
  double residual_rms = 0;
  // T such that LINEAR's first centre displacements (level 1) have, on average,
  // the residual's mean square times 2^(-2 H).
  double fidelity = 0;
  // Relative amplitude at every post, root mean square 1 over the model; 0 only
  // where the model is flat. Same width and height as the model.
  std::vector<float> amplitude;
};

// `roughness`: H to use instead of the measured one. Errors: INVALID_ARGUMENT
// (field "macro.parts[0].raster") when the model has fewer than 8 x 8 posts or
// no data to judge from.
absl::StatusOr<Calibration> CalibrateRefinement(
    const Raster& model, std::optional<double> roughness);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_CALIBRATION_H_
