// Nanoseconds a surface point, next to the regular surface (eq. 1) of the same
// net in the same run: what the networks cost. Tiles of 256 x 256 points of a
// 1025 x 1025 grid, with and without normals. README.md says how to run.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/surface/surface.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kSide = 256;
constexpr std::int64_t kGridSide = 4 * kSide + 1;

PointNet BezierNet(int side) {
  PointNet net;
  net.basis = SplineBasis::kBezier;
  net.columns = side;
  net.rows = side;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      net.points.push_back({1.0 * i, 1.0 * j, std::sin(1.7 * i + 2.3 * j)});
    }
  }
  return net;
}

enum class Part { kRegular, kFractal };

void Points(benchmark::State& state, SurfaceSpec spec, Part part,
            bool normals) {
  const auto surface = Surface::Create(std::move(spec));
  if (!surface.ok()) {
    state.SkipWithError(surface.status().ToString().c_str());
    return;
  }
  std::vector<float> positions(3 * kSide * kSide);
  std::vector<float> normal_column(normals ? positions.size() : 0);
  std::int64_t tile = 0;
  for (auto _ : state) {
    const SurfaceRequest request = {
        {kGridSide, kGridSide},
        {tile % 4 * kSide, tile / 4 % 4 * kSide, kSide, kSide}};
    ++tile;
    const SurfaceVertices out = {positions, normal_column, {}};
    const absl::Status status =
        part == Part::kRegular ? (*surface)->GenerateRegular(request, {}, out)
                               : (*surface)->Generate(request, {}, out);
    if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    benchmark::DoNotOptimize(positions.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
  state.counters["ns_per_point"] =
      benchmark::Counter(static_cast<double>(kSide * kSide) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate |
                             benchmark::Counter::kInvert);
}

void Register(const std::string& name, const SurfaceSpec& spec, Part part) {
  for (const bool normals : {false, true}) {
    benchmark::RegisterBenchmark(
        (name + (normals ? "/normals" : "/positions")).c_str(),
        [=](benchmark::State& state) { Points(state, spec, part, normals); });
  }
}

void RegisterAll() {
  for (const int side : {4, 16}) {
    const std::string net =
        "/net:" + std::to_string(side) + "x" + std::to_string(side);
    SurfaceSpec spec;
    spec.net = BezierNet(side);
    Register("surface/regular" + net, spec, Part::kRegular);
    const std::pair<const char*, SurfaceMethod> methods[] = {
        {"surface/method:1", SurfaceMethod::kProducts},
        {"surface/method:2", SurfaceMethod::kAlongT},
        {"surface/method:3", SurfaceMethod::kTwoFactors},
        {"surface/method:4", SurfaceMethod::kTwoTerms}};
    for (const auto& [name, method] : methods) {
      spec.method = method;
      Register(name + net, spec, Part::kFractal);
    }
    spec.method = SurfaceMethod::kProducts;
    spec.training = Training{0.1, 1000};
    Register("surface/method:1 1000 steps" + net, spec, Part::kFractal);
    spec.training.reset();
    spec.carry_over = true;
    Register("surface/method:1 carried" + net, spec, Part::kFractal);
  }
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  terrane::core::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
