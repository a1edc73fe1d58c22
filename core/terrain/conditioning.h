// Exact conditioning: corrections to a few displacements that make P_fbm pass
// through given values, as the process itself would have.
//
// P is linear in independent displacements A: P(p_k) = sum_a w_ka A_a, with
// variances S. With G = W S W' (the covariance of P at the spots), nuggets N
// and drawn observation errors e, solve (G + N) x = P(p_k) + e_k - P_k; then A
// - S W' x is a draw from the conditional distribution of the process. The
// corrections -S W' x are few: those of the spots' ancestors.
//
// Threads: a pure function; it runs on the calling thread. Determinism: the
// same table everywhere. Memory: about 12 bytes for each ancestor that two
// spots share and 6 for each entry of the table.
//
// Source: Terrane's own; the identity is conditioning by kriging (Journel 1974,
// Hoffman & Ribak 1991) on the lattice of Tan & Chen 2003. docs/terrain.md,
// "Spot heights".
#ifndef TERRANE_CORE_TERRAIN_CONDITIONING_H_
#define TERRANE_CORE_TERRAIN_CONDITIONING_H_

#include <cstdint>
#include <span>

#include "absl/status/statusor.h"
#include "core/terrain/correction_table.h"
#include "core/terrain/deviation_model.h"
#include "core/terrain/preparation.h"
#include "core/terrain/spot_heights.h"

namespace terrane::core {

// The process that is conditioned; the lattice's own parameters.
struct ConditionedProcess {
  std::int64_t seed = 0;
  FractalSource source = FractalSource::kSubdivision;
  int dimensions = 2;
  Mirror mirror;
  bool flat_level0 = false;
  double roughness = 0.8;
  const DeviationModel* deviations = nullptr;
};

// Errors: CANCELLED; INVALID_ARGUMENT, naming rows, where a spot's P has no
// variance (a post of a refined model, a point that is not displaced) and
// another value than asked for, or where heights are so close together that the
// system cannot be solved in double precision.
absl::StatusOr<CorrectionTable> ConditionProcess(
    const ConditionedProcess& process, std::span<const Spot> spots,
    const Preparation& preparation);

// What conditioning takes, by the number of spots and their level.
PreparationCost ConditioningCost(FractalSource source, int dimensions,
                                 std::int64_t spots, int level);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_CONDITIONING_H_
