// From P_fbm to height: Tan & Chen 2003, eqs. 8-10 (BOLTZMANN), and LINEAR.
//
// P is for sigma = 1: sigma cancels out of both mappings.
//   BOLTZMANN  D = d + sign(P) sqrt(-2 T ln(1 - Z |P|)), |P| cut at sqrt(6),
//              Z = 1 / (sqrt(6) + delta)
//   LINEAR     D = d + u, u = sqrt(T) P; with a soft limit L,
//              u / sqrt(1 + (u / L)^2)
//
// Rows must have kRowSlack readable floats behind their last column (see
// lattice_kernels.h), `out` need not. Determinism: the same bits on every SIMD
// target; the logarithm is a polynomial of our own. Threads: pure functions.
#ifndef TERRANE_CORE_TERRAIN_MAPPING_KERNELS_H_
#define TERRANE_CORE_TERRAIN_MAPPING_KERNELS_H_

#include <cstddef>

#include "core/terrain/terrain_spec.h"

namespace terrane::core {

struct HeightMap {
  HeightMapping mapping = HeightMapping::kLinear;
  float inverse_soft_limit = 0;  // 1 / L, 0: none
  float z = 0;                   // Z
  float deviation = 0;           // sqrt(T) where fidelity is null
};

// One row: out[i] = D from fractal[i]; macro null means `macro_constant`,
// fidelity null means the uniform T of `map`. `out` may be `fractal`.
void MapRow(const HeightMap& map, const float* fractal, const float* macro,
            float macro_constant, const float* fidelity, int count, float* out);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_MAPPING_KERNELS_H_
