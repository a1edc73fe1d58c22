#include "core/surface/adaline.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace terrane::core {
namespace {

// (1 + r + ... + r^(n-1)) and r^n of the error's ratio r, for many inputs at a
// time: from n = 0 to K by doubling, the bits of K from the highest on. Columns
// are the inner loop, which the compiler turns into vector code.
void SumRatios(unsigned steps, std::size_t count, const double* ratio,
               double* sum, double* power) {
  std::fill_n(sum, count, 0.0);
  std::fill_n(power, count, 1.0);
  for (int bit = static_cast<int>(std::bit_width(steps)) - 1; bit >= 0; --bit) {
    for (std::size_t k = 0; k < count; ++k) {
      sum[k] += sum[k] * power[k];
      power[k] *= power[k];
    }
    if ((steps >> bit & 1u) == 0) continue;
    for (std::size_t k = 0; k < count; ++k) {
      sum[k] += power[k];
      power[k] *= ratio[k];
    }
  }
}

}  // namespace

double TrainingGain(const std::optional<Training>& training,
                    double squared_norm) {
  if (!training.has_value()) return 1.0 / squared_norm;
  const double step = 2.0 * training->learning_rate;
  const double ratio = 1.0 - step * squared_norm;
  double sum;
  double power;
  SumRatios(static_cast<unsigned>(training->iterations), 1, &ratio, &sum,
            &power);
  return step * sum;
}

void TrainingGains(const std::optional<Training>& training,
                   std::span<const double> squared_norms,
                   std::vector<double>* work, std::span<float> gains) {
  const std::size_t count = squared_norms.size();
  if (!training.has_value()) {
    for (std::size_t k = 0; k < count; ++k) {
      gains[k] = static_cast<float>(1.0 / squared_norms[k]);
    }
    return;
  }
  work->resize(3 * count);
  double* const ratio = work->data();
  double* const sum = ratio + count;
  const double step = 2.0 * training->learning_rate;
  for (std::size_t k = 0; k < count; ++k) {
    ratio[k] = 1.0 - step * squared_norms[k];
  }
  SumRatios(static_cast<unsigned>(training->iterations), count, ratio, sum,
            sum + count);
  for (std::size_t k = 0; k < count; ++k) {
    gains[k] = static_cast<float>(step * sum[k]);
  }
}

}  // namespace terrane::core
