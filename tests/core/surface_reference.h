// The paper's surface, step by step: eqs. 1-6 with explicit LMS steps, in
// double precision, one sample at a time. What the generator is held to.
#ifndef TERRANE_TESTS_CORE_SURFACE_REFERENCE_H_
#define TERRANE_TESTS_CORE_SURFACE_REFERENCE_H_

#include <cstdint>
#include <vector>

#include "core/surface/surface.h"

namespace terrane::core {

struct ReferenceSample {
  Point3 position;
  // The size of the terms that the position is the sum of: what a relative
  // difference is relative to.
  double scale = 0;
  // w x of the trained network (of the second one: along u).
  double response = 0;
  double response_u = 0;
};

// One sample of a surface without carry-over; `steps` LMS steps at
// `learning_rate`.
ReferenceSample ReferenceAt(const SurfaceSpec& spec, const SurfaceGrid& grid,
                            std::int64_t it, std::int64_t iu, int steps,
                            double learning_rate);

// A 4 x 4 net with a hill, like the paper's figure 1: x and y from 0 to 3.
PointNet HillNet();

// A net of any size and kind over [0, columns - 1] x [0, rows - 1].
PointNet WavyNet(SplineBasis basis, int degree, int columns, int rows);

// Positions of a window, and the like; the request must be good.
std::vector<float> PositionsOf(const Surface& surface,
                               const SurfaceRequest& request);
std::vector<float> HeightsOf(const Surface& surface,
                             const SurfaceRequest& request);
std::vector<float> HeightsOf(const SurfaceSpec& spec, const SurfaceGrid& grid);
// The regular surface's coordinate z.
std::vector<float> RegularHeightsOf(const SurfaceSpec& spec,
                                    const SurfaceGrid& grid);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_SURFACE_REFERENCE_H_
