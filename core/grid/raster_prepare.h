// What a raster goes through before it is interpolated. Deterministic; safe
// from any thread.
#ifndef TERRANE_CORE_GRID_RASTER_PREPARE_H_
#define TERRANE_CORE_GRID_RASTER_PREPARE_H_

#include <cstdint>
#include <span>

namespace terrane::core {

// Replaces NaN values: ring by ring from the edge of the data inwards, `rings`
// times, by the mean of the values known among the eight neighbours; what is
// farther from the data than that by the mean of all data (0 when there is
// none).
void FillNoData(std::int64_t width, std::int64_t height, int rings,
                std::span<float> values);

// Replaces finite values by the coefficients of the cubic B-spline that passes
// through them, mirrored at the borders: (c[k-1] + 4 c[k] + c[k+1]) / 6 =
// value. Width and height at least 2.
void PrefilterCubicBSpline(std::int64_t width, std::int64_t height,
                           std::span<float> values);

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_RASTER_PREPARE_H_
