// Normals of a grid of vertices, row by row.
//
// The normal of a vertex is the cross product of the differences between its
// neighbours along the row and along the column, made a unit vector: what the
// four triangles around it have in the middle. A vertex outside the grid is
// replaced by the one at its edge (a one-sided difference). A normal depends on
// five vertices only, so tiles agree when each takes the neighbours beyond its
// edge.
//
// Threads: pure functions. Determinism: the same bits on every SIMD target.
#ifndef TERRANE_CORE_MESH_GRID_NORMALS_H_
#define TERRANE_CORE_MESH_GRID_NORMALS_H_

#include "core/mesh/mesh.h"

namespace terrane::core {

// One row of vertices. Columns -1 and `count` can be read, and kRowSlack
// (core/grid/grid_view.h) floats behind.
struct VertexRow {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
};

// Writes `count` normals of `row`, between the rows `before` and `after`, as x,
// y, z triples. Where the differences vanish or are parallel the normal is
// `otherwise`.
void GridNormals(const VertexRow& before, const VertexRow& row,
                 const VertexRow& after, const Float3& otherwise, int count,
                 float* normals);

// Writes `count` vertices of `row` as x, y, z triples.
void InterleaveVertices(const VertexRow& row, int count, float* positions);

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_GRID_NORMALS_H_
