// How large the random displacement of a lattice point is, by source, level and
// H. Pure functions in double; deterministic (no libm). Level 0 is the
// coarsest; a 2-D level has a centre step and an edge step.
#ifndef TERRANE_CORE_TERRAIN_DISPLACEMENT_H_
#define TERRANE_CORE_TERRAIN_DISPLACEMENT_H_

#include "core/terrain/terrain_spec.h"

namespace terrane::core {

// The two half steps of a 2-D level. A 1-D level has only kEdge.
enum class HalfStep { kCentre, kEdge };

// Prediction error variance of the Deslauriers-Dubuc stencil (16 points in 2-D,
// 4 on the line) for FBM with variogram |h|^(2H) / 2 at unit spacing:
// 2 sum w_i g(p_i) - sum sum w_i w_j g(p_i - p_j).
double SubdivisionPredictionError(double roughness, int dimensions);

// Standard deviation of P_fbm at level 0 for sigma = 1: 1, SUBDIVISION
// sqrt(1/2).
double Level0Deviation(FractalSource source);

// Standard deviation, for sigma = 1, of the displacement of a point that
// appears in half step `step` of level `level` (>= 1).
double DisplacementDeviation(FractalSource source, int dimensions,
                             double roughness, int level, HalfStep step);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_DISPLACEMENT_H_
