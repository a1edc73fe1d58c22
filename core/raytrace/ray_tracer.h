// RayTracer: pictures of a scene, one sample a pixel and pass at a time.
//
// A path leaves the eye through a pixel, meets a surface, is lit there by one
// random point of the area light, and goes on: into the lobe of the material or
// anywhere above the surface, up to `bounces` times more. What leaves the scene
// brings the sky's light along; after the last bounce the sky is seen or it is
// not (ambient occlusion). The light's own highlights are seen on the first
// surface only: caustics would take thousands of passes. The mean over the
// passes tends to the radiance, by the shading model of
// core/raytrace/shading.h.
//
// A RayTracer is immutable; any thread may make any rows of any pass.
// Determinism: a sample is a pure function of (scene, spec, pixel, pass), so
// that a picture depends neither on threads nor on the order of rows. Passes
// are to be added in order: floating-point sums remember it.
#ifndef TERRANE_CORE_RAYTRACE_RAY_TRACER_H_
#define TERRANE_CORE_RAYTRACE_RAY_TRACER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "core/raytrace/ray.h"
#include "core/raytrace/shading.h"
#include "core/raytrace/view.h"

namespace terrane::core {

class PixelSamples;

struct PictureSpec {
  int width = 800;   // pixels, [1, kMaxPictureSide]
  int height = 600;  // pixels, [1, kMaxPictureSide]
  ShadingModel shading = ShadingModel::kConserving;
  // Surfaces that a path meets after the first one, [0, kMaxBounces].
  int bounces = 1;
  std::int64_t seed = 0;
  Camera camera;
  std::optional<AreaLight> light;
  Sky sky;
  std::optional<Ground> ground;
};

inline constexpr int kMaxPictureSide = 16'384;
inline constexpr int kMaxBounces = 16;

// Adds a violation for each field outside its range, by its path after
// `prefix`.
void ValidatePicture(const PictureSpec& spec, const std::string& prefix,
                     Violations* violations);
// The same for a material's fields.
void ValidateMaterial(const Material& material, const std::string& prefix,
                      Violations* violations);

class RayTracer {
 public:
  // `materials` are those that the caster's points name. Errors:
  // INVALID_ARGUMENT with violations.
  static absl::StatusOr<std::shared_ptr<const RayTracer>> Create(
      std::shared_ptr<const RayCaster> caster,
      const std::vector<Material>& materials, const PictureSpec& spec);

  const PictureSpec& spec() const { return spec_; }

  // Adds pass `pass` (0, 1, ...) of `rows` rows from `first_row` on to `sums`:
  // three floats a pixel, row-major, top row first. Errors: CANCELLED when
  // `stop` was asked to, polled at least every millisecond; `sums` then holds a
  // part of the pass.
  absl::Status AddPass(int pass, int first_row, int rows, std::stop_token stop,
                       std::span<float> sums) const;

 private:
  RayTracer(std::shared_ptr<const RayCaster> caster,
            const std::vector<Material>& materials, const PictureSpec& spec);

  Ray CameraRay(float x, float y) const;
  bool Intersect(const Ray& ray, SurfacePoint* point) const;
  bool Occluded(const Ray& ray) const;
  Float3 SkyRadiance(Float3 direction) const;
  Float3 DirectLight(const SurfacePoint& point, const Finish& finish,
                     Float3 to_eye, bool with_specular, Float2 sample) const;
  Float3 Radiance(Ray ray, PixelSamples* samples) const;
  // How much of the ground is seen at a distance from its centre.
  float GroundShare(const SurfacePoint& point) const;

  const std::shared_ptr<const RayCaster> caster_;
  const PictureSpec spec_;
  std::vector<Finish> finishes_;  // by material; the ground's is the last
  // From the eye to the middle of the picture, to its right edge and its upper
  // one.
  Float3 ahead_;
  Float3 right_;
  Float3 above_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_RAY_TRACER_H_
