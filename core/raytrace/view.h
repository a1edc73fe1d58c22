// What a traced picture shows beside the scene: the camera, an area light, the
// sky, the ground.
//
// z is up. Lengths in the scene's unit. Radiances are linear red, green, blue;
// 1 is drawn white. Plain data; pure functions, safe from any thread; the same
// bits everywhere.
#ifndef TERRANE_CORE_RAYTRACE_VIEW_H_
#define TERRANE_CORE_RAYTRACE_VIEW_H_

#include "core/mesh/mesh.h"
#include "core/mesh/scene.h"
#include "core/raytrace/traced_scene.h"

namespace terrane::core {

// A pinhole camera.
struct Camera {
  Float3 eye = {0, -1, 0};
  Float3 target;                 // in the middle of the picture; not the eye
  Float3 up = {0, 0, 1};         // not along the line of sight
  float field_of_view_deg = 30;  // from bottom to top, (0, 170]
};

// A rectangle that shines to the side of edge_u x edge_v. Not seen itself, only
// what it lights.
struct AreaLight {
  Float3 centre;
  Float3 half_u;  // from the centre to the middle of an edge
  Float3 half_v;
  Float3 radiance;
};

// Light from everywhere; what is seen where nothing is. Between the two by the
// sine of the elevation, below the horizon as at it.
struct Sky {
  Float3 zenith = {0.40f, 0.46f, 0.55f};
  Float3 horizon = {0.68f, 0.69f, 0.70f};
};

// A level plane without an end, seen from above. It fades to the horizon's
// colour between two distances from `centre`.
struct Ground {
  float height = 0;  // z
  Material material;
  Float2 centre;
  float fade_begin = 1e6f;  // above 0
  float fade_end = 2e6f;    // above fade_begin
};

// How a camera or a light looks at a scene.
struct Direction {
  double turn_deg = 0;  // clockwise from south, seen from above, [-360, 360]
  double tilt_deg = 0;  // above the horizon, [-90, 90]
};

// The unit vector from a scene towards who looks at it from there.
Float3 Towards(const Direction& direction);

// The camera in that direction from which the whole box is just in the picture.
// `aspect` is width / height.
Camera FrameCamera(const Bounds& bounds, const Direction& direction,
                   float field_of_view_deg, float aspect);

// A square light that looks at the box from that direction. Distance and half
// its side are in radii of the box; a plane in the middle of the box that faces
// it receives `irradiance`, when the light is small.
struct LightPlace {
  Direction direction = {-50, 50};
  double distance = 20;
  double half_side = 2.4;
  Float3 irradiance = {2.5f, 2.35f, 2.1f};
};
AreaLight PlaceLight(const Bounds& bounds, const LightPlace& place);

// A ground under the box that fades before it looks endless.
Ground PlaceGround(const Bounds& bounds, const Material& material);

// Half the box's diagonal, above 0.
float RadiusOf(const Bounds& bounds);

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_VIEW_H_
