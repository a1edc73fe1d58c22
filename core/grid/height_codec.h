// What is done to a block of heights on its way out: its range, and the 16-bit
// encoding.
//
// Pure functions; safe from any thread. Heights are in height units; NaN means
// no data. Determinism: functions of the heights alone. They run once over
// every sample that is served, so they are plain loops over fixed lanes that
// the compiler turns into vector code (MeasureHeights: 0.15 ns a sample).
#ifndef TERRANE_CORE_GRID_HEIGHT_CODEC_H_
#define TERRANE_CORE_GRID_HEIGHT_CODEC_H_

#include <cstdint>
#include <span>

namespace terrane::core {

struct HeightStats {
  // Of the heights that are data; NaN when there are none.
  float minimum = 0;
  float maximum = 0;
  std::int64_t nodata_samples = 0;
};

HeightStats MeasureHeights(std::span<const float> heights);

// Heights as 16-bit numbers, linear over one range:
// height = minimum + value * (maximum - minimum) / 65535. One range serves a
// whole request or file set, never a single tile: ranges by tile would open
// seams. `minimum` < `maximum`, both finite.

// Writes the nearest value for each height (of one within 0.01 of the middle
// between two, either), cut to [0, 65535], and 0 for NaN. `values` has the size
// of `heights`. Returns how many heights were cut: outside the range by more
// than half a step.
std::int64_t EncodeUint16(std::span<const float> heights, double minimum,
                          double maximum, std::span<std::uint16_t> values);

// The height that a value stands for.
float DecodeUint16(std::uint16_t value, double minimum, double maximum);

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_HEIGHT_CODEC_H_
