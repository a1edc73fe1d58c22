// The macro shape d(p), ready to evaluate.
//
// Immutable and thread-safe. Determinism: the value at a sample is a function
// of the sample's own (u, v, x, y) alone; no libm in the result.
#ifndef TERRANE_CORE_TERRAIN_MACRO_SHAPE_H_
#define TERRANE_CORE_TERRAIN_MACRO_SHAPE_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <stop_token>

#include "core/grid/lattice_window.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

class MacroShape {
 public:
  // `spec` must be valid (core/terrain/validate.h). `frame` is the lattice's: a
  // raster with the very same frame is sampled at (u, v), so that its posts are
  // met to the bit; any other at (x, y).
  MacroShape(const MacroSpec& spec, int dimensions, const Frame& frame);
  ~MacroShape();
  MacroShape(MacroShape&&) noexcept;
  MacroShape& operator=(MacroShape&&) noexcept;

  // The height everywhere, when there are no parts.
  std::optional<float> constant() const;

  // Writes d at every sample: out[j * stride + i] for column i, row j; NaN
  // where there is no data.
  // When `stop` was asked to, it returns early and what was written is
  // meaningless.
  void Evaluate(const SampleGrid& grid, float* out, std::ptrdiff_t stride,
                const std::stop_token& stop = {}) const;

  // Bounds that no value of d exceeds inside the box
  // [min_x, max_x] x [min_y, max_y] (world); conservative.
  struct Bounds {
    double minimum = 0;
    double maximum = 0;
  };
  Bounds BoundsIn(double min_x, double min_y, double max_x, double max_y) const;

 private:
  class Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_MACRO_SHAPE_H_
