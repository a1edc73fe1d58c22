// The hot loop of continuous constraints, in SIMD: the terms of eq. 15 (Tan &
// Chen 2003) over a row of samples.
//
// Doubles; no slack is needed behind a row. Determinism: IEEE operations in one
// order, so the same bits on every SIMD target. Threads: pure functions of
// their arguments.
#ifndef TERRANE_CORE_TERRAIN_CONSTRAINT_KERNELS_H_
#define TERRANE_CORE_TERRAIN_CONSTRAINT_KERNELS_H_

#include <cstddef>

namespace terrane::core {

// What a source puts into eq. 15.
struct SourceTerm {
  double difference = 0;    // F* - F0
  double falloff = 0;       // f_d
  double square_reach = 0;  // R^2
  // Its share is w = (1 - distance^2 / R^2)^2 instead of 1.
  bool smooth = false;
};

// Adds the source's term times its share to pulls[i], and its share to
// shares[i], for every sample whose squared distance is not infinity.
void AddSourceTerms(const SourceTerm& term, const double* squared_distances,
                    std::size_t count, double* pulls, double* shares);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_CONSTRAINT_KERNELS_H_
