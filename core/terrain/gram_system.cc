#include "core/terrain/gram_system.h"

#include <Eigen/Cholesky>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/det_math.h"
#include "core/noise/counter_hash.h"

namespace terrane::core {

using Vector = Eigen::VectorXd;
class GramOperator;

}  // namespace terrane::core

// What Eigen needs to know to take GramOperator for a sparse matrix.
namespace Eigen::internal {
template <>
struct traits<terrane::core::GramOperator>
    : public traits<Eigen::SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace terrane::core {
namespace {

// Neighbours that a row of the preconditioner takes. More cost more than they
// save.
constexpr std::size_t kNeighbours = 16;

constexpr int kMostIterations = 2000;
constexpr double kTolerance = 1e-9;
constexpr int kTypicalProducts = 20;

// Share of the progress that is done with the preconditioner.
constexpr double kPreconditioned = 0.3;
constexpr std::size_t kSpotsBetweenReports = 256;

// Good enough (sigma = 1): below what a float of P's size holds.
constexpr double kGoodResidual = 3e-8;
constexpr int kMostRounds = 5;

// Thrown through Eigen's solver, and caught here, when the preparation stops.
struct Stopped {};

}  // namespace

// --- The matrix -------------------------------------------------------------

void GramMatrix::Reserve(std::size_t rows, std::size_t elements) {
  row_ends_.reserve(rows);
  own_.reserve(rows);
  columns_.reserve(elements);
  values_.reserve(elements);
}

void GramMatrix::Transposed(std::span<const double> x,
                            std::span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t k = 0; k < rows(); ++k) {
    for (std::size_t e = RowBegin(k); e < row_ends_[k]; ++e) {
      out[columns_[e]] += values_[e] * x[k];
    }
  }
}

void GramMatrix::Product(std::span<const double> x, std::span<double> shared,
                         std::span<double> out) const {
  Transposed(x, shared);
  for (std::size_t k = 0; k < rows(); ++k) {
    double sum = own_[k] * x[k];
    for (std::size_t e = RowBegin(k); e < row_ends_[k]; ++e) {
      sum += values_[e] * shared[columns_[e]];
    }
    out[k] = sum;
  }
}

// --- The matrix as Eigen sees it --------------------------------------------

class GramOperator : public Eigen::EigenBase<GramOperator> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = false
  };

  GramOperator(const GramMatrix& matrix, std::size_t columns,
               const Preparation& preparation)
      : matrix_(matrix), shared_(columns), preparation_(preparation) {}

  Eigen::Index rows() const {
    return static_cast<Eigen::Index>(matrix_.rows());
  }
  Eigen::Index cols() const { return rows(); }

  template <typename Right>
  Eigen::Product<GramOperator, Right, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Right>& x) const {
    return {*this, x.derived()};
  }

  // to += scale * A x.
  void AddProduct(const Vector& x, double scale, Eigen::Ref<Vector> to) const {
    if (preparation_.stop.stop_requested()) throw Stopped();
    if (preparation_.progress) {
      // How many there will be is not known: about twice kTypicalProducts.
      const double share =
          static_cast<double>(products_) / (products_ + kTypicalProducts);
      preparation_.progress(kPreconditioned + (1 - kPreconditioned) * share);
    }
    ++products_;
    Vector product(x.size());
    matrix_.Product({x.data(), matrix_.rows()}, shared_,
                    {product.data(), matrix_.rows()});
    to += scale * product;
  }

 private:
  const GramMatrix& matrix_;
  mutable std::vector<double> shared_;
  mutable int products_ = 0;
  const Preparation& preparation_;
};

}  // namespace terrane::core

namespace Eigen::internal {
template <typename Right>
struct generic_product_impl<terrane::core::GramOperator, Right, SparseShape,
                            DenseShape, GemvProduct>
    : generic_product_impl_base<
          terrane::core::GramOperator, Right,
          generic_product_impl<terrane::core::GramOperator, Right>> {
  template <typename To>
  static void scaleAndAddTo(To& to, const terrane::core::GramOperator& matrix,
                            const Right& x, const double& scale) {
    matrix.AddProduct(x, scale, to);
  }
};
}  // namespace Eigen::internal

namespace terrane::core {
namespace {

// --- The preconditioner -----------------------------------------------------

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 2, bg::cs::cartesian>;
using TreeValue = std::pair<TreePoint, std::uint32_t>;
using Tree = bg::index::rtree<TreeValue, bg::index::linear<16>>;

// A positive definite relative of the process's correlation: that of a field
// whose variogram grows as h^2H and levels out after a cell of level 0,
// exp(-h^2H). From a table of 1 - exp(-h^2H) over the squared distance, so that
// near points keep their small differences.
class Correlation {
 public:
  explicit Correlation(double roughness) {
    for (int k = 0; k <= kSize; ++k) {
      const int octave = k / kPerOctave;
      const double mantissa =
          1 + static_cast<double>(k % kPerOctave) / kPerOctave;
      const double squared = std::ldexp(mantissa, octave + kFirst);
      const double power = DetPow(squared, roughness);
      // 1 - exp(-x) to full relative precision where x is small.
      differences_.push_back(power < 1e-5 ? power * (1 - power / 2)
                                          : 1 - DetExp(-power));
    }
  }

  double At(const GramPlace& a, const GramPlace& b) const {
    const double du = a.u - b.u;
    const double dv = a.v - b.v;
    int exponent = 0;
    const double fraction = std::frexp(du * du + dv * dv, &exponent);
    const int octave = exponent - 1 - kFirst;
    if (fraction == 0 || octave < 0) return 1;
    if (octave >= kOctaves) return 0;
    const double at = (2 * fraction - 1) * kPerOctave;
    const auto step = static_cast<std::size_t>(at);
    const std::size_t k = static_cast<std::size_t>(octave) * kPerOctave + step;
    const double t = at - static_cast<double>(step);
    return 1 - (differences_[k] + t * (differences_[k + 1] - differences_[k]));
  }

 private:
  // Squared distances from 2^kFirst on, level 30 to a few cells.
  static constexpr int kFirst = -64;
  static constexpr int kOctaves = 72;
  static constexpr int kPerOctave = 64;
  static constexpr int kSize = kOctaves * kPerOctave;
  std::vector<double> differences_;
};

// Rows of L with L' L close to the inverse matrix.
class NeighbourInverse {
 public:
  using MatrixType = GramOperator;
  using StorageIndex = int;

  NeighbourInverse() = default;
  NeighbourInverse(std::span<const GramPlace> places, double roughness,
                   const Preparation& preparation);

  // Eigen's protocol; everything is done by then.
  template <typename Matrix>
  NeighbourInverse& compute(const Matrix&) {
    return *this;
  }
  Eigen::ComputationInfo info() { return Eigen::Success; }
  Vector solve(const Vector& x) const {
    const Vector scaled = factor_ * x;
    return factor_.transpose() * scaled;
  }

 private:
  Eigen::SparseMatrix<double, Eigen::RowMajor> factor_;
};

// The order in which spots become neighbours of later ones: shuffled, so that
// the first ones are spread over the plane.
std::vector<std::uint32_t> ShuffledOrder(std::size_t size) {
  std::vector<std::uint32_t> order(size);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [](std::uint32_t a, std::uint32_t b) {
    return Mix64(a + 1) < Mix64(b + 1);
  });
  return order;
}

NeighbourInverse::NeighbourInverse(std::span<const GramPlace> places,
                                   double roughness,
                                   const Preparation& preparation) {
  const Correlation correlation(roughness);
  std::vector<Eigen::Triplet<double>> elements;
  elements.reserve(places.size() * (kNeighbours + 1));
  Tree tree;
  std::vector<TreeValue> found;
  std::vector<std::uint32_t> ids;
  for (const std::uint32_t k : ShuffledOrder(places.size())) {
    if (preparation.stop.stop_requested()) throw Stopped();
    if (preparation.progress && tree.size() % kSpotsBetweenReports == 0) {
      preparation.progress(kPreconditioned * static_cast<double>(tree.size()) /
                           static_cast<double>(places.size()));
    }
    const TreePoint here(places[k].u, places[k].v);
    found.clear();
    tree.query(bg::index::nearest(here, kNeighbours),
               std::back_inserter(found));
    tree.insert({here, k});
    ids.clear();
    for (const TreeValue& value : found) ids.push_back(value.second);
    std::sort(ids.begin(), ids.end());
    ids.push_back(k);  // last: its row of the local inverse's factor is wanted

    const auto size = static_cast<Eigen::Index>(ids.size());
    Eigen::MatrixXd local(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        const std::uint32_t a = ids[static_cast<std::size_t>(i)];
        const std::uint32_t b = ids[static_cast<std::size_t>(j)];
        local(i, j) = local(j, i) = correlation.At(places[a], places[b]);
      }
    }
    // x = C^-1 e_k; row = x / sqrt(x_k).
    Vector row = Vector::Unit(size, size - 1);
    const Eigen::LLT<Eigen::MatrixXd> factor(local);
    if (factor.info() == Eigen::Success) row = factor.solve(row);
    const double scale = row[size - 1] > 0 ? 1 / std::sqrt(row[size - 1]) : 0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const std::uint32_t id = ids[static_cast<std::size_t>(i)];
      elements.emplace_back(static_cast<int>(k), static_cast<int>(id),
                            row[i] * scale);
    }
  }
  const auto rows = static_cast<Eigen::Index>(places.size());
  factor_.resize(rows, rows);
  factor_.setFromTriplets(elements.begin(), elements.end());
}

}  // namespace

// --- Solving ----------------------------------------------------------------

absl::StatusOr<GramSolution> SolveGram(const GramMatrix& matrix,
                                       std::size_t columns,
                                       std::span<const GramPlace> places,
                                       double roughness,
                                       std::span<const double> b,
                                       const Preparation& preparation) {
  const GramOperator gram(matrix, columns, preparation);
  const Eigen::Map<const Vector> right(b.data(),
                                       static_cast<Eigen::Index>(b.size()));
  Vector x = Vector::Zero(right.size());
  GramSolution solution;
  try {
    Eigen::ConjugateGradient<GramOperator, Eigen::Lower | Eigen::Upper,
                             NeighbourInverse>
        solver;
    solver.setMaxIterations(kMostIterations);
    solver.setTolerance(kTolerance);
    solver.compute(gram);
    solver.preconditioner() = NeighbourInverse(places, roughness, preparation);
    // The residual that the iteration carries along drifts from the true one;
    // starting again from the true one mends that.
    for (int round = 0; round < kMostRounds; ++round) {
      x = solver.solveWithGuess(right, x);
      solution.iterations += static_cast<int>(solver.iterations());
      Vector residual = right;
      gram.AddProduct(x, -1, residual);
      Eigen::Index worst = 0;
      solution.worst_residual = residual.cwiseAbs().maxCoeff(&worst);
      solution.worst_row = static_cast<std::size_t>(worst);
      if (solution.worst_residual <= kGoodResidual) break;
    }
  } catch (const Stopped&) {
    return absl::CancelledError("preparation stopped");
  }
  solution.x.assign(x.data(), x.data() + x.size());
  return solution;
}

}  // namespace terrane::core
