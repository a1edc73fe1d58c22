#include "core/raytrace/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/det_math.h"
#include "core/mesh/float3.h"
#include "core/raytrace/quick_math.h"

namespace terrane::core {
namespace {

constexpr float kInversePi = std::numbers::inv_pi_v<float>;
constexpr float kLeastCosine = 1e-4f;
// Frostbite's: the largest albedo of Disney's diffuse with its F90.
constexpr float kDiffuseExcess = 1.51f;
// Midpoints of the albedo integrals: enough for 1e-3 of them.
constexpr int kLatitudes = 32;
constexpr int kLongitudes = 32;  // of half a turn, the other mirrors it

float FifthPower(float x) {
  const float square = x * x;
  return square * square * x;
}

float Power(float base, double exponent) {
  return static_cast<float>(QuickPower(static_cast<double>(base), exponent));
}

// A unit vector by its z and its place on the circle around the z axis.
Float3 OnSphere(float z, Float2 circle) {
  const float radius = std::sqrt(std::max(0.0f, 1 - z * z));
  return {radius * circle.x, radius * circle.y, z};
}

// The mean of term(direction) over directions of all longitudes whose z is
// z_of(u), u even in [0, 1].
template <typename ZOf, typename Term>
float MeanOverDirections(const ZOf& z_of, const Term& term) {
  std::array<Float2, kLongitudes> circle;
  for (int j = 0; j < kLongitudes; ++j) {
    const double angle = std::numbers::pi * (j + 0.5) / kLongitudes;
    circle[static_cast<std::size_t>(j)] = {static_cast<float>(DetCos(angle)),
                                           static_cast<float>(DetSin(angle))};
  }
  double sum = 0;
  for (int i = 0; i < kLatitudes; ++i) {
    const float z = z_of((static_cast<float>(i) + 0.5f) / kLatitudes);
    for (const Float2& place : circle) {
      sum += static_cast<double>(term(OnSphere(z, place)));
    }
  }
  return static_cast<float>(sum / (kLatitudes * kLongitudes));
}

}  // namespace

ShadingAngles AnglesOf(Float3 normal, Float3 to_light, Float3 to_eye) {
  const Float3 half = Normalized(to_light + to_eye);
  return {Dot(normal, to_light), Dot(normal, to_eye),
          std::min(1.0f, std::max(0.0f, Dot(normal, half))),
          std::max(kLeastCosine, Dot(to_light, half))};
}

Finish::Finish(const Material& material, ShadingModel model)
    : model_(model),
      base_color_(material.base_color),
      roughness_(material.roughness),
      specular_(material.specular),
      exponent_(DetExp2(13.0 * static_cast<double>(material.Gloss()))),
      visibility_(std::min(1.0f, material.Gloss() + 0.545f)),
      specular_albedo_(IntegrateSpecular()),
      diffuse_albedo_(IntegrateDiffuse()) {}

float Finish::DiffuseShape(const ShadingAngles& angles) const {
  const bool conserving = model_ == ShadingModel::kConserving;
  const float at_normal = conserving ? 0.5f * roughness_ : 0.5f;
  const float scale =
      conserving ? 1 - roughness_ + roughness_ / kDiffuseExcess : 1.0f;
  const float f90 = at_normal + 2 * roughness_ * angles.l_h * angles.l_h;
  return scale * (1 + (f90 - 1) * FifthPower(1 - angles.n_l)) *
         (1 + (f90 - 1) * FifthPower(1 - angles.n_v));
}

float Finish::Diffuse(const ShadingAngles& angles) const {
  if (model_ == ShadingModel::kLambert || model_ == ShadingModel::kBlinnPhong) {
    return kInversePi;
  }
  const float diffuse = kInversePi * DiffuseShape(angles);
  if (model_ == ShadingModel::kLiteral) return diffuse;
  const float most = std::max({1.0f, AlbedoAt(diffuse_albedo_, angles.n_l),
                               AlbedoAt(diffuse_albedo_, angles.n_v)});
  return diffuse / most * (1 - SpecularAlbedo(angles.n_l)) *
         (1 - SpecularAlbedo(angles.n_v));
}

float Finish::Specular(const ShadingAngles& angles) const {
  if (model_ == ShadingModel::kLambert) return 0;
  const float distribution =
      static_cast<float>((exponent_ + 2) / 8) * Power(angles.n_h, exponent_);
  if (model_ == ShadingModel::kBlinnPhong) {
    return kInversePi * specular_ * distribution;
  }
  const auto fall =
      static_cast<float>(QuickExp2(-10.0 * static_cast<double>(angles.l_h)));
  const float fresnel = specular_ + (1 - specular_) * fall;
  const float visibility =
      1 / (visibility_ * angles.l_h * angles.l_h + (1 - visibility_));
  return kInversePi * distribution * fresnel * visibility;
}

float Finish::LobeDensity(float n_h) const {
  return static_cast<float>(exponent_ + 2) /
         (2 * std::numbers::pi_v<float>)*n_h * Power(n_h, exponent_);
}

float Finish::LobeCosine(float u) const {
  return Power(u, 1 / (exponent_ + 2));
}

// Over half vectors with the density of the lobe, (a + 2)/(2 pi) (n.h)^(a + 1),
// so that a sharp one needs no more of them; dl = 4 l.h dh.
Finish::Albedos Finish::IntegrateSpecular() const {
  Albedos albedos = {};
  if (model_ == ShadingModel::kLambert) return albedos;
  const auto lobe = [this](float u) { return LobeCosine(u); };
  for (std::size_t i = 0; i < kAlbedos; ++i) {
    const float root = static_cast<float>(i) / (kAlbedos - 1);
    const float n_v = std::max(kLeastCosine, root * root);
    const Float3 eye = OnSphere(n_v, {1, 0});
    albedos[i] = MeanOverDirections(lobe, [&](Float3 half) {
      const float l_h = Dot(eye, half);
      const float n_l = 2 * l_h * half.z - eye.z;
      if (l_h <= 0 || n_l <= 0) return 0.0f;
      const ShadingAngles angles = {n_l, n_v, 1, std::max(kLeastCosine, l_h)};
      // Specular at n.h = 1 over the density without its power.
      return Specular(angles) * n_l * 4 * l_h * std::numbers::pi_v<float> * 2 /
             (static_cast<float>(exponent_ + 2) * half.z);
    });
  }
  return albedos;
}

// Over directions with the density of the cosine.
Finish::Albedos Finish::IntegrateDiffuse() const {
  Albedos albedos = {};
  if (model_ != ShadingModel::kConserving) return albedos;
  const auto cosine = [](float u) { return std::sqrt(u); };
  for (std::size_t i = 0; i < kAlbedos; ++i) {
    const float root = static_cast<float>(i) / (kAlbedos - 1);
    const Float3 eye = OnSphere(root * root, {1, 0});
    albedos[i] = MeanOverDirections(cosine, [&](Float3 light) {
      return DiffuseShape(AnglesOf({0, 0, 1}, light, eye));
    });
  }
  return albedos;
}

float Finish::AlbedoAt(const Albedos& albedos, float n_v) {
  const float place = std::sqrt(std::min(1.0f, n_v)) * (kAlbedos - 1);
  const auto i = std::min(static_cast<std::size_t>(place), kAlbedos - 2);
  const float t = place - static_cast<float>(i);
  return albedos[i] + t * (albedos[i + 1] - albedos[i]);
}

float Finish::SpecularAlbedo(float n_v) const {
  return AlbedoAt(specular_albedo_, n_v);
}

}  // namespace terrane::core
