// Triangles of a grid of vertices.
//
// Vertex (i, j) of a grid of columns * rows vertices, row-major. Each cell
// makes two triangles, split from (i + 1, j) to (i, j + 1). Vertices whose
// position is NaN are left out, and with them the triangles that they belong
// to.
//
// Threads: pure functions. Determinism: functions of the vertices alone.
#ifndef TERRANE_CORE_MESH_GRID_MESH_H_
#define TERRANE_CORE_MESH_GRID_MESH_H_

#include <cstdint>
#include <span>

#include "core/mesh/mesh.h"

namespace terrane::core {

struct GridVertices {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::span<const Float3> positions;
  std::span<const Float3> normals;  // or empty
  std::span<const Float2> uvs;      // or empty
};

// Most vertices of one mesh: indices have 32 bits, the largest is kept free.
inline constexpr std::int64_t kMaxMeshVertices = 0xFFFFFFFE;

// The mesh of a grid: counter-clockwise where columns run to the right and rows
// upwards. Vertices that no triangle uses are dropped. The caller keeps to
// kMaxMeshVertices.
Mesh MakeGridMesh(const GridVertices& grid);

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_GRID_MESH_H_
