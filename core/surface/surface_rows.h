// SurfaceRows: a surface evaluated row by row over a range of columns.
//
// What a column needs (blending functions, hash words, gains) is computed once
// for all rows, what a row needs once for all its columns; the kernels
// (surface_kernels.h) do the rest. Both depend on the sample's index and the
// grid alone, so a sample has the same bits in any window.
//
// Units: those of the net. Threads: one at a time. Memory: a few floats a
// column.
#ifndef TERRANE_CORE_SURFACE_SURFACE_ROWS_H_
#define TERRANE_CORE_SURFACE_SURFACE_ROWS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/grid/grid_view.h"
#include "core/surface/carry_over.h"
#include "core/surface/surface_kernels.h"
#include "core/surface/surface_model.h"

namespace terrane::core {

class SurfaceRows {
 public:
  // Columns [first, first + count) of `grid`. `model` outlives it.
  SurfaceRows(const SurfaceModel* model, const SurfaceGrid& grid,
              std::int64_t first, std::int64_t count);

  // Goes to row `iu`, of which the following speak.
  void SetRow(std::int64_t iu);

  // Column arrays have `count` floats and kRowSlack more behind them.
  // The perturbed coordinate; false when stopped.
  bool Heights(const std::stop_token& stop, float* out);
  // The same coordinate of the regular surface (eq. 1).
  void RegularHeights(float* out) const;
  // Positions whose coordinate along the direction is heights[c].
  void Positions(const float* heights, float* x, float* y, float* z) const;

 private:
  // Columns with the same span of the basis along t.
  struct Span {
    std::int64_t begin = 0;
    std::int64_t count = 0;
    int first_pair = 0;
    int pairs = 0;
  };
  // One network's coefficients in a row.
  struct Coefficients {
    std::vector<InputPair> pairs;
    std::vector<DrawnPair> drawn;
    DesiredResponse desired;

    OneNetworkRow From(int first_pair) const {
      return {pairs.data() + first_pair, drawn.data(), desired};
    }
  };

  void PrepareColumns();
  void FoldNet();
  void FoldNetworks();
  void FoldProducts();
  void FoldAlongT();
  void FoldAlongU();
  void SetGains();
  ColumnRun RunOf(const Span& span) const;
  double BlendU(int l) const { return values_u_[static_cast<std::size_t>(l)]; }

  const SurfaceModel& model_;
  const SurfaceGrid grid_;
  const std::int64_t first_;
  const std::int64_t count_;

  // By column.
  std::vector<Span> spans_;
  GridBuffer inputs_buffer_;
  GridView inputs_;
  std::vector<std::uint32_t> words_;
  std::vector<double> norms_;
  std::vector<float> column_gains_;

  // Of the row.
  std::int64_t iu_ = 0;
  std::array<double, Basis::kMaxCount> values_u_;
  int first_u_ = 0;
  double norm_u_ = 0;
  std::vector<float> regular_heights_;
  std::vector<float> flat_x_, flat_y_, flat_z_;
  Coefficients along_t_;
  Coefficients along_u_;
  int pairs_u_ = 0;
  std::vector<float> block_heights_;
  std::ptrdiff_t block_stride_ = 0;
  std::vector<float> gains_;
  std::vector<double> row_norms_;
  std::vector<double> work_;
  CarriedRow carried_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_SURFACE_ROWS_H_
