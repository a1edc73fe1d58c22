#include "core/raytrace/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/base/det_math.h"
#include "core/mesh/float3.h"
#include "core/mesh/rotation.h"

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

std::array<Float3, 8> CornersOf(const Bounds& bounds) {
  std::array<Float3, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {(i & 1) != 0 ? bounds.high.x : bounds.low.x,
                  (i & 2) != 0 ? bounds.high.y : bounds.low.y,
                  (i & 4) != 0 ? bounds.high.z : bounds.low.z};
  }
  return corners;
}

Bounds BoundsOf(const std::vector<Float3>& points) {
  Bounds bounds = {points.front(), points.front()};
  for (const Float3& p : points) {
    bounds.low = {std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y),
                  std::min(bounds.low.z, p.z)};
    bounds.high = {std::max(bounds.high.x, p.x), std::max(bounds.high.y, p.y),
                   std::max(bounds.high.z, p.z)};
  }
  return bounds;
}

// The nearest camera that looks at the middle of a box and sees every point
// added: |x| <= slope (distance - depth).
class Framing {
 public:
  Framing(const Bounds& bounds, const Direction& direction,
          float field_of_view_deg, float aspect)
      : centre_(CentreOf(bounds)),
        back_(Towards(direction)),
        up_(UpFor(direction)),
        right_(Cross(up_, back_)),
        field_of_view_deg_(field_of_view_deg),
        up_slope_(kFilled * Tangent(0.5f * field_of_view_deg)),
        right_slope_(up_slope_ * aspect),
        distance_(0.1f * RadiusOf(bounds)) {}

  void Add(Float3 point) {
    const Float3 offset = point - centre_;
    const float depth = Dot(offset, back_);
    distance_ = std::max({distance_,
                          depth + std::fabs(Dot(offset, right_)) / right_slope_,
                          depth + std::fabs(Dot(offset, up_)) / up_slope_});
  }

  Camera camera() const {
    return {centre_ + distance_ * back_, centre_, up_, field_of_view_deg_};
  }

 private:
  const Float3 centre_;
  const Float3 back_;
  const Float3 up_;
  const Float3 right_;
  const float field_of_view_deg_;
  const float up_slope_;
  const float right_slope_;
  float distance_;
};

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
  Framing framing(bounds, direction, field_of_view_deg, aspect);
  for (const Float3& corner : CornersOf(bounds)) framing.Add(corner);
  return framing.camera();
}

Camera FrameScene(const Scene& scene, const Bounds& bounds,
                  const Direction& direction, float field_of_view_deg,
                  float aspect) {
  Framing framing(bounds, direction, field_of_view_deg, aspect);
  for (const SceneObject& object : scene.objects) {
    const std::vector<Float3>& positions = object.mesh->positions;
    if (object.instances == nullptr) {
      for (const Float3& position : positions) framing.Add(position);
      continue;
    }
    const Instances& places = *object.instances;
    const std::array<Float3, 8> corners = CornersOf(BoundsOf(positions));
    for (std::size_t i = 0; i < places.count(); ++i) {
      const Float3 scale = places.scales[i];
      for (const Float3& corner : corners) {
        framing.Add(places.translations[i] +
                    Rotated(places.rotations[i],
                            {scale.x * corner.x, scale.y * corner.y,
                             scale.z * corner.z}));
      }
    }
  }
  return framing.camera();
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
