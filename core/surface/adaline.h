// The LMS rule of an adaline, in closed form.
//
// A step is e = Y - w x, w <- w + 2 mu e x (Widrow and Hoff). The input x stays
// the same during the K steps at one sample, so w moves along x only and each
// step multiplies the error by 1 - 2 mu |x|^2; the geometric sum gives
//   w_K = w_0 + x e_0 g,  g = (1 - (1 - 2 mu |x|^2)^K) / |x|^2,
// which needs 0 < mu |x|^2 < 1, and in the limit g = 1 / |x|^2: w x = Y. The
// gain g is all that training takes.
//
// Threads: pure functions. Determinism: IEEE operations in a fixed order; the
// sum is built by doubling, without the subtraction that would cancel.
#ifndef TERRANE_CORE_SURFACE_ADALINE_H_
#define TERRANE_CORE_SURFACE_ADALINE_H_

#include <optional>
#include <span>
#include <vector>

#include "core/surface/surface_spec.h"

namespace terrane::core {

// The gain for an input with |x|^2 = squared_norm; no training: to convergence.
double TrainingGain(const std::optional<Training>& training,
                    double squared_norm);

// The same for many inputs; the two spans have one size, `work` is left over.
void TrainingGains(const std::optional<Training>& training,
                   std::span<const double> squared_norms,
                   std::vector<double>* work, std::span<float> gains);

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_ADALINE_H_
