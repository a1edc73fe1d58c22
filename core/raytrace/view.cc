#include "core/raytrace/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/det_math.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

// The box fills this much of the picture.
constexpr float kFilled = 0.92f;
// In radii of the box.
constexpr float kFadeBegin = 3;
constexpr float kFadeEnd = 14;
constexpr float kGroundGap = 1e-3f;

double Radians(double degrees) { return degrees * (std::numbers::pi / 180); }

float Tangent(float degrees) {
  const double angle = Radians(static_cast<double>(degrees));
  return static_cast<float>(DetSin(angle) / DetCos(angle));
}

Float3 CentreOf(const Bounds& bounds) {
  return 0.5f * (bounds.low + bounds.high);
}

// Towards where pictures have their upper edge, looking from `direction`. Not
// along the line of sight, even from straight above.
Float3 UpFor(const Direction& direction) {
  return Towards({direction.turn_deg + 180, 90 - direction.tilt_deg});
}

}  // namespace

Float3 Towards(const Direction& direction) {
  const double turn = Radians(direction.turn_deg);
  const double tilt = Radians(direction.tilt_deg);
  const double level = DetCos(tilt);
  return {static_cast<float>(-DetSin(turn) * level),
          static_cast<float>(-DetCos(turn) * level),
          static_cast<float>(DetSin(tilt))};
}

float RadiusOf(const Bounds& bounds) {
  return std::max(0.5f * Length(bounds.high - bounds.low), 1e-6f);
}

Camera FrameCamera(const Bounds& bounds, const Direction& direction,
                   float field_of_view_deg, float aspect) {
  const Float3 centre = CentreOf(bounds);
  const Float3 back = Towards(direction);
  const Float3 up = UpFor(direction);
  const Float3 right = Cross(up, back);
  const float up_slope = kFilled * Tangent(0.5f * field_of_view_deg);
  const float right_slope = up_slope * aspect;
  // The nearest eye that sees each corner: |x| <= slope (distance - depth).
  float distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Float3 offset =
        Float3{(corner & 1) != 0 ? bounds.high.x : bounds.low.x,
               (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
               (corner & 4) != 0 ? bounds.high.z : bounds.low.z} -
        centre;
    distance = std::max(
        {distance,
         Dot(offset, back) + std::fabs(Dot(offset, right)) / right_slope,
         Dot(offset, back) + std::fabs(Dot(offset, up)) / up_slope});
  }
  distance = std::max(distance, RadiusOf(bounds));
  return {centre + distance * back, centre, up, field_of_view_deg};
}

AreaLight PlaceLight(const Bounds& bounds, const LightPlace& place) {
  const float radius = RadiusOf(bounds);
  const float distance = static_cast<float>(place.distance) * radius;
  const float half_side = static_cast<float>(place.half_side) * radius;
  const Float3 away = Towards(place.direction);
  const Float3 up = UpFor(place.direction);
  // right x up is away from the scene, up x right towards it.
  const Float3 right = Cross(up, away);
  const float area = 4 * half_side * half_side;
  return {CentreOf(bounds) + distance * away, half_side * up, half_side * right,
          (distance * distance / area) * place.irradiance};
}

Ground PlaceGround(const Bounds& bounds, const Material& material) {
  const Float3 centre = CentreOf(bounds);
  const float radius = RadiusOf(bounds);
  // Lower than what lies flat at the bottom of the box, by what nobody sees.
  return {bounds.low.z - kGroundGap * radius,
          material,
          {centre.x, centre.y},
          kFadeBegin * radius,
          kFadeEnd * radius};
}

}  // namespace terrane::core
