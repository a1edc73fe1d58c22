// Mesh: an indexed triangle mesh, as columns.
//
// Shared by every generator that makes one and by the codecs that write it.
// Three indices a triangle, counter-clockwise seen from the side that its
// normals point to. Normals, texture coordinates and colours may be left out;
// when they are there, they have one entry a vertex. A plain value: it owns its
// memory and belongs to one thread at a time. The z axis points up.
#ifndef TERRANE_CORE_MESH_MESH_H_
#define TERRANE_CORE_MESH_MESH_H_

#include <cstdint>
#include <vector>

namespace terrane::core {

struct Float2 {
  float x = 0;
  float y = 0;

  bool operator==(const Float2&) const = default;
};

struct Float3 {
  float x = 0;
  float y = 0;
  float z = 0;

  bool operator==(const Float3&) const = default;
};

// Columns are handed on as bytes.
static_assert(sizeof(Float2) == 2 * sizeof(float));
static_assert(sizeof(Float3) == 3 * sizeof(float));

struct Mesh {
  std::vector<Float3> positions;
  std::vector<Float3> normals;  // unit vectors, or empty
  std::vector<Float2> uvs;      // or empty
  std::vector<std::uint32_t> indices;
  // Linear red, green, blue in [0, 1], or empty: factors of the material's
  // colour.
  std::vector<Float3> colors;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_MESH_H_
