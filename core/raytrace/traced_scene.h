// TracedScene: a Scene that rays can be cast into, through Embree.
//
// Instances stay instances: a mesh is in memory once, however often it stands.
// A TracedScene is immutable, and safe from any thread; it keeps positions of
// its own, and reads indices, normals, colours and instances from the meshes
// that it was made of, which must outlive it.
//
// Errors: INVALID_ARGUMENT for a scene that does not hang together,
// RESOURCE_EXHAUSTED for one above its budget, CANCELLED, INTERNAL with
// Embree's own words.
//
// Determinism: the same scene gives the same hits, whatever thread asks. Embree
// picks its kernels by the CPU: another kind of CPU may differ in a hit's last
// digits, so that a picture is the same only on the same kind.
#ifndef TERRANE_CORE_RAYTRACE_TRACED_SCENE_H_
#define TERRANE_CORE_RAYTRACE_TRACED_SCENE_H_

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/mesh/mesh.h"
#include "core/mesh/scene.h"
#include "core/raytrace/ray.h"

// Embree's own, of rtcore.h.
struct RTCSceneTy;

namespace terrane::core {

// A box with its sides along the axes.
struct Bounds {
  Float3 low;
  Float3 high;

  bool operator==(const Bounds&) const = default;
};

// What a scene holds, before anything is built.
struct SceneSize {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;  // of the meshes, each counted once
  std::int64_t instances = 0;
};
SceneSize SizeOf(const Scene& scene);

// An upper bound of the memory that tracing a scene of this size takes beside
// its meshes.
std::int64_t TracedBytes(const SceneSize& size);

class TracedScene final : public RayCaster {
 public:
  // Most instances of a scene.
  static constexpr std::int64_t kMaxInstances = 4'000'000;

  // Builds on the calling thread. `budget_bytes` holds against TracedBytes.
  // `stop` is polled as often as Embree reports progress.
  static absl::StatusOr<std::shared_ptr<const TracedScene>> Build(
      const Scene& scene, std::int64_t budget_bytes, std::stop_token stop);

  ~TracedScene() override;
  TracedScene(const TracedScene&) = delete;
  TracedScene& operator=(const TracedScene&) = delete;

  bool Intersect(const Ray& ray, SurfacePoint* point) const override;
  bool Occluded(const Ray& ray) const override;

  const Bounds& bounds() const { return bounds_; }
  const std::vector<Material>& materials() const { return scene_.materials; }
  // What Embree has allocated.
  std::int64_t allocated_bytes() const;
  // For who casts rays without us.
  RTCSceneTy* embree_scene() const;

 private:
  class Embree;
  // What a geometry of the top level is.
  struct Placed {
    std::uint32_t object = 0;
    std::uint32_t instance = 0;  // of an object that has instances
  };

  explicit TracedScene(const Scene& scene);
  absl::Status BuildObjects(std::stop_token stop);

  const Scene scene_;
  const std::unique_ptr<Embree> embree_;
  std::vector<Placed> placed_;
  Bounds bounds_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_TRACED_SCENE_H_
