// The hot loops of LineDistance, in SIMD.
//
// Doubles; no slack is needed behind a row. Determinism: IEEE operations in one
// order, so the same bits on every SIMD target. Threads: pure functions of
// their arguments.
#ifndef TERRANE_CORE_GRID_DISTANCE_KERNELS_H_
#define TERRANE_CORE_GRID_DISTANCE_KERNELS_H_

#include <cstddef>

namespace terrane::core {

// Lowers row[i] to the squared distance of a sample at x[i] to a point at
// point_x whose row is `gap` >= 0 away: L2, dx^2 + gap^2; L1, (|dx| + gap)^2.
void LowerToPointL2(const double* x, std::size_t count, double point_x,
                    double gap, double* row);
void LowerToPointL1(const double* x, std::size_t count, double point_x,
                    double gap, double* row);

// Makes what is above `limit` infinite.
void CutAbove(double limit, std::size_t count, double* row);

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_DISTANCE_KERNELS_H_
