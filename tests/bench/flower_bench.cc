// Vertices of petals a second, whole roses, and the rows of a bed of 1,000.
//
// Every bench sets items_per_second: vertices with normals, texture coordinates
// and indices, flowers, or instances. README.md says how to run.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/flower/blade_mesh.h"
#include "core/flower/flower.h"
#include "core/flower/flower_generator.h"
#include "core/flower/instance_block.h"
#include "core/noise/perlin_noise.h"
#include "tests/core/flower_presets.h"

namespace terrane::core {
namespace {

// A petal of the rose's kind, without colours.
BladeSpec PetalOf(int columns, int rows) {
  BladeSpec blade = FlowerPreset("rose").petals[0].blade;
  blade.colors = {};
  blade.columns = columns;
  blade.rows = rows;
  return blade;
}

void PetalVertices(benchmark::State& state, PetalMethod method,
                   const BladeSpec& blade) {
  const PerlinNoise noise(7);
  std::int64_t vertices = 0;
  std::uint32_t salt = 0;
  for (auto _ : state) {
    const Mesh mesh =
        MakeBladeMesh(method, blade, {0, 0, blade.steps - 1}, 7, ++salt, noise);
    benchmark::DoNotOptimize(mesh.positions.data());
    vertices += static_cast<std::int64_t>(mesh.positions.size());
  }
  state.SetItemsProcessed(vertices);
}

std::shared_ptr<const Flower> Make(benchmark::State& state,
                                   const FlowerSpec& spec) {
  auto flower = Flower::Create(spec);
  if (flower.ok()) return *std::move(flower);
  state.SkipWithError(flower.status().ToString().c_str());
  return nullptr;
}

std::int64_t GiveRows(benchmark::State& state,
                      std::shared_ptr<const Flower> flower) {
  FlowerGenerator generator(std::move(flower));
  InstanceBlock block;
  std::int64_t rows = 0;
  while (!generator.Done()) {
    const absl::Status status = generator.Next({}, &block);
    if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    benchmark::DoNotOptimize(block.translation.data());
    rows += static_cast<std::int64_t>(block.rows());
  }
  return rows;
}

// From the recipe to prototypes and instances.
void WholeFlower(benchmark::State& state, FlowerSpec spec) {
  for (auto _ : state) {
    ++spec.seed;
    GiveRows(state, Make(state, spec));
  }
  state.SetItemsProcessed(state.iterations());
}

// Instances of a bed of 1,000.
void Bed(benchmark::State& state, FlowerSpec spec) {
  spec.bed.plants = 1000;
  const auto flower = Make(state, spec);
  std::int64_t rows = 0;
  for (auto _ : state) rows += GiveRows(state, flower);
  state.SetItemsProcessed(rows);
}

// --- The list ---------------------------------------------------------------

void RegisterPetal(const std::string& name, PetalMethod method,
                   const BladeSpec& blade) {
  benchmark::RegisterBenchmark(
      ("petal_vertices/" + name).c_str(),
      [=](benchmark::State& state) { PetalVertices(state, method, blade); });
}

void RegisterFlower(const std::string& name, PetalMethod method) {
  FlowerSpec spec = FlowerPreset(name);
  spec.method = method;
  std::string full = name;
  if (method == PetalMethod::kIfs) full += "_ifs";
  if (method == PetalMethod::kBezier) full += "_bezier";
  benchmark::RegisterBenchmark(
      ("flower/" + full).c_str(),
      [=](benchmark::State& state) { WholeFlower(state, spec); });
}

void RegisterAll() {
  const BladeSpec petal = PetalOf(32, 48);
  BladeSpec whole = petal;
  whole.relief.mirrored = false;
  RegisterPetal("perlin_20x24", PetalMethod::kPerlin, PetalOf(20, 24));
  RegisterPetal("perlin_32x48", PetalMethod::kPerlin, petal);
  RegisterPetal("perlin_32x48_unmirrored", PetalMethod::kPerlin, whole);
  RegisterPetal("perlin_256x256", PetalMethod::kPerlin, PetalOf(256, 256));
  RegisterPetal("bezier_32x48", PetalMethod::kBezier, petal);
  RegisterPetal("ifs_32x48", PetalMethod::kIfs, petal);
  RegisterFlower("rose", PetalMethod::kPerlin);
  RegisterFlower("rose", PetalMethod::kBezier);
  RegisterFlower("rose", PetalMethod::kIfs);
  RegisterFlower("sunflower", PetalMethod::kPerlin);
  benchmark::RegisterBenchmark("bed_of_1000/rose", [](benchmark::State& state) {
    Bed(state, FlowerPreset("rose"));
  });
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  terrane::core::RegisterAll();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
