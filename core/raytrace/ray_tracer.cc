#include "core/raytrace/ray_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/det_math.h"
#include "core/mesh/float3.h"
#include "core/raytrace/samples.h"

namespace terrane::core {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kForever = std::numeric_limits<float>::infinity();
// A new ray begins this far off its surface, as a part of the largest
// coordinate: above the rounding of where rays meet surfaces.
constexpr float kLift = 1e-5f;
// Interpolated normals may lean away from the eye.
constexpr float kLeastEyeCosine = 1e-3f;
// Pixels between two looks at the stop token: under a millisecond.
constexpr int kPixelsPerLook = 16;

Float3 Product(Float3 a, Float3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

Float3 ToFloat3(const std::array<float, 3>& color) {
  return {color[0], color[1], color[2]};
}

// A point of the unit circle.
Float2 OnCircle(float turns) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(turns);
  return {static_cast<float>(DetCos(angle)), static_cast<float>(DetSin(angle))};
}

// The unit vector about `normal` whose cosine with it is given.
Float3 About(Float3 normal, float cosine, float turns) {
  const Float3 right = Perpendicular(normal);
  const Float3 ahead = Cross(normal, right);
  const Float2 circle = OnCircle(turns);
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return cosine * normal + (sine * circle.x) * right +
         (sine * circle.y) * ahead;
}

Ray RayFrom(const SurfacePoint& point, Float3 direction, float length) {
  const float size =
      std::max({std::fabs(point.position.x), std::fabs(point.position.y),
                std::fabs(point.position.z), point.distance});
  return {point.position + (kLift * size) * point.geometric_normal, direction,
          length};
}

ShadingAngles AnglesAt(const SurfacePoint& point, Float3 to_light,
                       Float3 to_eye) {
  ShadingAngles angles = AnglesOf(point.shading_normal, to_light, to_eye);
  angles.n_v = std::max(angles.n_v, kLeastEyeCosine);
  return angles;
}

Float3 Reflectance(const SurfacePoint& point, const Finish& finish,
                   const ShadingAngles& angles, bool with_specular) {
  const float specular = with_specular ? finish.Specular(angles) : 0;
  return finish.Diffuse(angles) *
             Product(ToFloat3(finish.base_color()), point.color) +
         Float3{specular, specular, specular};
}

// Where a path goes on, and what it brings along from there: reflectance times
// cosine over the density of the choice.
struct Turn {
  Float3 direction;
  Float3 weight;
};

// Chooses between the two parts of the reflectance as they reflect. False when
// the choice lies below the surface: nothing comes from there.
bool ChooseTurn(const SurfacePoint& point, const Finish& finish, Float3 to_eye,
                Float2 sample, Turn* turn) {
  const Float3 normal = point.shading_normal;
  const float specular =
      finish.SpecularAlbedo(std::max(Dot(normal, to_eye), kLeastEyeCosine));
  const Float3 color = Product(ToFloat3(finish.base_color()), point.color);
  const float diffuse = (color.x + color.y + color.z) / 3;
  const float share = specular > 0 ? specular / (specular + diffuse) : 0.0f;
  if (sample.x < share) {
    // A half vector with the density of the lobe, which the eye is mirrored at.
    const Float3 half =
        About(normal, finish.LobeCosine(sample.x / share), sample.y);
    const float eye_cosine = Dot(to_eye, half);
    if (eye_cosine <= 0) return false;
    turn->direction = 2 * eye_cosine * half - to_eye;
  } else {
    const float cosine = std::sqrt((sample.x - share) / (1 - share));
    turn->direction = About(normal, cosine, sample.y);
  }
  turn->direction = Normalized(turn->direction);
  const float n_l = Dot(normal, turn->direction);
  if (n_l <= 0 || Dot(point.geometric_normal, turn->direction) <= 0) {
    return false;
  }
  const ShadingAngles angles = AnglesAt(point, turn->direction, to_eye);
  const float lobe = finish.LobeDensity(angles.n_h) / (4 * angles.l_h);
  const float density = share * lobe + (1 - share) * n_l / kPi;
  if (density <= 0) return false;
  turn->weight = (n_l / density) * Reflectance(point, finish, angles, true);
  return true;
}

// Distance along the ray to a ground below it, or infinity.
float GroundDistance(const std::optional<Ground>& ground, const Ray& ray) {
  if (!ground.has_value() || ray.direction.z >= 0 ||
      ray.origin.z <= ground->height) {
    return kForever;
  }
  return (ground->height - ray.origin.z) / ray.direction.z;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const RayTracer>> RayTracer::Create(
    std::shared_ptr<const RayCaster> caster,
    const std::vector<Material>& materials, const PictureSpec& spec) {
  Violations violations;
  ValidatePicture(spec, "", &violations);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    ValidateMaterial(materials[i], "materials[" + std::to_string(i) + "].",
                     &violations);
  }
  if (!violations.empty()) return violations.ToStatus();
  return std::shared_ptr<const RayTracer>(
      new RayTracer(std::move(caster), materials, spec));
}

RayTracer::RayTracer(std::shared_ptr<const RayCaster> caster,
                     const std::vector<Material>& materials,
                     const PictureSpec& spec)
    : caster_(std::move(caster)), spec_(spec) {
  for (const Material& material : materials) {
    finishes_.emplace_back(material, spec.shading);
  }
  if (spec.ground.has_value()) {
    finishes_.emplace_back(spec.ground->material, spec.shading);
  }
  const Camera& camera = spec.camera;
  const double half_angle =
      static_cast<double>(camera.field_of_view_deg) * (std::numbers::pi / 360);
  const auto slope =
      static_cast<float>(DetSin(half_angle) / DetCos(half_angle));
  ahead_ = Normalized(camera.target - camera.eye);
  const Float3 right = Normalized(Cross(ahead_, camera.up));
  right_ = (slope * static_cast<float>(spec.width) /
            static_cast<float>(spec.height)) *
           right;
  above_ = slope * Cross(right, ahead_);
}

absl::Status RayTracer::AddPass(int pass, int first_row, int rows,
                                std::stop_token stop,
                                std::span<float> sums) const {
  float* sum = sums.data();
  for (int y = first_row; y < first_row + rows; ++y) {
    for (int x = 0; x < spec_.width; ++x, sum += 3) {
      if (x % kPixelsPerLook == 0 && stop.stop_requested()) {
        return absl::CancelledError("rendering stopped");
      }
      PixelSamples samples(spec_.seed, x, y, pass);
      const Float2 place = samples.Next();
      const Float3 radiance =
          Radiance(CameraRay(static_cast<float>(x) + place.x,
                             static_cast<float>(y) + place.y),
                   &samples);
      sum[0] += radiance.x;
      sum[1] += radiance.y;
      sum[2] += radiance.z;
    }
  }
  return absl::OkStatus();
}

Ray RayTracer::CameraRay(float x, float y) const {
  const float to_right = 2 * x / static_cast<float>(spec_.width) - 1;
  const float to_top = 1 - 2 * y / static_cast<float>(spec_.height);
  return {spec_.camera.eye,
          Normalized(ahead_ + to_right * right_ + to_top * above_), kForever};
}

bool RayTracer::Intersect(const Ray& ray, SurfacePoint* point) const {
  const bool met = caster_->Intersect(ray, point);
  const float down = GroundDistance(spec_.ground, ray);
  if (down >= ray.length || (met && point->distance <= down)) return met;
  *point = {.distance = down,
            .position = ray.origin + down * ray.direction,
            .geometric_normal = {0, 0, 1},
            .shading_normal = {0, 0, 1},
            .material = static_cast<std::uint32_t>(finishes_.size() - 1)};
  point->position.z = spec_.ground->height;
  return true;
}

bool RayTracer::Occluded(const Ray& ray) const {
  return GroundDistance(spec_.ground, ray) < ray.length ||
         caster_->Occluded(ray);
}

Float3 RayTracer::SkyRadiance(Float3 direction) const {
  const float height = std::max(0.0f, direction.z);
  return spec_.sky.horizon + height * (spec_.sky.zenith - spec_.sky.horizon);
}

float RayTracer::GroundShare(const SurfacePoint& point) const {
  if (!spec_.ground.has_value() || point.material + 1 != finishes_.size()) {
    return 1;
  }
  const Ground& ground = *spec_.ground;
  const Float3 offset = {point.position.x - ground.centre.x,
                         point.position.y - ground.centre.y, 0};
  const float t = std::clamp((ground.fade_end - Length(offset)) /
                                 (ground.fade_end - ground.fade_begin),
                             0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

Float3 RayTracer::DirectLight(const SurfacePoint& point, const Finish& finish,
                              Float3 to_eye, bool with_specular,
                              Float2 sample) const {
  if (!spec_.light.has_value()) return {};
  const AreaLight& light = *spec_.light;
  const Float3 source = light.centre + (2 * sample.x - 1) * light.half_u +
                        (2 * sample.y - 1) * light.half_v;
  const Float3 way = source - point.position;
  const float distance = Length(way);
  if (distance == 0) return {};
  const Float3 to_light = (1 / distance) * way;
  const float n_l = Dot(point.shading_normal, to_light);
  // Four times the light's area, as seen from here.
  const float facing = -4 * Dot(Cross(light.half_u, light.half_v), to_light);
  if (n_l <= 0 || facing <= 0 || Dot(point.geometric_normal, to_light) <= 0 ||
      Occluded(RayFrom(point, to_light, distance))) {
    return {};
  }
  return (n_l * facing / (distance * distance)) *
         Product(light.radiance,
                 Reflectance(point, finish, AnglesAt(point, to_light, to_eye),
                             with_specular));
}

Float3 RayTracer::Radiance(Ray ray, PixelSamples* samples) const {
  Float3 sum;
  Float3 throughput = {1, 1, 1};
  for (int bounce = 0;; ++bounce) {
    SurfacePoint point;
    if (!Intersect(ray, &point)) {
      return sum + Product(throughput, SkyRadiance(ray.direction));
    }
    if (bounce == 0) {
      const float share = GroundShare(point);
      sum = (1 - share) * spec_.sky.horizon;
      throughput = {share, share, share};
      if (share == 0) return sum;
    }
    const Finish& finish = finishes_[point.material];
    const Float3 to_eye = -1.0f * ray.direction;
    sum = sum + Product(throughput, DirectLight(point, finish, to_eye,
                                                bounce == 0, samples->Next()));
    Turn turn;
    if (!ChooseTurn(point, finish, to_eye, samples->Next(), &turn)) return sum;
    throughput = Product(throughput, turn.weight);
    ray = RayFrom(point, turn.direction, kForever);
    if (bounce == spec_.bounces) {
      if (Occluded(ray)) return sum;
      return sum + Product(throughput, SkyRadiance(ray.direction));
    }
  }
}

}  // namespace terrane::core
