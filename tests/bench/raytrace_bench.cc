// Rays a second of the traced preview, next to Embree's own rate for the same
// rays in the same run: what shading, sampling and bookkeeping cost. The rays
// of one pass are written down, then cast by rtcIntersect1 and rtcOccluded1
// alone. One thread. README.md says how to run.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/mesh/grid_mesh.h"
#include "core/raytrace/ray_tracer.h"
#include "core/raytrace/traced_scene.h"

namespace terrane::core {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

// Hills of 2 * side^2 triangles over the unit square.
Mesh Hills(int side, float height) {
  std::vector<Float3> positions;
  for (int j = 0; j <= side; ++j) {
    for (int i = 0; i <= side; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(side);
      const float y = static_cast<float>(j) / static_cast<float>(side);
      positions.push_back(
          {x, y, height * (std::sin(17 * x) + std::sin(23 * y + 9 * x))});
    }
  }
  return MakeGridMesh({side + 1, side + 1, positions, {}, {}});
}

// Leaves in a cloud.
Instances Cloud(int count) {
  Instances cloud;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<float>(i);
    cloud.translations.push_back(
        {std::sin(12.9f * at), std::sin(78.2f * at), std::sin(37.7f * at)});
    const float half_turn = 0.5f * at;
    cloud.rotations.push_back({std::sin(half_turn), 0, 0, std::cos(half_turn)});
    cloud.scales.push_back({0.05f, 0.05f, 0.05f});
  }
  return cloud;
}

// Writes down what it is asked.
class RecordingCaster final : public RayCaster {
 public:
  explicit RecordingCaster(std::shared_ptr<const RayCaster> caster)
      : caster_(std::move(caster)) {}

  bool Intersect(const Ray& ray, SurfacePoint* point) const override {
    intersected.push_back(ray);
    return caster_->Intersect(ray, point);
  }
  bool Occluded(const Ray& ray) const override {
    occluded.push_back(ray);
    return caster_->Occluded(ray);
  }

  mutable std::vector<Ray> intersected;
  mutable std::vector<Ray> occluded;

 private:
  const std::shared_ptr<const RayCaster> caster_;
};

struct Stage {
  Mesh mesh;
  Instances instances;
  std::shared_ptr<const TracedScene> traced;
  PictureSpec spec;
  std::shared_ptr<RecordingCaster> rays;  // of pass 0
};

std::shared_ptr<Stage> MakeStage(bool instanced) {
  auto stage = std::make_shared<Stage>();
  stage->mesh = instanced ? Hills(8, 0.1f) : Hills(512, 0.05f);
  if (instanced) stage->instances = Cloud(20'000);
  Material material;
  material.double_sided = true;
  const Scene scene = {
      {material},
      {{"mesh", &stage->mesh, 0, instanced ? &stage->instances : nullptr}}};
  stage->traced = *TracedScene::Build(scene, std::int64_t{1} << 30, {});
  const Bounds& bounds = stage->traced->bounds();
  stage->spec.width = kWidth;
  stage->spec.height = kHeight;
  stage->spec.camera = FrameCamera(bounds, {28, 33}, 30, 4.0f / 3);
  stage->spec.light = PlaceLight(bounds, {});
  stage->spec.ground = PlaceGround(bounds, {});
  stage->rays = std::make_shared<RecordingCaster>(stage->traced);
  const auto tracer =
      *RayTracer::Create(stage->rays, stage->traced->materials(), stage->spec);
  std::vector<float> sums(3 * kWidth * kHeight);
  (void)tracer->AddPass(0, 0, kHeight, {}, sums);
  return stage;
}

void CountRays(benchmark::State& state, const Stage& stage) {
  state.counters["rays_per_second"] =
      benchmark::Counter(static_cast<double>(stage.rays->intersected.size() +
                                             stage.rays->occluded.size()),
                         benchmark::Counter::kIsIterationInvariantRate);
}

void Preview(benchmark::State& state, const Stage& stage) {
  const auto tracer =
      *RayTracer::Create(stage.traced, stage.traced->materials(), stage.spec);
  std::vector<float> sums(3 * kWidth * kHeight);
  for (auto _ : state) {
    const absl::Status added = tracer->AddPass(0, 0, kHeight, {}, sums);
    if (!added.ok()) state.SkipWithError(added.ToString().c_str());
    benchmark::ClobberMemory();
  }
  CountRays(state, stage);
}

RTCRay ToEmbree(const Ray& ray) {
  RTCRay out = {};
  out.org_x = ray.origin.x;
  out.org_y = ray.origin.y;
  out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x;
  out.dir_y = ray.direction.y;
  out.dir_z = ray.direction.z;
  out.tfar = ray.length;
  out.mask = ~0u;
  return out;
}

void EmbreeAlone(benchmark::State& state, const Stage& stage) {
  RTCScene const scene = stage.traced->embree_scene();
  for (auto _ : state) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (const Ray& ray : stage.rays->intersected) {
      RTCRayHit hit = {};
      hit.ray = ToEmbree(ray);
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &context, &hit);
      benchmark::DoNotOptimize(hit);
    }
    for (const Ray& ray : stage.rays->occluded) {
      RTCRay query = ToEmbree(ray);
      rtcOccluded1(scene, &context, &query);
      benchmark::DoNotOptimize(query);
    }
  }
  CountRays(state, stage);
}

void RegisterAll() {
  for (const bool instanced : {false, true}) {
    const std::shared_ptr<const Stage> stage = MakeStage(instanced);
    const std::string scene = instanced ? "leaves" : "hills";
    benchmark::RegisterBenchmark(
        ("trace/preview/scene:" + scene).c_str(),
        [stage](benchmark::State& state) { Preview(state, *stage); })
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(
        ("trace/embree/scene:" + scene).c_str(),
        [stage](benchmark::State& state) { EmbreeAlone(state, *stage); })
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  terrane::core::RegisterAll();
  benchmark::RunSpecifiedBenchmarks();
}
