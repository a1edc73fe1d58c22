// Meshes of petals, sepals and leaves.
//
// A vertex at the base, rows of columns + 1 vertices, a vertex at the tip; an
// open sheet without thickness whose upper side the normals are on. Texture
// coordinates are the sketch's: x over its greatest width, y.
//
// Pure functions; safe from any thread. Same bits everywhere.
#ifndef TERRANE_CORE_FLOWER_BLADE_MESH_H_
#define TERRANE_CORE_FLOWER_BLADE_MESH_H_

#include <cstdint>
#include <stop_token>

#include "core/flower/blade_rows.h"
#include "core/flower/flower_spec.h"
#include "core/flower/solid_mesh.h"
#include "core/mesh/mesh.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

// Which of a BladeSpec's meshes.
struct BladeChoice {
  int sketch = 0;   // in [0, sketches)
  int variant = 0;  // in [0, variants)
  int step = 0;     // in [0, steps)
};

// Where a blade of chance number `salt` (of its group) lies in the noise.
LatticeOffset OffsetOf(std::int64_t seed, std::uint32_t salt,
                       const BladeChoice& choice);

// The shape of a step: `open` for the last.
BladeShape ShapeAt(const BladeSpec& blade, int step);

MeshSize BladeSize(const BladeSpec& blade);

// `blade` is valid. Of no use when `stop` was asked to.
Mesh MakeBladeMesh(PetalMethod method, const BladeSpec& blade,
                   const BladeChoice& choice, std::int64_t seed,
                   std::uint32_t salt, const PerlinNoise& noise,
                   const std::stop_token& stop = {});

// 1 - |mean normal|^2 over the sheet before it is bent, by area: under 0.01 it
// is flat, 0.1 to 0.3 ruffled, above kFoldingVariance it folds.
double NormalVariance(const PerlinNoise& noise, const Sketch& sketch,
                      const Relief& relief, LatticeOffset offset);

inline constexpr double kFoldingVariance = 0.4;

// Numbers that a user gives for the petal of one sketch: the sketch's points
// and the relief; the code of the IFS; the patch's control points.
int ControlValues(PetalMethod method, const Sketch& sketch);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_BLADE_MESH_H_
