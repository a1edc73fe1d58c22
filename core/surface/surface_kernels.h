// The hot loops of a surface: one row of samples, one vector of columns at a
// time.
//
// Sums over the net that do not depend on the column are folded into
// coefficients once a row (surface_rows.cc), so a sample costs one pass over
// the weights that are drawn and one over the inputs of t:
//   M h = sum x w_0 h + e_0 g sum x^2 h,  e_0 = Y - sum x w_0   (see adaline.h)
// Inputs come in pairs, as the draws do (weight_table.h).
//
// Column arrays have kRowSlack readable and writable floats behind `count`.
// Threads: pure functions. Determinism: the same bits on every SIMD target; a
// column's value does not depend on its neighbours.
#ifndef TERRANE_CORE_SURFACE_SURFACE_KERNELS_H_
#define TERRANE_CORE_SURFACE_SURFACE_KERNELS_H_

#include <cstddef>
#include <cstdint>

#include "core/noise/counter_hash.h"

namespace terrane::core {

// Two drawn weights: adds weight[k] U to the sum of x w_0, readout[k] U to that
// of x w_0 h. The unit of U, 2^-16, is in the factors.
struct DrawnPair {
  RowKey key;
  float weight[2];
  float readout[2];
};

// The inputs 2p and 2p + 1 with what this row adds to them besides the draws:
// weight[k] to the sum of x w_0, readout[k] to that of x w_0 h, squared[k] to
// that of x^2 h.
struct InputPair {
  float weight[2];
  float readout[2];
  float squared[2];
  // Its draws, in DrawnPairs of the row.
  int drawn_begin;
  int drawn_end;
};

struct DesiredResponse {
  float constant = 0;
  float random = 0;  // times the unit of U
  RowKey key = {};
};

// Neighbouring columns that lie in one span of the basis along t.
struct ColumnRun {
  // Input k of the run in column c is inputs[k * stride + c].
  const float* inputs = nullptr;
  std::ptrdiff_t stride = 0;
  int pairs = 0;
  const std::uint32_t* words = nullptr;  // ColumnWord(it)
  const float* gains = nullptr;          // g of the network along t
  int count = 0;
};

// One network, read out linearly (methods 1 and 2).
struct OneNetworkRow {
  const InputPair* pairs = nullptr;  // run.pairs of them
  const DrawnPair* drawn = nullptr;
  DesiredResponse desired;
};

// A second network over f_j(u) (methods 3 and 4). Its inputs are the same in
// every column: factors of them are in its pairs, whose `squared` are f_j^2.
struct TwoNetworksRow {
  OneNetworkRow along_t;
  OneNetworkRow along_u;
  int pairs_u = 0;
  float gain_u = 0;
  // Height of control point (i, j), of the run's first input and the row's: at
  // heights[i * heights_stride + j].
  const float* heights = nullptr;
  std::ptrdiff_t heights_stride = 0;
};

// out[c] = the perturbed coordinate.
void OneNetworkHeights(const ColumnRun& run, const OneNetworkRow& row,
                       float* out);
void TwoFactorsHeights(const ColumnRun& run, const TwoNetworksRow& row,
                       float* out);
void TwoTermsHeights(const ColumnRun& run, const TwoNetworksRow& row,
                     float* out);

// out[c] = sum over k of input k times control[k].
void BlendControls(const ColumnRun& run, const float* control, float* out);

// The same for the flat parts of a row, plus heights[c] times the direction.
struct PositionRow {
  const float* flat_x = nullptr;
  const float* flat_y = nullptr;
  const float* flat_z = nullptr;
  float direction_x = 0;
  float direction_y = 0;
  float direction_z = 0;
};
void BlendPositions(const ColumnRun& run, const PositionRow& row,
                    const float* heights, float* x, float* y, float* z);

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_SURFACE_KERNELS_H_
