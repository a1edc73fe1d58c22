// Vec3: a point or a direction in space, in float32, as the columns of
// skeletons and meshes hold it.
//
// Pure functions; IEEE operations in the order written, so the same bits
// everywhere.
#ifndef TERRANE_CORE_BASE_VEC3_H_
#define TERRANE_CORE_BASE_VEC3_H_

#include <cmath>

namespace terrane::core {

struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  bool operator==(const Vec3&) const = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(float scale, Vec3 a) {
  return {scale * a.x, scale * a.y, scale * a.z};
}

constexpr float Dot(Vec3 a, Vec3 b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
constexpr Vec3 Cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float Length(Vec3 a) { return std::sqrt(Dot(a, a)); }
// `a` must not be zero.
inline Vec3 Normalized(Vec3 a) { return (1.0f / Length(a)) * a; }

}  // namespace terrane::core

#endif  // TERRANE_CORE_BASE_VEC3_H_
