// Rotations by unit quaternions, in float32, as the instances of scenes hold
// them.
//
// Pure functions; IEEE operations in the order written, so the same bits
// everywhere.
#ifndef TERRANE_CORE_MESH_ROTATION_H_
#define TERRANE_CORE_MESH_ROTATION_H_

#include <cmath>

#include "core/mesh/float3.h"
#include "core/mesh/scene.h"

namespace terrane::core {

// v turned by a unit quaternion.
inline Float3 Rotated(const Quaternion& q, Float3 v) {
  const Float3 axis = {q.x, q.y, q.z};
  const Float3 twice = 2.0f * Cross(axis, v);
  return v + q.w * twice + Cross(axis, twice);
}

// The rotation that takes the axes to x, y and z: unit vectors at right angles,
// z = x cross y.
inline Quaternion RotationTo(Float3 x, Float3 y, Float3 z) {
  // Four times the square of a component; the largest divides the others.
  const float w4 = 1 + x.x + y.y + z.z;
  const float x4 = 1 + x.x - y.y - z.z;
  const float y4 = 1 - x.x + y.y - z.z;
  const float z4 = 1 - x.x - y.y + z.z;
  if (w4 >= x4 && w4 >= y4 && w4 >= z4) {
    const float root = std::sqrt(w4);
    const float scale = 0.5f / root;
    return {scale * (y.z - z.y), scale * (z.x - x.z), scale * (x.y - y.x),
            0.5f * root};
  }
  if (x4 >= y4 && x4 >= z4) {
    const float root = std::sqrt(x4);
    const float scale = 0.5f / root;
    return {0.5f * root, scale * (x.y + y.x), scale * (z.x + x.z),
            scale * (y.z - z.y)};
  }
  if (y4 >= z4) {
    const float root = std::sqrt(y4);
    const float scale = 0.5f / root;
    return {scale * (x.y + y.x), 0.5f * root, scale * (y.z + z.y),
            scale * (z.x - x.z)};
  }
  const float root = std::sqrt(z4);
  const float scale = 0.5f / root;
  return {scale * (z.x + x.z), scale * (y.z + z.y), 0.5f * root,
          scale * (x.y - y.x)};
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_ROTATION_H_
