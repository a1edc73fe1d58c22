// Float3: a point or a direction in space, in float32, as the columns of
// skeletons and meshes hold it.
//
// Pure functions; IEEE operations in the order written, so the same bits
// everywhere.
#ifndef TERRANE_CORE_MESH_FLOAT3_H_
#define TERRANE_CORE_MESH_FLOAT3_H_

#include <cmath>

#include "core/mesh/mesh.h"

namespace terrane::core {

constexpr Float3 operator+(Float3 a, Float3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Float3 operator-(Float3 a, Float3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Float3 operator*(float scale, Float3 a) {
  return {scale * a.x, scale * a.y, scale * a.z};
}

constexpr float Dot(Float3 a, Float3 b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
constexpr Float3 Cross(Float3 a, Float3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float Length(Float3 a) { return std::sqrt(Dot(a, a)); }
// `a` must not be zero.
inline Float3 Normalized(Float3 a) { return (1.0f / Length(a)) * a; }

// A unit vector at a right angle to a unit vector, the same for the same one:
// in the plane y = 0 where that holds it.
inline Float3 Perpendicular(Float3 unit) {
  const float level = unit.x * unit.x + unit.z * unit.z;
  // Close to the y axis that would have few digits.
  return level > 0.01f ? Normalized({unit.z, 0, -unit.x})
                       : Normalized({unit.y, -unit.x, 0});
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_FLOAT3_H_
