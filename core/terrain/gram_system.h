// The linear system of exact conditioning: (W W' + D) x = b.
//
// Row k of W holds spot k's ancestors that other spots share, each weight times
// its displacement's standard deviation; D holds the variance of those it has
// for itself, plus its nugget. So the matrix is the covariance of P_fbm at the
// spots, never formed.
//
// Solved by Eigen's conjugate gradients, preconditioned by a factorised sparse
// approximate inverse: for each spot the kriging weights of its nearest
// predecessors in a shuffled order, under a covariance that only resembles the
// process's (Kolotilina & Yeremin 1993; Vecchia 1988). What it gets wrong costs
// iterations, not accuracy.
//
// Threads: a system belongs to one thread. Determinism: scalar double
// arithmetic in a fixed order.
#ifndef TERRANE_CORE_TERRAIN_GRAM_SYSTEM_H_
#define TERRANE_CORE_TERRAIN_GRAM_SYSTEM_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/terrain/preparation.h"

namespace terrane::core {

// Rows of W, one after the other.
class GramMatrix {
 public:
  // Appends to the row at work.
  void Append(std::uint32_t column, double value) {
    columns_.push_back(column);
    values_.push_back(value);
  }
  // Ends the row at work; `own` is its element of D.
  void EndRow(double own) {
    row_ends_.push_back(columns_.size());
    own_.push_back(own);
  }
  void Reserve(std::size_t rows, std::size_t elements);

  std::size_t rows() const { return row_ends_.size(); }
  // out = W' x, one value a column.
  void Transposed(std::span<const double> x, std::span<double> out) const;
  // out = (W W' + D) x; `shared` is working memory, one value a column.
  void Product(std::span<const double> x, std::span<double> shared,
               std::span<double> out) const;

 private:
  std::size_t RowBegin(std::size_t row) const {
    return row == 0 ? 0 : row_ends_[row - 1];
  }

  std::vector<std::size_t> row_ends_;
  std::vector<std::uint32_t> columns_;
  std::vector<double> values_;
  std::vector<double> own_;
};

// Where a spot lies, in level-0 units.
struct GramPlace {
  double u = 0, v = 0;
};

struct GramSolution {
  std::vector<double> x;
  int iterations = 0;
  // Row with the largest |b - A x|, and how large that is.
  std::size_t worst_row = 0;
  double worst_residual = 0;
};

// Places and Hurst exponent are for the preconditioner only. Errors: CANCELLED.
// Never fails otherwise: look at the residual.
absl::StatusOr<GramSolution> SolveGram(const GramMatrix& matrix,
                                       std::size_t columns,
                                       std::span<const GramPlace> places,
                                       double roughness,
                                       std::span<const double> b,
                                       const Preparation& preparation);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_GRAM_SYSTEM_H_
