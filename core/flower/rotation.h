// Rotations in double precision: how instances are turned.
//
// A Turn is a unit quaternion; products turn right to left. Pure functions;
// IEEE operations and core/base/det_math.h only, the same bits everywhere.
#ifndef TERRANE_CORE_FLOWER_ROTATION_H_
#define TERRANE_CORE_FLOWER_ROTATION_H_

#include "core/base/det_math.h"
#include "core/mesh/scene.h"

namespace terrane::core {

struct Vector {
  double x = 0;
  double y = 0;
  double z = 0;
};

constexpr Vector operator+(Vector a, Vector b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vector operator*(double scale, Vector a) {
  return {scale * a.x, scale * a.y, scale * a.z};
}
// `a` must not be zero.
Vector UnitOf(Vector a);

constexpr Float3 ToFloat3(Vector a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y),
          static_cast<float>(a.z)};
}

// Of any angle of moderate size.
SineCosine64 SineCosineOf(double degrees);

struct Turn {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;

  Vector Of(Vector a) const;
  Quaternion ToQuaternion() const;
};

Turn operator*(const Turn& a, const Turn& b);

Turn AboutX(double degrees);
Turn AboutY(double degrees);
Turn AboutZ(double degrees);
// The least rotation that takes z to a unit vector other than -z.
Turn FromZTo(Vector unit);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_ROTATION_H_
