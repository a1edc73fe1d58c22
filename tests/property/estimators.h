// Estimators of a field's statistics, for the tests that hold the generators to
// their method. Plain and slow. They accumulate over many windows, so that an
// estimate is over places and seeds alike.
#ifndef TERRANE_TESTS_PROPERTY_ESTIMATORS_H_
#define TERRANE_TESTS_PROPERTY_ESTIMATORS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace terrane::core {

// A window of values, row-major.
struct Patch {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<float> values;

  double At(std::int64_t i, std::int64_t j) const {
    return static_cast<double>(values[static_cast<std::size_t>(j * width + i)]);
  }
};

// Slope of the least squares line through (x, y).
double LineSlope(std::span<const double> x, std::span<const double> y);

// Mean squared increments over lags along one direction.
class Variogram {
 public:
  // Lag k is lags[k] steps of (step_x, step_y), none negative.
  Variogram(std::vector<int> lags, int step_x, int step_y);

  // Adds every increment that lies inside the patch. NaN values are left out.
  void Add(const Patch& patch);

  // Mean squared increment over lag k.
  double MeanSquare(std::size_t k) const;

  // Hurst exponent: half the slope of log(mean square) against log(lag), by
  // least squares over lags first to last, both included. All lags weigh the
  // same, so lags 1, 2, 4, ... weigh the scales the same.
  double Hurst(std::size_t first, std::size_t last) const;
  double Hurst() const { return Hurst(0, lags_.size() - 1); }

 private:
  std::vector<int> lags_;
  int step_x_;
  int step_y_;
  std::vector<double> sums_;
  std::vector<double> counts_;
};

// Mean square of the second differences along x and along y, by the position of
// their middle sample modulo `period` in each axis.
class SecondDifferences {
 public:
  explicit SecondDifferences(int period);

  // (x, y): lattice index of the patch's first value.
  void Add(const Patch& patch, std::int64_t x, std::int64_t y);

  // The largest mean square of a position, over the smallest; along one axis at
  // a time, the larger of the two ratios.
  double LargestOverSmallest() const;

 private:
  int period_;
  // By axis, then position.
  std::vector<double> sums_[2];
  std::vector<double> counts_[2];
};

// Largest distance between the empirical distribution function of `draws`,
// which it sorts, and that of N(0, 1).
double KolmogorovSmirnov(std::span<float> draws);

// Correlation of pairs that are added one by one.
class Correlation {
 public:
  void Add(double a, double b);
  // About N(0, 1) when the pairs are independent and many.
  double InDeviations() const;

 private:
  double count_ = 0, a_ = 0, b_ = 0, aa_ = 0, bb_ = 0, ab_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_TESTS_PROPERTY_ESTIMATORS_H_
