// A vertex of a surface is a function of its own place alone, to the bit:
// whatever the tile, the thread, the SIMD target, or what was generated before.
// Normals, too, and carry-over.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "core/surface/surface.h"
#include "hwy/targets.h"
#include "tests/core/surface_reference.h"

namespace terrane::core {
namespace {

constexpr int kCases = 200 / TERRANE_REPETITION_DIVISOR;

struct Vertices {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> uvs;
  std::vector<float> heights;
};

Vertices Make(const Surface& surface, const SurfaceRequest& request) {
  const auto size =
      static_cast<std::size_t>(request.window.width * request.window.height);
  Vertices made = {std::vector<float>(3 * size), std::vector<float>(3 * size),
                   std::vector<float>(2 * size), std::vector<float>(size)};
  EXPECT_TRUE(
      surface.Generate(request, {}, {made.positions, made.normals, made.uvs})
          .ok());
  EXPECT_TRUE(surface.GenerateHeights(request, {}, made.heights).ok());
  return made;
}

bool SameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// The part of a column of `channels` floats a sample that lies in `window`.
std::vector<float> Cut(const std::vector<float>& whole, std::int64_t columns,
                       std::int64_t channels, const Window& window) {
  std::vector<float> part;
  for (std::int64_t j = 0; j < window.height; ++j) {
    const auto begin =
        whole.begin() + channels * ((window.y + j) * columns + window.x);
    part.insert(part.end(), begin, begin + channels * window.width);
  }
  return part;
}

class SurfaceCases {
 public:
  explicit SurfaceCases(unsigned seed) : random_(seed) {}

  std::int64_t Pick(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random_);
  }

  // Any basis, method and net, with and without carry-over, holes, training.
  SurfaceSpec Spec() {
    constexpr SplineBasis kBases[] = {
        SplineBasis::kBezier, SplineBasis::kBSplineUniform,
        SplineBasis::kBSplineClamped, SplineBasis::kBilinear,
        SplineBasis::kBicubicHermite};
    constexpr SurfaceMethod kMethods[] = {
        SurfaceMethod::kProducts, SurfaceMethod::kAlongT,
        SurfaceMethod::kTwoFactors, SurfaceMethod::kTwoTerms};
    SurfaceSpec spec;
    spec.seed = Pick(-1000, 1000);
    spec.method = kMethods[Pick(0, 3)];
    const int degree = static_cast<int>(Pick(1, 5));
    spec.net = WavyNet(kBases[Pick(0, 4)], degree,
                       degree + static_cast<int>(Pick(1, 7)),
                       degree + static_cast<int>(Pick(1, 7)));
    spec.carry_over = Pick(0, 2) == 0;
    spec.network.weights = {{.offset = 0.5, .random = 2},
                            {.i = 0, .random = 5, .redraw = spec.carry_over}};
    spec.network.desired_random = 0.3;
    spec.network_u.weights = {{.i = {}, .j = 1, .offset = 4}};
    if (Pick(0, 2) == 0) {
      spec.training = Training{0.3, static_cast<int>(Pick(0, 9))};
    }
    if (Pick(0, 2) == 0) spec.hole_level = 2;
    if (Pick(0, 2) == 0) spec.direction = {0.3, -0.2, 1};
    return spec;
  }

  Window Inside(const SurfaceGrid& grid) {
    Window window;
    window.x = Pick(0, grid.columns - 1);
    window.y = Pick(0, grid.rows - 1);
    window.width = Pick(1, grid.columns - window.x);
    window.height = Pick(1, grid.rows - window.y);
    return window;
  }

 private:
  std::mt19937 random_;
};

void ExpectCut(const Vertices& whole, std::int64_t columns,
               const Window& window, const Vertices& part) {
  EXPECT_TRUE(
      SameBits(Cut(whole.positions, columns, 3, window), part.positions));
  EXPECT_TRUE(SameBits(Cut(whole.normals, columns, 3, window), part.normals));
  EXPECT_TRUE(SameBits(Cut(whole.uvs, columns, 2, window), part.uvs));
  EXPECT_TRUE(SameBits(Cut(whole.heights, columns, 1, window), part.heights));
}

TEST(SurfaceTiles, EqualTheWhole) {
  SurfaceCases cases(1);
  for (int round = 0; round < kCases; ++round) {
    SCOPED_TRACE(round);
    const SurfaceSpec spec = cases.Spec();
    const SurfaceGrid grid = {cases.Pick(2, 90), cases.Pick(2, 60)};
    const auto surface = *Surface::Create(spec);
    const Vertices whole =
        Make(*surface, {grid, {0, 0, grid.columns, grid.rows}});
    for (int part = 0; part < 4; ++part) {
      const Window window = cases.Inside(grid);
      ExpectCut(whole, grid.columns, window, Make(*surface, {grid, window}));
    }
  }
}

TEST(SurfaceTiles, AreTheSameOnEverySimdTarget) {
  SurfaceCases cases(2);
  std::vector<SurfaceSpec> specs;
  for (int round = 0; round < kCases / 4; ++round)
    specs.push_back(cases.Spec());
  const SurfaceRequest request = {{61, 37}, {3, 2, 55, 33}};
  std::vector<Vertices> expected;
  for (const SurfaceSpec& spec : specs) {
    expected.push_back(Make(**Surface::Create(spec), request));
  }
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (std::size_t k = 0; k < specs.size(); ++k) {
      const Vertices made = Make(**Surface::Create(specs[k]), request);
      EXPECT_TRUE(SameBits(made.positions, expected[k].positions));
      EXPECT_TRUE(SameBits(made.normals, expected[k].normals));
      EXPECT_TRUE(SameBits(made.heights, expected[k].heights));
    }
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(targets, 1);
}

TEST(SurfaceTiles, AreTheSameFromEveryThread) {
  SurfaceCases cases(3);
  const auto surface = *Surface::Create(cases.Spec());
  const SurfaceGrid grid = {65, 64};
  const Vertices whole = Make(*surface, {grid, {0, 0, 65, 64}});
  std::vector<std::thread> threads;
  for (std::int64_t k = 0; k < 4; ++k) {
    threads.emplace_back([&, k] {
      const Window window = {0, 16 * k, 65, 16};
      ExpectCut(whole, 65, window, Make(*surface, {grid, window}));
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(SurfaceTiles, AWindowFarInsideALargeGridIsMadeAlone) {
  SurfaceSpec spec;
  spec.net = HillNet();
  const SurfaceGrid grid = {kMaxGridSide, kMaxGridSide};
  const auto surface = *Surface::Create(spec);
  const Window window = {700'000, 900'000, 40, 30};
  const Vertices part = Make(*surface, {grid, window});
  const Vertices one = Make(*surface, {grid, {700'039, 900'029, 1, 1}});
  EXPECT_TRUE(SameBits(one.positions,
                       {part.positions.end() - 3, part.positions.end()}));
  EXPECT_TRUE(
      SameBits(one.normals, {part.normals.end() - 3, part.normals.end()}));
}

TEST(SurfaceTiles, GenerationStopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  for (const bool carry_over : {false, true}) {
    SurfaceSpec spec;
    spec.net = HillNet();
    spec.carry_over = carry_over;
    std::vector<float> positions(3 * 64 * 64);
    EXPECT_EQ((*Surface::Create(spec))
                  ->Generate({{64, 64}, {0, 0, 64, 64}}, source.get_token(),
                             {positions, {}, {}})
                  .code(),
              absl::StatusCode::kCancelled);
  }
}

}  // namespace
}  // namespace terrane::core
