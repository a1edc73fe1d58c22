// Continuous constraints with region harmony (Tan & Chen 2003, section 4,
// eqs. 13-15), for one quantity: H or T as a function of the point.
//
// With M sources whose reach holds p:
//   F(p) = F0 + sum_m (1/M) (F*_m - F0) / (1 + f_m distance_m(p)^2).
// A source with a smooth edge fades by a window w = (1 - (distance/reach)^2)^2,
// as a term and in M alike: M = max(1, sum of w), so F has no step anywhere.
// Sources are indexed, so the cost of a sample does not grow with their number;
// contributions are summed in the order of the sources, whatever the grid.
//
// Immutable and thread-safe. Determinism: a value is a function of the sample's
// own position alone.
#ifndef TERRANE_CORE_TERRAIN_CONSTRAINT_FIELD_H_
#define TERRANE_CORE_TERRAIN_CONSTRAINT_FIELD_H_

#include <cstddef>
#include <memory>
#include <span>
#include <stop_token>

#include "core/grid/lattice_window.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

class ConstraintField {
 public:
  // Takes the constraints of `quantity` among `constraints` (valid ones, see
  // core/terrain/validate.h); `background` is F0.
  ConstraintField(std::span<const ContinuousConstraint> constraints,
                  ConstraintQuantity quantity, double background,
                  int dimensions);
  ~ConstraintField();
  ConstraintField(ConstraintField&&) noexcept;
  ConstraintField& operator=(ConstraintField&&) noexcept;

  // True when there is no source at all.
  bool empty() const;
  float background() const;

  // Smallest and largest value the field can take anywhere.
  float minimum() const;
  float maximum() const;

  // Writes F at every sample, out[j * stride + i], and returns true; or returns
  // false and writes nothing when no source reaches any of the samples (F is
  // the background everywhere).
  // When `stop` was asked to, it returns early and what was written is
  // meaningless.
  bool Evaluate(const SampleGrid& grid, float* out, std::ptrdiff_t stride,
                const std::stop_token& stop = {}) const;

 private:
  class Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_CONSTRAINT_FIELD_H_
