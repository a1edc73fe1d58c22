#include <cmath>

#include "core/base/field_checks.h"
#include "core/mesh/float3.h"
#include "core/raytrace/ray_tracer.h"

namespace terrane::core {
namespace {

// Of coordinates; their squares and products stay finite.
constexpr Range kCoordinates = {-1e15, 1e15};
constexpr Range kRadiances = {0, 1e15};
constexpr Range kShares = {0, 1};

void CheckVector(const Path& path, Float3 value, const Range& range,
                 FieldChecks* checks) {
  checks->Number(path.Field("x"), static_cast<double>(value.x), range);
  checks->Number(path.Field("y"), static_cast<double>(value.y), range);
  checks->Number(path.Field("z"), static_cast<double>(value.z), range);
}

void CheckMaterial(const Path& path, const Material& material,
                   FieldChecks* checks) {
  for (std::size_t i = 0; i < material.base_color.size(); ++i) {
    checks->Number(path.Element("base_color", i),
                   static_cast<double>(material.base_color[i]), kShares);
  }
  checks->Number(path.Field("roughness"),
                 static_cast<double>(material.roughness), kShares);
  checks->Number(path.Field("specular"), static_cast<double>(material.specular),
                 kShares);
  checks->Number(path.Field("gloss"), static_cast<double>(material.Gloss()),
                 kShares);
}

void CheckCamera(const Path& path, const Camera& camera, FieldChecks* checks) {
  CheckVector(path.Field("eye"), camera.eye, kCoordinates, checks);
  CheckVector(path.Field("target"), camera.target, kCoordinates, checks);
  CheckVector(path.Field("up"), camera.up, kCoordinates, checks);
  checks->Number(path.Field("field_of_view_deg"),
                 static_cast<double>(camera.field_of_view_deg),
                 {0, 170, true, false});
  const Float3 ahead = camera.target - camera.eye;
  if (Length(ahead) == 0) {
    checks->Violate(path.Field("target"), "must not be where the eye is");
  } else if (Length(Cross(ahead, camera.up)) == 0) {
    checks->Violate(path.Field("up"), "must not lie along the line of sight");
  }
}

}  // namespace

void ValidateMaterial(const Material& material, const std::string& prefix,
                      Violations* violations) {
  FieldChecks checks(violations);
  CheckMaterial(Path(&prefix), material, &checks);
}

void ValidatePicture(const PictureSpec& spec, const std::string& prefix,
                     Violations* violations) {
  FieldChecks checks(violations);
  const Path root(&prefix);
  checks.Integer(root.Field("width"), spec.width, 1, kMaxPictureSide);
  checks.Integer(root.Field("height"), spec.height, 1, kMaxPictureSide);
  checks.Integer(root.Field("bounces"), spec.bounces, 0, kMaxBounces);
  CheckCamera(root.Field("camera"), spec.camera, &checks);
  if (spec.light.has_value()) {
    const Path light = root.Field("light");
    CheckVector(light.Field("centre"), spec.light->centre, kCoordinates,
                &checks);
    CheckVector(light.Field("half_u"), spec.light->half_u, kCoordinates,
                &checks);
    CheckVector(light.Field("half_v"), spec.light->half_v, kCoordinates,
                &checks);
    CheckVector(light.Field("radiance"), spec.light->radiance, kRadiances,
                &checks);
  }
  const Path sky = root.Field("sky");
  CheckVector(sky.Field("zenith"), spec.sky.zenith, kRadiances, &checks);
  CheckVector(sky.Field("horizon"), spec.sky.horizon, kRadiances, &checks);
  if (!spec.ground.has_value()) return;
  const Path ground = root.Field("ground");
  checks.Number(ground.Field("height"),
                static_cast<double>(spec.ground->height), kCoordinates);
  CheckMaterial(ground.Field("material"), spec.ground->material, &checks);
  if (!(spec.ground->fade_begin > 0 &&
        spec.ground->fade_end > spec.ground->fade_begin)) {
    checks.Violate(ground.Field("fade_end"), "must be above fade_begin");
  }
}

}  // namespace terrane::core
