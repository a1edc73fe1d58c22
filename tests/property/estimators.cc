#include "tests/property/estimators.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace terrane::core {

double LineSlope(std::span<const double> x, std::span<const double> y) {
  double mean_x = 0;
  double mean_y = 0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean_x += x[k] / count;
    mean_y += y[k] / count;
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return xy / xx;
}

Variogram::Variogram(std::vector<int> lags, int step_x, int step_y)
    : lags_(std::move(lags)),
      step_x_(step_x),
      step_y_(step_y),
      sums_(lags_.size()),
      counts_(lags_.size()) {}

void Variogram::Add(const Patch& patch) {
  for (std::size_t k = 0; k < lags_.size(); ++k) {
    const std::int64_t dx = lags_[k] * step_x_;
    const std::int64_t dy = lags_[k] * step_y_;
    for (std::int64_t j = 0; j + dy < patch.height; ++j) {
      for (std::int64_t i = 0; i + dx < patch.width; ++i) {
        const double d = patch.At(i + dx, j + dy) - patch.At(i, j);
        if (std::isnan(d)) continue;
        sums_[k] += d * d;
        counts_[k] += 1;
      }
    }
  }
}

double Variogram::MeanSquare(std::size_t k) const {
  return sums_[k] / counts_[k];
}

double Variogram::Hurst(std::size_t first, std::size_t last) const {
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t k = first; k <= last; ++k) {
    x.push_back(std::log(static_cast<double>(lags_[k])));
    y.push_back(std::log(MeanSquare(k)));
  }
  return LineSlope(x, y) / 2;
}

SecondDifferences::SecondDifferences(int period) : period_(period) {
  for (int axis = 0; axis < 2; ++axis) {
    sums_[axis].resize(static_cast<std::size_t>(period * period));
    counts_[axis].resize(sums_[axis].size());
  }
}

void SecondDifferences::Add(const Patch& patch, std::int64_t x,
                            std::int64_t y) {
  const auto phase = [&](std::int64_t index) {
    return ((index % period_) + period_) % period_;
  };
  for (std::int64_t j = 1; j + 1 < patch.height; ++j) {
    for (std::int64_t i = 1; i + 1 < patch.width; ++i) {
      const auto at =
          static_cast<std::size_t>(phase(y + j) * period_ + phase(x + i));
      for (int axis = 0; axis < 2; ++axis) {
        const int dx = axis == 0 ? 1 : 0;
        const int dy = 1 - dx;
        const double d = patch.At(i - dx, j - dy) - 2 * patch.At(i, j) +
                         patch.At(i + dx, j + dy);
        if (std::isnan(d)) continue;
        sums_[axis][at] += d * d;
        counts_[axis][at] += 1;
      }
    }
  }
}

double SecondDifferences::LargestOverSmallest() const {
  double ratio = 0;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> means;
    for (std::size_t k = 0; k < sums_[axis].size(); ++k) {
      means.push_back(sums_[axis][k] / counts_[axis][k]);
    }
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    ratio = std::max(ratio, *high / *low);
  }
  return ratio;
}

double KolmogorovSmirnov(std::span<float> draws) {
  std::sort(draws.begin(), draws.end());
  const auto count = static_cast<double>(draws.size());
  double distance = 0;
  for (std::size_t k = 0; k < draws.size(); ++k) {
    const double expected =
        std::erfc(-static_cast<double>(draws[k]) / std::numbers::sqrt2) / 2;
    distance = std::max(
        {distance, std::fabs(static_cast<double>(k) / count - expected),
         std::fabs(static_cast<double>(k + 1) / count - expected)});
  }
  return distance;
}

void Correlation::Add(double a, double b) {
  count_ += 1;
  a_ += a;
  b_ += b;
  aa_ += a * a;
  bb_ += b * b;
  ab_ += a * b;
}

double Correlation::InDeviations() const {
  const double covariance = ab_ / count_ - a_ / count_ * (b_ / count_);
  const double variance_a = aa_ / count_ - a_ / count_ * (a_ / count_);
  const double variance_b = bb_ / count_ - b_ / count_ * (b_ / count_);
  return covariance / std::sqrt(variance_a * variance_b) * std::sqrt(count_);
}

}  // namespace terrane::core
