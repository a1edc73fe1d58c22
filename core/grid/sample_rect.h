// Which samples of a grid lie in a box of the world.
//
// Pure functions; safe from any thread.
#ifndef TERRANE_CORE_GRID_SAMPLE_RECT_H_
#define TERRANE_CORE_GRID_SAMPLE_RECT_H_

#include <cstddef>
#include <limits>

#include "core/grid/lattice_window.h"

namespace terrane::core {

// A closed axis-aligned box in world units.
struct Box {
  double min_x = 0;
  double min_y = 0;
  double max_x = 0;
  double max_y = 0;

  // Grown by `margin` on every side.
  Box Grown(double margin) const {
    return {min_x - margin, min_y - margin, max_x + margin, max_y + margin};
  }
  bool Intersects(const Box& other) const {
    return min_x <= other.max_x && other.min_x <= max_x &&
           min_y <= other.max_y && other.min_y <= max_y;
  }
};

// The whole plane.
inline constexpr Box kEverywhere{-std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};

// Columns [column_begin, column_end) of rows [row_begin, row_end) of a grid.
struct SampleRect {
  std::size_t column_begin = 0;
  std::size_t column_end = 0;
  std::size_t row_begin = 0;
  std::size_t row_end = 0;

  std::size_t columns() const { return column_end - column_begin; }
  std::size_t rows() const { return row_end - row_begin; }
  bool empty() const {
    return column_begin >= column_end || row_begin >= row_end;
  }
};

// The samples that are in both; may be empty.
SampleRect Intersection(const SampleRect& a, const SampleRect& b);

// All samples of the grid.
SampleRect AllSamples(const SampleGrid& grid);

// The smallest box that holds the samples of a rectangle that is not empty.
Box BoxOf(const SampleGrid& grid, const SampleRect& rect);

// Exactly the samples of `grid` that lie in `box`, border included. Coordinates
// may rise or fall along an axis. Takes logarithmic time.
SampleRect SamplesIn(const SampleGrid& grid, const Box& box);

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_SAMPLE_RECT_H_
