// The dyadic lattice: where it lies in the world, and rectangles of its points.
//
// Level 0 has spacing Frame::spacing; every further level halves it. The point
// (ix, iy) of level n lies at u = ix / 2^n, v = iy / 2^n in level-0 units
// (exact in double for |ix| < 2^53) and at origin + (u, v) * spacing in the
// world. The same point has the same u, v, x, y at every level that holds it,
// whatever tile it was asked for in: this is what makes tiles agree bit for
// bit.
#ifndef TERRANE_CORE_GRID_LATTICE_WINDOW_H_
#define TERRANE_CORE_GRID_LATTICE_WINDOW_H_

#include <cstdint>
#include <vector>

namespace terrane::core {

// Largest size of a sample index anywhere.
inline constexpr std::int64_t kMaxIndex = std::int64_t{1} << 52;

// Finest level of a request. (AREA samples of it are points of the next one.)
inline constexpr int kMaxLevel = 40;

// Place of the lattice in the world. Spacing is finite and not 0; negative
// means that the world coordinate falls as the index grows.
struct Frame {
  double origin_x = 0;
  double origin_y = 0;
  double spacing_x = 1;
  double spacing_y = 1;

  bool operator==(const Frame&) const = default;
};

// Where a sample sits: on a lattice vertex, or at the centre of a cell, which
// is the centre point (2i + 1, 2j + 1) of the lattice one level finer.
enum class Sampling { kPoint, kArea };

// Samples [x, x + width) x [y, y + height) of one level.
struct Window {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;

  bool operator==(const Window&) const = default;
};

// The positions of a rectangle of samples: column i has u[i] in level-0 units
// and x[i] in the world, row j has v[j] and y[j]. Strictly monotonic.
struct SampleGrid {
  std::vector<double> u, v;
  std::vector<double> x, y;
};

// Fills `grid` with the positions of the lattice points
// (first_x + step i, first_y + step j) of `level`, i < columns, j < rows.
// Reuses the vectors' memory.
void FillSampleGrid(const Frame& frame, int level, std::int64_t first_x,
                    std::int64_t first_y, std::int64_t step,
                    std::int64_t columns, std::int64_t rows, SampleGrid* grid);

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_LATTICE_WINDOW_H_
