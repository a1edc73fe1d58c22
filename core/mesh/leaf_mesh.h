// The prototype mesh of a leaf, and the turn that puts it where a leaf sits.
//
// A leaf is as long as one unit: it lies along +x from its base at the origin,
// its upper face looks along +z. It is one blade, or several that fan out from
// the base in its plane: a palm's fingers, or a spray of needles. A blade is a
// pointed oval of 8 triangles, folded upwards along its midrib, so that light
// plays on its halves.
//
// Pure functions, safe from any thread; the same bits everywhere.
#ifndef TERRANE_CORE_MESH_LEAF_MESH_H_
#define TERRANE_CORE_MESH_LEAF_MESH_H_

#include "core/mesh/scene.h"

namespace terrane::core {

struct LeafShape {
  // Of a blade where it is widest, as a share of its length, (0, 2].
  double width = 0.5;
  int blades = 1;  // [1, 32]
  // Between the outermost blades, [0, 360].
  double spread_deg = 140;
};

// With normals and texture coordinates: u across a blade, v along it.
Mesh MakeLeafMesh(const LeafShape& shape);

// Brings +x to `direction` and +z to `normal`, unit vectors at a right angle.
Quaternion LeafRotation(Float3 direction, Float3 normal);

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_LEAF_MESH_H_
