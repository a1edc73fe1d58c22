// One shape of a macro shape, ready to evaluate: what MacroShape is made of.
//
// Immutable and thread-safe. Determinism: a height is a function of the
// sample's own position; outside its support a shape is exactly 0, so that
// leaving it out there changes no bit. On a line (1 dimension) y does not
// count.
#ifndef TERRANE_CORE_TERRAIN_MACRO_PART_H_
#define TERRANE_CORE_TERRAIN_MACRO_PART_H_

#include <cstddef>
#include <memory>

#include "core/grid/lattice_window.h"
#include "core/grid/raster_sampler.h"
#include "core/grid/sample_rect.h"
#include "core/terrain/macro_shape.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

class MacroShapePart {
 public:
  virtual ~MacroShapePart() = default;

  // The shape is 0 outside this box.
  virtual Box Support() const { return kEverywhere; }

  // Writes the heights of the samples of `rect`, which lie in the support,
  // packed row by row; NaN where there is no data.
  virtual void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                        double* out) const = 0;

  // Bounds that no height in `box` exceeds.
  virtual MacroShape::Bounds BoundsIn(const Box& box) const = 0;
};

// macro_analytic.cc: shapes given by a formula.
std::unique_ptr<MacroShapePart> MakePart(const Plane& plane, int dimensions);
std::unique_ptr<MacroShapePart> MakePart(const Cone& cone, int dimensions);
std::unique_ptr<MacroShapePart> MakePart(const GaussianHill& hill,
                                         int dimensions);
std::unique_ptr<MacroShapePart> MakePart(const Ridge& ridge, int dimensions);
std::unique_ptr<MacroShapePart> MakePart(const Boss& boss, int dimensions);

// macro_sampled.cc: shapes that interpolate given heights.
std::unique_ptr<MacroShapePart> MakePart(const ControlNet& net);
std::unique_ptr<MacroShapePart> MakePart(const Profile& profile);

// A raster. One whose frame is `frame`, the lattice's, is sampled at (u, v),
// any other one at (x, y).
class RasterPart : public MacroShapePart {
 public:
  RasterPart(const RasterShape& shape, const Frame& frame);

  // As Evaluate, without going through double: out[j * stride + i].
  void EvaluateFloat(const SampleGrid& grid, const SampleRect& rect, float* out,
                     std::ptrdiff_t stride) const;

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override;
  MacroShape::Bounds BoundsIn(const Box& box) const override;

 private:
  std::shared_ptr<const Raster> raster_;
  bool is_lattice_;
  RasterSampler sampler_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_MACRO_PART_H_
