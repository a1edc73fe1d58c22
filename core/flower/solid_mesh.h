// Meshes of stamens, pistils, florets and receptacles: a cylinder along y from
// the origin, and an ellipsoid of revolution about its end. Each is a closed
// surface of its own, seen from outside.
//
// Vertices that lie in one place but differ in normal or texture coordinate
// are kept apart. Pure functions; the same bits everywhere.
#ifndef TERRANE_CORE_FLOWER_SOLID_MESH_H_
#define TERRANE_CORE_FLOWER_SOLID_MESH_H_

#include <cstdint>

#include "core/flower/flower_spec.h"
#include "core/mesh/mesh.h"

namespace terrane::core {

struct MeshSize {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
};

// A closed cylinder of radius 1 and length 1.
Mesh MakeCylinder(int sides);
MeshSize CylinderSize(int sides);

// Which of its two parts a solid has.
bool HasFilament(const SolidGroup& solid);
bool HasHead(const SolidGroup& solid);

// Both parts of a valid group's solid; colours where a tint is not white.
Mesh MakeSolid(const SolidGroup& solid);
MeshSize SolidSize(const SolidGroup& solid);
bool HasColors(const SolidGroup& solid);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_SOLID_MESH_H_
