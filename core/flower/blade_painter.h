// BladePainter: the colours of a blade's vertices, as factors of its material's
// colour: a gradient from base to tip, a blotch and a seam.
//
// The outer edge of a blotch breaks up into rays by the flower's noise over the
// direction from the base. Immutable; the noise must outlive it. IEEE
// operations only.
#ifndef TERRANE_CORE_FLOWER_BLADE_PAINTER_H_
#define TERRANE_CORE_FLOWER_BLADE_PAINTER_H_

#include "core/flower/flower_spec.h"
#include "core/mesh/mesh.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

// Whether blades have a column of colours at all.
bool HasColors(const BladeColors& colors);

class BladePainter {
 public:
  BladePainter(const BladeColors& colors, const PerlinNoise& noise)
      : colors_(colors), noise_(noise) {}

  // At a place of the sketch where the blade is so wide.
  Float3 At(float x, float y, float half_width) const;

 private:
  float BlotchShare(const Blotch& blotch, float x, float y) const;

  const BladeColors colors_;
  const PerlinNoise& noise_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_BLADE_PAINTER_H_
