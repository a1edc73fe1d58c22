// What is true of every good mesh, for tests of the generators that make them.
#ifndef TERRANE_TESTS_CORE_MESH_CHECKS_H_
#define TERRANE_TESTS_CORE_MESH_CHECKS_H_

#include <cstddef>

#include "core/mesh/mesh.h"

namespace terrane::core {

// Edges that a mesh has on one side only, vertices in one place taken for one:
// 0 of a closed surface. Fails the running test where two triangles run through
// an edge in the same direction.
std::size_t OpenEdges(const Mesh& mesh);

// The least (2 area) / (longest edge)^2 of a triangle.
double LeastShape(const Mesh& mesh);

// Fails the running test where columns differ in size, an index has no vertex,
// a number is not finite, a normal is off 1 by 1e-3, or a triangle has no area
// or, if it is not a sliver, turns its back to the normals of its vertices.
// `least_facing`: the least cosine between a triangle's normal and the mean of
// its vertices'.
void ExpectGoodMesh(const Mesh& mesh, double least_facing = 0);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_MESH_CHECKS_H_
