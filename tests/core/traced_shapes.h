// Shapes and pictures for the tests of core/raytrace.
#ifndef TERRANE_TESTS_CORE_TRACED_SHAPES_H_
#define TERRANE_TESTS_CORE_TRACED_SHAPES_H_

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "core/mesh/float3.h"
#include "core/raytrace/ray_tracer.h"
#include "core/raytrace/render_image.h"
#include "core/raytrace/traced_scene.h"
#include "gtest/gtest.h"

namespace terrane::core {

inline constexpr std::int64_t kTestBudget = std::int64_t{1} << 30;

// A rectangle between two corners on a level plane, seen from above.
inline Mesh LevelRectangle(Float2 low, Float2 high, float z) {
  Mesh mesh;
  mesh.positions = {{low.x, low.y, z},
                    {high.x, low.y, z},
                    {high.x, high.y, z},
                    {low.x, high.y, z}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

// A ball about the origin.
inline Mesh Ball(float radius, int rings) {
  Mesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double down = std::numbers::pi * i / rings;
      const double turn = 2 * std::numbers::pi * j / columns;
      const Float3 normal = {
          static_cast<float>(std::sin(down) * std::cos(turn)),
          static_cast<float>(std::sin(down) * std::sin(turn)),
          static_cast<float>(std::cos(down))};
      mesh.normals.push_back(normal);
      mesh.positions.push_back(radius * normal);
      if (i == rings || j == columns) continue;
      const auto here = static_cast<std::uint32_t>(i * (columns + 1) + j);
      const auto below = here + static_cast<std::uint32_t>(columns + 1);
      for (const std::uint32_t corner :
           {here, below, below + 1, here, below + 1, here + 1}) {
        mesh.indices.push_back(corner);
      }
    }
  }
  return mesh;
}

// A scene of one mesh. Both must outlive what is made of it.
inline Scene SceneOf(const Mesh& mesh, const Material& material,
                     const Instances* instances = nullptr) {
  return {{material}, {{"object", &mesh, 0, instances}}};
}

inline std::shared_ptr<const TracedScene> Traced(const Scene& scene) {
  auto traced = TracedScene::Build(scene, kTestBudget, {});
  EXPECT_TRUE(traced.ok()) << traced.status();
  return traced.ok() ? *traced : nullptr;
}

inline std::vector<float> Rendered(const Scene& scene, const PictureSpec& spec,
                                   const RenderPlan& plan) {
  const auto traced = Traced(scene);
  const auto tracer = RayTracer::Create(traced, traced->materials(), spec);
  EXPECT_TRUE(tracer.ok()) << tracer.status();
  auto image = RenderImage(**tracer, plan, {}, nullptr);
  EXPECT_TRUE(image.ok()) << image.status();
  return *image;
}

// A picture of one pixel, a point of the scene seen from an eye.
inline PictureSpec Spot(Float3 eye, Float3 target) {
  PictureSpec spec;
  spec.width = 1;
  spec.height = 1;
  spec.bounces = 0;
  spec.camera = {eye, target, {0, 1, 0.1f}, 1e-3f};
  spec.sky = {{0, 0, 0}, {0, 0, 0}};
  return spec;
}

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_TRACED_SHAPES_H_
