// Scenes in Embree: instances, sides, colours, what is refused; where samples
// lie, how a camera frames, how light becomes bytes.
#include "core/raytrace/traced_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "core/mesh/rotation.h"
#include "core/raytrace/quick_math.h"
#include "core/raytrace/samples.h"
#include "core/raytrace/tone.h"
#include "core/raytrace/view.h"
#include "tests/core/traced_shapes.h"

namespace terrane::core {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();

// p turned by q, by the sandwich product.
Float3 Turned(const Quaternion& q, Float3 p) {
  const Float3 axis = {q.x, q.y, q.z};
  return (q.w * q.w - Dot(axis, axis)) * p + (2 * Dot(axis, p)) * axis +
         (2 * q.w) * Cross(axis, p);
}

Instances ThreePlaces() {
  Instances instances;
  instances.translations = {{-3, 0, 1}, {0, 0, 0}, {3, 1, 2}};
  instances.rotations = {{}, {0.5f, 0.5f, 0.5f, 0.5f}, {0.6f, 0, 0, 0.8f}};
  instances.scales = {{1, 1, 1}, {1, 0.5f, 2}, {0.3f, 1.5f, 1}};
  return instances;
}

// The mesh that the instances stand for.
Mesh Expanded(const Mesh& mesh, const Instances& instances) {
  Mesh whole;
  for (std::size_t i = 0; i < instances.count(); ++i) {
    const Float3 scale = instances.scales[i];
    const auto begin = static_cast<std::uint32_t>(whole.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Float3 p = mesh.positions[v];
      const Float3 n = mesh.normals[v];
      whole.positions.push_back(
          instances.translations[i] +
          Turned(instances.rotations[i],
                 {scale.x * p.x, scale.y * p.y, scale.z * p.z}));
      whole.normals.push_back(
          Normalized(Turned(instances.rotations[i],
                            {n.x / scale.x, n.y / scale.y, n.z / scale.z})));
    }
    for (const std::uint32_t index : mesh.indices) {
      whole.indices.push_back(begin + index);
    }
  }
  return whole;
}

TEST(TracedScene, InstancesAreWhatTheyStandFor) {
  const Mesh ball = Ball(1, 16);
  const Instances places = ThreePlaces();
  const Mesh whole = Expanded(ball, places);
  const auto instanced = Traced(SceneOf(ball, {}, &places));
  const auto expanded = Traced(SceneOf(whole, {}));
  EXPECT_NEAR(instanced->bounds().high.x, expanded->bounds().high.x, 1.0f);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    PixelSamples samples(1, i, 0, 0);
    const Float2 from = samples.Next();
    const Float2 to = samples.Next();
    const Float3 origin = {10 * from.x - 5, -6, 6 * from.y - 2};
    const Float3 target = {10 * to.x - 5, 0, 6 * to.y - 2};
    const Ray ray = {origin, Normalized(target - origin), kForever};
    SurfacePoint a;
    SurfacePoint b;
    const bool hit = instanced->Intersect(ray, &a);
    ASSERT_EQ(hit, expanded->Intersect(ray, &b));
    EXPECT_EQ(hit, instanced->Occluded(ray));
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(a.distance, b.distance, 1e-4f);
    EXPECT_GT(Dot(a.geometric_normal, b.geometric_normal), 0.999f);
    EXPECT_GT(Dot(a.shading_normal, b.shading_normal), 0.99f);
  }
  EXPECT_GT(hits, 500);
}

TEST(Rotation, TakesTheAxesWhereItWasAsked) {
  // One for each component that can be the largest.
  for (const Quaternion& turn : {Quaternion{0.1f, 0.1f, -0.1f, 0.98488f},
                                 Quaternion{-0.9f, 0.3f, 0.1f, 0.3f},
                                 Quaternion{0.2f, 0.9f, -0.3f, 0.24495f},
                                 Quaternion{0.3f, -0.1f, 0.94868f, 0}}) {
    const Float3 axes[] = {Turned(turn, {1, 0, 0}), Turned(turn, {0, 1, 0}),
                           Turned(turn, {0, 0, 1})};
    const Quaternion found = RotationTo(axes[0], axes[1], axes[2]);
    for (const Float3 v : {Float3{1, 0, 0}, Float3{0, 1, 0}, Float3{0, 0, 1}}) {
      const Float3 off = Rotated(found, v) - Turned(turn, v);
      EXPECT_LT(Length(off), 1e-4f);
    }
  }
}

TEST(TracedScene, OneSideIsSeenOrBothButBothCastShadows) {
  const Mesh plane = LevelRectangle({-1, -1}, {1, 1}, 0);
  Material material;
  const Ray down = {{0.2f, 0.1f, 1}, {0, 0, -1}, kForever};
  const Ray up = {{0.2f, 0.1f, -1}, {0, 0, 1}, kForever};
  for (const bool double_sided : {false, true}) {
    material.double_sided = double_sided;
    const auto traced = Traced(SceneOf(plane, material));
    SurfacePoint point;
    ASSERT_TRUE(traced->Intersect(down, &point));
    EXPECT_EQ(point.shading_normal.z, 1);
    EXPECT_EQ(traced->Intersect(up, &point), double_sided);
    if (double_sided) {
      EXPECT_EQ(point.shading_normal.z, -1);
      EXPECT_EQ(point.geometric_normal.z, -1);
    }
    EXPECT_TRUE(traced->Occluded(up));
    EXPECT_FALSE(traced->Occluded({{0.2f, 0.1f, -1}, {0, 0, 1}, 0.9f}));
  }
}

TEST(TracedScene, ColoursAreInterpolated) {
  Mesh plane = LevelRectangle({0, 0}, {1, 1}, 0);
  plane.colors = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const auto traced = Traced(SceneOf(plane, {}));
  SurfacePoint point;
  ASSERT_TRUE(
      traced->Intersect({{0.25f, 0.75f, 1}, {0, 0, -1}, kForever}, &point));
  EXPECT_NEAR(point.color.x, 0.25f, 1e-6f);
  EXPECT_NEAR(point.color.y, 0.75f, 1e-6f);
  EXPECT_NEAR(point.color.z, 1, 1e-6f);
}

TEST(TracedScene, TakesNoMoreMemoryThanItSays) {
  const Mesh ball = Ball(1, 200);
  Instances many;
  for (int i = 0; i < 20'000; ++i) {
    many.translations.push_back({static_cast<float>(i), 0, 0});
    many.rotations.push_back({});
    many.scales.push_back({1, 1, 1});
  }
  const Mesh small = Ball(1, 4);
  for (const Scene& scene :
       {SceneOf(ball, {}), SceneOf(small, {}, &many), SceneOf(small, {})}) {
    const auto traced = Traced(scene);
    const std::int64_t bytes = TracedBytes(SizeOf(scene));
    EXPECT_LE(traced->allocated_bytes(), bytes);
    EXPECT_GT(traced->allocated_bytes(), 0);
    const auto refused = TracedScene::Build(scene, bytes - 1, {});
    EXPECT_TRUE(absl::IsResourceExhausted(refused.status()));
  }
}

TEST(TracedScene, RefusesScenesThatDoNotHangTogether) {
  const auto refusal = [](const Scene& scene) {
    const auto traced = TracedScene::Build(scene, kTestBudget, {});
    const std::vector<Violation> violations = ViolationsOf(traced.status());
    return violations.empty() ? "" : violations.front().field;
  };
  const Mesh good = LevelRectangle({0, 0}, {1, 1}, 0);
  EXPECT_EQ(refusal({{}, {{"a", &good, 0, nullptr}}}), "objects[0].material");
  EXPECT_EQ(refusal({{Material{}}, {}}), "objects");
  Mesh bad = good;
  bad.indices.back() = 4;
  EXPECT_EQ(refusal(SceneOf(bad, {})), "objects[0].mesh.indices");
  bad = good;
  bad.positions[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal(SceneOf(bad, {})), "objects[0].mesh.positions");
  bad = good;
  bad.normals = {{0, 0, 1}};
  EXPECT_EQ(refusal(SceneOf(bad, {})), "objects[0].mesh");
}

TEST(TracedScene, BuildingCanBeStopped) {
  const Mesh ball = Ball(1, 200);
  std::stop_source stop;
  stop.request_stop();
  const auto traced =
      TracedScene::Build(SceneOf(ball, {}), kTestBudget, stop.get_token());
  EXPECT_TRUE(absl::IsCancelled(traced.status())) << traced.status();
}

TEST(QuickMath, HasTheDigitsOfAFloat) {
  for (int i = 1; i <= 1000; ++i) {
    const double x = i / 1000.0;
    for (const double y : {1e-4, 0.5, 1.0, 37.0, 8192.0}) {
      const double exact = std::pow(x, y);
      if (exact < 1e-300) {
        EXPECT_LT(QuickPower(x, y), 1e-299);
      } else {
        EXPECT_NEAR(QuickPower(x, y), exact, 1e-6 * exact) << x << " " << y;
      }
    }
    EXPECT_NEAR(QuickExp2(-10 * x), std::exp2(-10 * x),
                8e-9 * std::exp2(-10 * x));
  }
  EXPECT_EQ(QuickPower(0, 3), 0);
}

TEST(PixelSamples, PassesFillTheSquareEvenly) {
  for (int pair = 0; pair < 3; ++pair) {
    std::array<std::set<int>, 5> cells;
    for (int pass = 0; pass < 16; ++pass) {
      PixelSamples samples(7, 3, 4, pass);
      for (int skipped = 0; skipped < pair; ++skipped) samples.Next();
      const Float2 at = samples.Next();
      // Every elementary interval of area 1/16 holds one sample.
      for (int i = 0; i < 5; ++i) {
        const int columns = 1 << i;
        const int rows = 16 >> i;
        cells[static_cast<std::size_t>(i)].insert(
            static_cast<int>(at.x * static_cast<float>(columns)) * rows +
            static_cast<int>(at.y * static_cast<float>(rows)));
      }
    }
    for (const std::set<int>& filled : cells) EXPECT_EQ(filled.size(), 16u);
  }
}

TEST(PixelSamples, PairsPixelsAndSeedsAreIndependent) {
  // Correlation of the first numbers of pairs, pixels and seeds over passes.
  const auto first = [](std::int64_t seed, int x, int pass, int pair) {
    PixelSamples samples(seed, x, 0, pass);
    for (int skipped = 0; skipped < pair; ++skipped) samples.Next();
    return static_cast<double>(samples.Next().x) - 0.5;
  };
  double pairs = 0;
  double pixels = 0;
  double seeds = 0;
  constexpr int kPasses = 4096;
  for (int pass = 0; pass < kPasses; ++pass) {
    const double a = first(1, 0, pass, 0);
    pairs += 12 * a * first(1, 0, pass, 1) / kPasses;
    pixels += 12 * a * first(1, 1, pass, 0) / kPasses;
    seeds += 12 * a * first(2, 0, pass, 0) / kPasses;
  }
  EXPECT_NEAR(pairs, 0, 0.05);
  EXPECT_NEAR(pixels, 0, 0.05);
  EXPECT_NEAR(seeds, 0, 0.05);
}

TEST(View, CameraSeesTheWholeBoxAndLittleElse) {
  const Bounds box = {{-3, 1, 0}, {5, 2, 9}};
  for (const double tilt : {-90.0, -20.0, 0.0, 33.0, 90.0}) {
    for (const double turn : {0.0, 28.0, -120.0}) {
      const Camera camera = FrameCamera(box, {turn, tilt}, 30, 1.5f);
      const Float3 ahead = Normalized(camera.target - camera.eye);
      const Float3 right = Normalized(Cross(ahead, camera.up));
      const Float3 above = Cross(right, ahead);
      const float slope = std::tan(15 * std::numbers::pi_v<float> / 180);
      float most = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Float3 p = {(corner & 1) != 0 ? box.high.x : box.low.x,
                          (corner & 2) != 0 ? box.high.y : box.low.y,
                          (corner & 4) != 0 ? box.high.z : box.low.z};
        const Float3 way = p - camera.eye;
        const float depth = Dot(way, ahead);
        ASSERT_GT(depth, 0);
        most = std::max({most, std::fabs(Dot(way, above)) / (slope * depth),
                         std::fabs(Dot(way, right)) / (1.5f * slope * depth)});
      }
      EXPECT_NEAR(most, 0.92f, 0.001f) << turn << " " << tilt;
    }
  }
}

TEST(View, TurnIsClockwiseFromSouthAndTiltUpwards) {
  EXPECT_NEAR(Towards({0, 0}).y, -1, 1e-6f);
  EXPECT_NEAR(Towards({90, 0}).x, -1, 1e-6f);
  EXPECT_NEAR(Towards({0, 90}).z, 1, 1e-6f);
}

TEST(View, LightGivesTheIrradianceThatWasAsked) {
  const Bounds box = {{-1, -1, -1}, {1, 1, 1}};
  LightPlace place;
  place.half_side = 0.01;
  const AreaLight light = PlaceLight(box, place);
  const Float3 normal = Normalized(Cross(light.half_u, light.half_v));
  const float distance = Length(light.centre);
  EXPECT_NEAR(Dot(normal, (-1 / distance) * light.centre), 1, 1e-5f);
  const float area = 4 * Length(light.half_u) * Length(light.half_v);
  EXPECT_NEAR(light.radiance.x * area / (distance * distance),
              place.irradiance.x, 1e-4f);
}

TEST(Tone, IsSrgbWithAShoulder) {
  const std::array<float, 7> linear = {0, 0.002f, 0.18f, 0.5f, 0.8f, 2, 1e9f};
  std::array<std::uint8_t, 7> bytes = {};
  ToSrgb8(linear, 1, bytes);
  EXPECT_EQ(bytes,
            (std::array<std::uint8_t, 7>{0, 7, 118, 188, 231, 252, 255}));
  std::array<std::uint8_t, 7> halved = {};
  ToSrgb8(linear, 0.5f, halved);
  EXPECT_EQ(halved[3], 137);
  EXPECT_TRUE(std::ranges::is_sorted(bytes));
}

}  // namespace
}  // namespace terrane::core
