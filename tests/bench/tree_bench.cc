// Segments of trees with radii and vertices of their tubes a second, next to a
// yardstick of the same run: moving the same bytes and nothing else.
//
// Every bench sets items_per_second, and times_bound: its time an item over the
// yardstick's, which is measured before the benches. README.md says how to run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/tree/tree_generator.h"
#include "core/tree/tree_mesh.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kRows = 300'000;
constexpr double kVertexBytes = 32;

// Nanoseconds to copy a byte of a block of the size that is streamed: the best
// of many.
double NanosecondsOfByte() {
  constexpr std::size_t kBytes = 800'000;
  const std::vector<char> from(kBytes, 1);
  std::vector<char> to(kBytes);
  double best = 1e9;
  for (int run = 0; run < 500; ++run) {
    const auto start = std::chrono::steady_clock::now();
    std::memcpy(to.data(), from.data(), kBytes);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
    const std::chrono::duration<double, std::nano> spent =
        std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count() / kBytes);
  }
  return best;
}

// Counts items of so many bytes and holds the time of the CPU that they take
// against the yardstick.
class Meter {
 public:
  Meter(double bytes, double nanoseconds_of_byte)
      : bound_(bytes * nanoseconds_of_byte) {}

  void Add(std::size_t items) { items_ += static_cast<std::int64_t>(items); }

  void Report(benchmark::State& state) const {
    const double spent =
        static_cast<double>(std::clock() - start_) * 1e9 / CLOCKS_PER_SEC;
    state.SetItemsProcessed(items_);
    state.counters["times_bound"] =
        spent / (static_cast<double>(items_) * bound_);
  }

 private:
  const double bound_;
  const std::clock_t start_ = std::clock();
  std::int64_t items_ = 0;
};

std::shared_ptr<const Tree> Make(benchmark::State& state, TreeSpec spec) {
  auto tree = Tree::Create(spec);
  if (tree.ok()) return *std::move(tree);
  state.SkipWithError(tree.status().ToString().c_str());
  return nullptr;
}

void Segments(benchmark::State& state, const TreeSpec& spec, double of_byte) {
  const auto tree = Make(state, spec);
  SegmentBlock block;
  Meter meter(static_cast<double>(SegmentBytes(spec.dimensions)), of_byte);
  for (auto _ : state) {
    TreeGenerator generator(tree);
    while (!generator.Done()) {
      const absl::Status status = generator.Next({}, &block);
      if (!status.ok()) state.SkipWithError(status.ToString().c_str());
      benchmark::DoNotOptimize(block.end.data());
      meter.Add(block.rows());
    }
  }
  meter.Report(state);
}

// From the recipe to the first block.
void FirstBlock(benchmark::State& state, TreeSpec spec) {
  SegmentBlock block;
  for (auto _ : state) {
    ++spec.seed;
    TreeGenerator generator(Make(state, spec));
    const absl::Status status = generator.Next({}, &block);
    if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    benchmark::DoNotOptimize(block.end.data());
  }
}

void Vertices(benchmark::State& state, TreeSpec spec, const TubeSpec& tubes,
              double of_byte) {
  spec.max_segments = 20'000;
  TreeGenerator generator(Make(state, spec), 0, {20'000, 20'000});
  SegmentBlock block;
  const absl::Status grown = generator.Next({}, &block);
  const auto mesher = TreeMesher::Create(tubes);
  if (!grown.ok() || !mesher.ok()) state.SkipWithError("no tree to mesh");
  Mesh mesh;
  Meter meter(kVertexBytes, of_byte);
  for (auto _ : state) {
    for (std::size_t next = 0; next < block.rows();) {
      const absl::Status status =
          mesher->Next(block, {}, TreeMesher::kBlockVertices, &next, &mesh);
      if (!status.ok()) state.SkipWithError(status.ToString().c_str());
      benchmark::DoNotOptimize(mesh.positions.data());
      meter.Add(mesh.positions.size());
    }
  }
  meter.Report(state);
}

// Rows and their tubes together, as a program that wants a tree asks for them.
// Counts rows; vertices_per_second counts those of the tubes.
void GrownAndMeshed(benchmark::State& state, const TreeSpec& spec) {
  const auto tree = Make(state, spec);
  const auto mesher = TreeMesher::Create({});
  if (!mesher.ok()) state.SkipWithError("no mesher");
  SegmentBlock block;
  Mesh mesh;
  std::int64_t rows = 0;
  std::int64_t vertices = 0;
  for (auto _ : state) {
    TreeGenerator generator(tree);
    while (!generator.Done()) {
      absl::Status status = generator.Next({}, &block);
      rows += static_cast<std::int64_t>(block.rows());
      for (std::size_t next = 0; status.ok() && next < block.rows();) {
        status =
            mesher->Next(block, {}, TreeMesher::kBlockVertices, &next, &mesh);
        benchmark::DoNotOptimize(mesh.positions.data());
        vertices += static_cast<std::int64_t>(mesh.positions.size());
      }
      if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    }
  }
  state.SetItemsProcessed(rows);
  state.counters["vertices_per_second"] = benchmark::Counter(
      static_cast<double>(vertices), benchmark::Counter::kIsRate);
}

// --- The list ---------------------------------------------------------------

TreeSpec Relative(int dimensions) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.dimensions = dimensions;
  spec.depth = 32;
  spec.max_segments = kRows;
  return spec;
}

void RegisterSegments(const std::string& name, const TreeSpec& spec,
                      double of_byte) {
  benchmark::RegisterBenchmark(
      ("segments/" + name).c_str(),
      [=](benchmark::State& state) { Segments(state, spec, of_byte); });
}

void RegisterVertices(const std::string& name, const TubeSpec& tubes,
                      double of_byte) {
  benchmark::RegisterBenchmark(("vertices/" + name).c_str(),
                               [=](benchmark::State& state) {
                                 Vertices(state, Relative(3), tubes, of_byte);
                               });
}

void RegisterAll() {
  const double of_byte = NanosecondsOfByte();
  TreeSpec absolute;
  RegisterSegments("absolute_2d", absolute, of_byte);
  RegisterSegments("relative_2d", Relative(2), of_byte);
  RegisterSegments("relative_3d", Relative(3), of_byte);
  TreeSpec population = Relative(3);
  population.genetic.population = 64;
  RegisterSegments("population_64", population, of_byte);
  TreeSpec pipes = Relative(3);
  pipes.pipe_exponent = 2.3;
  RegisterSegments("pipes_2.3", pipes, of_byte);
  TreeSpec bent = Relative(3);
  bent.bending = {4, 1, 0.5};
  RegisterSegments("bent", bent, of_byte);
  TreeSpec plain;
  plain.form = TreeForm::kPlain;
  plain.depth = 17;
  RegisterSegments("plain", plain, of_byte);
  benchmark::RegisterBenchmark(
      "first_block/relative_3d",
      [](benchmark::State& state) { FirstBlock(state, Relative(3)); });
  benchmark::RegisterBenchmark(
      "grown_and_meshed/relative_3d",
      [](benchmark::State& state) { GrownAndMeshed(state, Relative(3)); });
  RegisterVertices("sides_12", {}, of_byte);
  RegisterVertices("sides_3", {.sides = 3}, of_byte);
  RegisterVertices("sides_12_open",
                   {.least_sides = 12, .ends = TubeEnds::kOpen}, of_byte);
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
