// The stem: a tube about a gently perturbed midline that nods at its tip.
//
// The midline's direction is the vertical plus noise in x and y (0 at the root,
// as strong as `bend` asks); over its last quarter it leans to -y until the tip
// has the nodding angle. Its length is the stem's height. Immutable; the noise
// is read at construction only. The same bits everywhere.
#ifndef TERRANE_CORE_FLOWER_STEM_H_
#define TERRANE_CORE_FLOWER_STEM_H_

#include <vector>

#include "core/flower/flower_spec.h"
#include "core/flower/rotation.h"
#include "core/flower/solid_mesh.h"
#include "core/mesh/mesh.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

class StemLine {
 public:
  StemLine(const StemSpec& spec, int variant, const PerlinNoise& noise);

  struct Place {
    Vector position;
    Vector direction;  // a unit vector, upwards along the stem
  };
  // At a share in [0, 1] of its length.
  Place At(double share) const;

  const std::vector<Place>& places() const { return places_; }

 private:
  std::vector<Place> places_;  // rows + 1
};

// A closed tube along the line.
Mesh MakeStem(const StemSpec& spec, const StemLine& line);
MeshSize StemSize(const StemSpec& spec);

// Its radius at a share of its length.
double StemRadius(const StemSpec& spec, double share);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_STEM_H_
