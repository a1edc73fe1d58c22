// The shading model of Wang, Zhang & Yang 2019, section 2, and the older ones
// that it is compared with.
//
// With l to the light, v to the eye, n the normal, h half way between l and v,
// the reflectance (BRDF, 1/sr) is f = f_d + D F V / pi, where
//   f_d = Bc/pi (1 + (F90 - 1)(1 - n.l)^5)(1 + (F90 - 1)(1 - n.v)^5)
//   F90 = 0.5 + 2 Rn (h.l)^2                            (Disney's diffuse)
//   D = (a + 2)/8 (n.h)^a,  a = 8192^g                  (Lazarov's specular)
//   F = r0 + (1 - r0) 2^(-10 l.h)
//   V = 1 / (k (l.h)^2 + 1 - k),  k = min(1, g + 0.545)
// D as printed is pi/4 times the normalised lobe, hence the 1/pi.
//
// kLiteral is this. Its diffuse part gains energy at grazing angles (1.40 of
// the incoming light at 85 degrees for Rn = 1). kConserving reflects no more
// than it receives: F90 = 0.5 Rn + 2 Rn (h.l)^2 and a factor of 1 - Rn +
// Rn/1.51 (Frostbite's renormalisation; and where that is not enough, next to
// the horizon, the rest), times (1 - E(n.l))(1 - E(n.v)), E being what the
// specular part reflects of light from everywhere. kLambert is Bc/pi alone,
// kBlinnPhong that and r0 D / pi.
//
// Every model is reciprocal: f does not change when l and v change places.
// Threads: a Finish is immutable. Determinism: IEEE operations and
// core/base/det_math.h, the same bits everywhere.
#ifndef TERRANE_CORE_RAYTRACE_SHADING_H_
#define TERRANE_CORE_RAYTRACE_SHADING_H_

#include <array>
#include <cstddef>

#include "core/mesh/mesh.h"
#include "core/mesh/scene.h"

namespace terrane::core {

enum class ShadingModel { kConserving, kLiteral, kLambert, kBlinnPhong };

// The cosines between normal, light, eye and half vector, all in (0, 1].
struct ShadingAngles {
  float n_l = 1;
  float n_v = 1;
  float n_h = 1;
  float l_h = 1;
};

// Of unit vectors with n.l > 0 and n.v > 0. l.h is at least 1e-4, as V has a
// pole at 0.
ShadingAngles AnglesOf(Float3 normal, Float3 to_light, Float3 to_eye);

// A material made ready for one model: what it reflects from where to where.
// The material's fields must be in their ranges.
class Finish {
 public:
  Finish(const Material& material, ShadingModel model);

  // The two parts of the BRDF, 1/sr: the diffuse one for a base colour of 1.
  float Diffuse(const ShadingAngles& angles) const;
  float Specular(const ShadingAngles& angles) const;

  // What the specular part reflects, towards an eye at n.v, of a white sky.
  float SpecularAlbedo(float n_v) const;

  // Half vectors drawn by the specular lobe: their density, (a + 2)/(2 pi)
  // (n.h)^(a + 1) per steradian, and the n.h of one by an even u in [0, 1).
  float LobeDensity(float n_h) const;
  float LobeCosine(float u) const;

  const std::array<float, 3>& base_color() const { return base_color_; }
  // a, of the lobe (n.h)^a.
  double exponent() const { return exponent_; }

 private:
  // By n.v = (i / (count - 1))^2: dense towards the horizon, where they turn.
  static constexpr std::size_t kAlbedos = 33;
  using Albedos = std::array<float, kAlbedos>;

  float DiffuseShape(const ShadingAngles& angles) const;
  Albedos IntegrateSpecular() const;
  Albedos IntegrateDiffuse() const;
  static float AlbedoAt(const Albedos& albedos, float n_v);

  const ShadingModel model_;
  const std::array<float, 3> base_color_;
  const float roughness_;
  const float specular_;  // r0
  const double exponent_;
  const float visibility_;   // k
  Albedos specular_albedo_;  // E
  Albedos diffuse_albedo_;   // of DiffuseShape, kConserving only
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_SHADING_H_
