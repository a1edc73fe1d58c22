#include "core/flower/rotation.h"

#include <cmath>

namespace terrane::core {
namespace {

constexpr double kRadians = 0.017453292519943295;

}  // namespace

Vector UnitOf(Vector a) {
  return (1 / std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z)) * a;
}

SineCosine64 SineCosineOf(double degrees) {
  return DetSinCos((degrees - 360 * std::floor(degrees / 360)) * kRadians);
}

Vector Turn::Of(Vector a) const {
  // a + 2 v x (v x a + w a), v the vector part.
  const Vector inner = {y * a.z - z * a.y + w * a.x,
                        z * a.x - x * a.z + w * a.y,
                        x * a.y - y * a.x + w * a.z};
  return {a.x + 2 * (y * inner.z - z * inner.y),
          a.y + 2 * (z * inner.x - x * inner.z),
          a.z + 2 * (x * inner.y - y * inner.x)};
}

Quaternion Turn::ToQuaternion() const {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
          static_cast<float>(w)};
}

Turn operator*(const Turn& a, const Turn& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
          a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Turn AboutX(double degrees) {
  const SineCosine64 half = SineCosineOf(degrees / 2);
  return {half.sine, 0, 0, half.cosine};
}

Turn AboutY(double degrees) {
  const SineCosine64 half = SineCosineOf(degrees / 2);
  return {0, half.sine, 0, half.cosine};
}

Turn AboutZ(double degrees) {
  const SineCosine64 half = SineCosineOf(degrees / 2);
  return {0, 0, half.sine, half.cosine};
}

Turn FromZTo(Vector unit) {
  // z x unit and 1 + cos of the angle, made a unit.
  const double w = 1 + unit.z;
  const double scale = 1 / std::sqrt(unit.x * unit.x + unit.y * unit.y + w * w);
  return {-unit.y * scale, unit.x * scale, 0, w * scale};
}

}  // namespace terrane::core
