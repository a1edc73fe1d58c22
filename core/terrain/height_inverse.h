// From height back to P_fbm: which value of the process the mapping takes to a
// height (core/terrain/mapping_kernels.h for sigma = 1).
//
//   LINEAR     P = u / sqrt(T), with a soft limit L first u / sqrt(1 - (u/L)^2)
//   BOLTZMANN  P = sign(u) (1 - exp(-u^2 / (2 T))) / Z
// with u = D - d. Double precision, deterministic (no libm). Pure functions.
//
// Source: Tan & Chen 2003, eq. 10, solved for P_fbm.
#ifndef TERRANE_CORE_TERRAIN_HEIGHT_INVERSE_H_
#define TERRANE_CORE_TERRAIN_HEIGHT_INVERSE_H_

#include "core/terrain/mapping_kernels.h"

namespace terrane::core {

// Largest size of D - d that the mapping makes of any P, for the fidelity T;
// infinite when there is no bound.
double LargestDeviation(const HeightMap& map, double fidelity);

// P and its derivative by height.
struct FractalValue {
  double value = 0;
  double slope = 0;
};

// Needs T > 0 and |deviation| < LargestDeviation, or deviation = 0.
FractalValue FractalOfDeviation(const HeightMap& map, double fidelity,
                                double deviation);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_HEIGHT_INVERSE_H_
