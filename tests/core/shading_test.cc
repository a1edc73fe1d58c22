// The shading models: white furnaces against the values of the method, energy,
// reciprocity, positivity.
#include "core/raytrace/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/mesh/float3.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Float3 kUp = {0, 0, 1};

Material Of(float roughness, float gloss, float specular) {
  Material material;
  material.base_color = {1, 1, 1};
  material.roughness = roughness;
  material.gloss = gloss;
  material.specular = specular;
  return material;
}

Float3 OnDome(double cosine, double turns) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {static_cast<float>(sine * std::cos(2 * kPi * turns)),
          static_cast<float>(sine * std::sin(2 * kPi * turns)),
          static_cast<float>(cosine)};
}

struct Albedo {
  double diffuse = 0;
  double specular = 0;
  double total() const { return diffuse + specular; }
};

// What a white sky sends towards the eye, by midpoints: of the diffuse part
// over the light's direction, of the specular one over the half vector's, which
// resolves the sharpest lobe. Half a turn, the other mirrors it.
Albedo Furnace(const Finish& finish, double n_v) {
  constexpr int kSteps = 160;
  const Float3 eye = OnDome(n_v, 0);
  const double exponent = finish.exponent();
  Albedo sum;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    for (int j = 0; j < kSteps; ++j) {
      const double turns = 0.5 * (j + 0.5) / kSteps;
      sum.diffuse += kPi * static_cast<double>(finish.Diffuse(AnglesOf(
                               kUp, OnDome(std::sqrt(u), turns), eye)));
      const double n_h = std::pow(u, 1 / (exponent + 2));
      const Float3 half = OnDome(n_h, turns);
      const double l_h = static_cast<double>(Dot(eye, half));
      const double n_l = 2 * l_h * n_h - n_v;
      if (l_h <= 0 || n_l <= 0) continue;
      const double density =
          (exponent + 2) / (2 * kPi) * std::pow(n_h, exponent + 1) / (4 * l_h);
      const ShadingAngles angles = {
          static_cast<float>(n_l), static_cast<float>(n_v),
          static_cast<float>(n_h), static_cast<float>(std::max(l_h, 1e-4))};
      sum.specular +=
          static_cast<double>(finish.Specular(angles)) * n_l / density;
    }
  }
  return {sum.diffuse / (kSteps * kSteps), sum.specular / (kSteps * kSteps)};
}

TEST(Shading, SpecularFurnaceHasTheValuesOfTheMethod) {
  const double expected[] = {0.375, 0.775, 0.978, 0.998, 1.000};
  for (int i = 0; i < 5; ++i) {
    const float gloss = 0.25f * static_cast<float>(i);
    const Finish finish(Of(0.5f, gloss, 1), ShadingModel::kLiteral);
    const Albedo albedo = Furnace(finish, 1);
    EXPECT_NEAR(albedo.specular, expected[i], 0.01) << "g = " << gloss;
    // Without the 1/pi, as printed, it would be up to 3.14.
    EXPECT_NEAR(kPi * albedo.specular, kPi * expected[i], 0.0315);
  }
}

TEST(Shading, LiteralDiffuseGainsEnergyAtGrazingAngles) {
  const double n_v = std::cos(85 * kPi / 180);
  const Finish literal(Of(1, 0, 0.04f), ShadingModel::kLiteral);
  EXPECT_NEAR(Furnace(literal, n_v).diffuse, 1.40, 0.01);
  const Finish lambert(Of(1, 0, 0.04f), ShadingModel::kLambert);
  EXPECT_NEAR(Furnace(lambert, n_v).total(), 1, 1e-4);
}

TEST(Shading, ConservingModeReflectsNoMoreThanItReceives) {
  double most = 0;
  for (const float roughness : {0.0f, 0.3f, 0.7f, 1.0f}) {
    for (const float gloss : {0.0f, 0.5f, 1.0f}) {
      for (const float specular : {0.0f, 0.04f, 0.5f, 1.0f}) {
        const Finish finish(Of(roughness, gloss, specular),
                            ShadingModel::kConserving);
        for (const double degrees : {0.0, 40.0, 70.0, 85.0, 88.0, 89.5, 89.9}) {
          const double albedo =
              Furnace(finish, std::cos(degrees * kPi / 180)).total();
          EXPECT_LE(albedo, 1.001)
              << roughness << " " << gloss << " " << specular << " " << degrees;
          most = std::max(most, albedo);
        }
      }
    }
  }
  // Nor much less, where a mirror is asked for.
  EXPECT_GT(most, 0.99);
}

TEST(Shading, TabulatedSpecularAlbedoIsTheFurnace) {
  for (const float gloss : {0.0f, 0.4f, 1.0f}) {
    const Finish finish(Of(0.5f, gloss, 0.04f), ShadingModel::kConserving);
    for (const double n_v : {0.05, 0.3, 0.7, 1.0}) {
      EXPECT_NEAR(
          static_cast<double>(finish.SpecularAlbedo(static_cast<float>(n_v))),
          Furnace(finish, n_v).specular, 0.01)
          << gloss << " " << n_v;
    }
  }
}

std::vector<Float3> Directions() {
  std::vector<Float3> directions;
  for (int i = 0; i < 40; ++i) {
    directions.push_back(OnDome((i + 0.5) / 40, 0.618033988749895 * i));
  }
  return directions;
}

TEST(Shading, EveryModelIsReciprocalAndPositive) {
  for (const ShadingModel model :
       {ShadingModel::kConserving, ShadingModel::kLiteral,
        ShadingModel::kLambert, ShadingModel::kBlinnPhong}) {
    for (const float gloss : {0.0f, 0.6f, 1.0f}) {
      const Finish finish(Of(1 - gloss, gloss, 0.04f), model);
      for (const Float3 l : Directions()) {
        for (const Float3 v : Directions()) {
          const ShadingAngles there = AnglesOf(kUp, l, v);
          const ShadingAngles back = AnglesOf(kUp, v, l);
          const float diffuse = finish.Diffuse(there);
          const float specular = finish.Specular(there);
          EXPECT_GE(diffuse, 0);
          EXPECT_GE(specular, 0);
          EXPECT_NEAR(diffuse, finish.Diffuse(back), 1e-6f * diffuse);
          EXPECT_NEAR(specular, finish.Specular(back),
                      1e-3f * specular + 1e-12f);
        }
      }
    }
  }
}

TEST(Shading, AnglesAreGuardedWhereTheHalfVectorIsLevel) {
  const Float3 l = OnDome(1e-5, 0);
  const Float3 v = OnDome(1e-5, 0.5);
  EXPECT_EQ(AnglesOf(kUp, l, v).l_h, 1e-4f);
  const Finish finish(Of(0, 1, 0.04f), ShadingModel::kLiteral);
  EXPECT_TRUE(std::isfinite(finish.Specular(AnglesOf(kUp, l, v))));
}

TEST(Shading, GlossFollowsFromRoughnessUnlessGiven) {
  const auto exponent = [](const Material& material) {
    return Finish(material, ShadingModel::kLiteral).exponent();
  };
  const Material plain = {.roughness = 0.25f};
  EXPECT_EQ(plain.Gloss(), 0.75f);
  EXPECT_NEAR(exponent(plain), std::pow(8192, 0.75), 1e-9);
  const Material glossy = {.roughness = 0.25f, .gloss = 0.5f};
  EXPECT_EQ(glossy.Gloss(), 0.5f);
  EXPECT_NEAR(exponent(glossy), std::sqrt(8192), 1e-9);
}

}  // namespace
}  // namespace terrane::core
