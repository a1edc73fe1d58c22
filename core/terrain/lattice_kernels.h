// The hot loops of the 2-D lattice: one refinement step, in SIMD.
//
// A step takes a parent grid C of level n-1 (corner (i, j)) to a child grid of
// level n with, in child indices relative to corner (0, 0),
//   corner (i, j)           at (2i,     2j)      C(i, j), kept
//   centre (i, j)           at (2i + 1, 2j + 1)  M(i, j), centre half step
//   horizontal edge (i, j)  at (2i + 1, 2j)      H(i, j), edge half step
//   vertical edge (i, j)    at (2i,     2j + 1)  V(i, j), edge half step.
// Tan & Chen 2003, eqs. 5 and 12, diamond-square in 2-D; and the 16-point
// Deslauriers-Dubuc stencil of source SUBDIVISION.
//
// Kernels work in whole vectors: every row of every grid, and the column words,
// must have kRowSlack elements behind the last column (core/grid/grid_view.h).
//
// Determinism: the same bits on every SIMD target. Every sum is written once,
// in a fixed order that is symmetric under mirroring x or y, so that a mirrored
// lattice (the border of a bounded domain) needs no code here; no fused
// multiply-add. tests/core/lattice_reference.h computes the same bits point by
// point without SIMD.
//
// Threads: pure functions of their arguments.
#ifndef TERRANE_CORE_TERRAIN_LATTICE_KERNELS_H_
#define TERRANE_CORE_TERRAIN_LATTICE_KERNELS_H_

#include <cstddef>
#include <cstdint>

#include "core/grid/grid_view.h"
#include "core/noise/counter_hash.h"

namespace terrane::core {

// How far a stencil reaches from a cell, in parent points.
inline constexpr int kMidpointMargin = 1;
inline constexpr int kSubdivisionMargin = 3;

// Standard deviation of displacements: one for all points, or one a point.
struct Deviation {
  float uniform = 0;
  GridView per_point;  // data null: uniform

  bool varies() const { return per_point.data != nullptr; }
};

enum class Stencil { kMidpoint, kSubdivision };

// Centres M(i, j) for first_column <= i < last_column, first_row <= j <
// last_row.
struct CentreStep {
  Stencil stencil = Stencil::kSubdivision;
  GridView parent;
  GridView centres;
  int first_column = 0, last_column = 0;
  int first_row = 0, last_row = 0;
  const std::uint32_t* words = nullptr;  // of column 2i + 1, by i
  const RowKey* keys = nullptr;          // of row 2j + 1, by j
  Deviation deviation;                   // by (i, j)
  float* row_scratch = nullptr;          // 4 rows of parent.stride
};
void ComputeCentres(const CentreStep& step);

// Edges H and V for the cells first_column <= i < last_column and first_row <=
// j < last_row, and the child grid put together: child(0, 0) is corner
// (first_column, first_row).
struct EdgeStep {
  Stencil stencil = Stencil::kSubdivision;
  // True: corners and centres are displaced, too (source SUCCESSIVE).
  bool displace_all = false;
  GridView parent;
  GridView centres;
  GridView child;
  int first_column = 0, last_column = 0;
  int first_row = 0, last_row = 0;
  const std::uint32_t* even_words = nullptr;  // of column 2i, by i
  const std::uint32_t* odd_words = nullptr;   // of column 2i + 1, by i
  const RowKey* even_keys = nullptr;          // of row 2j, by j
  const RowKey* odd_keys = nullptr;           // of row 2j + 1, by j
  Deviation horizontal, vertical;             // of H and V, by (i, j)
  Deviation corner, centre;                   // used when displace_all
};
void ComputeEdges(const EdgeStep& step);

// plane(i, j) += deviation * normal(words[i], keys[j]).
void AddDisplacements(GridView plane, int columns, int rows,
                      const std::uint32_t* words, const RowKey* keys,
                      const Deviation& deviation);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_LATTICE_KERNELS_H_
