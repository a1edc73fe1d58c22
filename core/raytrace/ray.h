// Rays, and what they meet.
#ifndef TERRANE_CORE_RAYTRACE_RAY_H_
#define TERRANE_CORE_RAYTRACE_RAY_H_

#include <cstdint>

#include "core/mesh/mesh.h"

namespace terrane::core {

// The points origin + t direction, 0 < t < length; direction is a unit vector.
struct Ray {
  Float3 origin;
  Float3 direction;
  float length = 0;  // may be infinite
};

// Where a ray meets a surface. Normals are unit vectors on the side that the
// ray comes from.
struct SurfacePoint {
  float distance = 0;  // along the ray
  Float3 position;
  Float3 geometric_normal;  // of the triangle
  Float3 shading_normal;    // interpolated between its vertices
  Float3 color = {1, 1, 1};
  std::uint32_t material = 0;
};

// What rays are asked of. Immutable, safe from any thread.
class RayCaster {
 public:
  virtual ~RayCaster() = default;

  // Whether the ray meets anything, and if so where it does first. One-sided
  // materials are not seen from behind.
  virtual bool Intersect(const Ray& ray, SurfacePoint* point) const = 0;
  // Whether anything stands in the ray's way, from whatever side.
  virtual bool Occluded(const Ray& ray) const = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_RAY_H_
