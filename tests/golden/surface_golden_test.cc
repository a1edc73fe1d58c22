// The bytes of every kind of surface, kept as text, as terrain_golden_test.cc
// does for terrain.
//
//   golden_surface_test           compares with surface.txt
//   golden_surface_test --bless   writes surface.txt anew
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/surface/surface.h"
#include "tests/core/surface_reference.h"
#include "tests/golden/golden_file.h"

namespace terrane::core {
namespace {

constexpr char kHeader[] =
    "# Golden surfaces: one line a case of "
    "tests/golden/surface_golden_test.cc.\n"
    "#   name | revision | hash | minimum | maximum | mean\n"
    "# The hash is FNV-1a, 64 bits, of positions and then normals as\n"
    "# little-endian float32. New bytes need a new kSurfaceRevision\n"
    "# (core/surface/surface_spec.h); then write this file anew with:\n"
    "# golden_surface_test --bless\n";

constexpr SurfaceRequest kRequest = {{97, 65}, {5, 3, 80, 60}};

std::vector<float> Values(const SurfaceSpec& spec) {
  const std::size_t size = 3 * 80 * 60;
  std::vector<float> positions(size);
  std::vector<float> normals(size);
  const auto surface = Surface::Create(spec);
  EXPECT_TRUE(surface.ok()) << surface.status();
  EXPECT_TRUE(
      (*surface)->Generate(kRequest, {}, {positions, normals, {}}).ok());
  positions.insert(positions.end(), normals.begin(), normals.end());
  return positions;
}

class CaseList {
 public:
  void Add(const std::string& name, SurfaceSpec spec) {
    // Every case has draws of its own.
    spec.seed = 1'000'003 * static_cast<std::int64_t>(lines_.size()) - 7;
    lines_.emplace_back(name, name + " | " + std::to_string(kSurfaceRevision) +
                                  " | " + ValueColumns(Values(spec)));
  }
  GoldenLines Take() { return std::move(lines_); }

 private:
  GoldenLines lines_;
};

const std::pair<const char*, SplineBasis> kBases[] = {
    {"bezier", SplineBasis::kBezier},
    {"bspline_uniform", SplineBasis::kBSplineUniform},
    {"bspline_clamped", SplineBasis::kBSplineClamped},
    {"bilinear", SplineBasis::kBilinear},
    {"bicubic_hermite", SplineBasis::kBicubicHermite}};

const std::pair<const char*, SurfaceMethod> kMethods[] = {
    {"products", SurfaceMethod::kProducts},
    {"along_t", SurfaceMethod::kAlongT},
    {"two_factors", SurfaceMethod::kTwoFactors},
    {"two_terms", SurfaceMethod::kTwoTerms}};

GoldenLines Lines() {
  CaseList list;
  for (const auto& [method_name, method] : kMethods) {
    for (const auto& [basis_name, basis] : kBases) {
      SurfaceSpec spec;
      spec.net = WavyNet(basis, 3, 7, 6);
      spec.method = method;
      spec.network.weights = {{.random = 1},
                              {.i = 2, .offset = 3, .slope_i = -1}};
      spec.network.desired_random = 0.25;
      const std::string name = std::string(method_name) + "_" + basis_name;
      list.Add(name, spec);
      spec.carry_over = true;
      spec.network.weights.back().redraw = true;
      list.Add(name + "_carried", spec);
    }
  }
  SurfaceSpec spec;
  spec.net = HillNet();
  list.Add("default", spec);
  spec.training = Training{0.2, 7};
  list.Add("seven_steps", spec);
  spec.training = Training{0, 0};
  list.Add("untrained", spec);
  spec.training.reset();
  spec.hole_level = 0.7;
  list.Add("holes", spec);
  spec.hole_level.reset();
  spec.direction = {1, -2, 3};
  list.Add("direction", spec);
  spec.net = WavyNet(SplineBasis::kBezier, 3, 16, 16);
  list.Add("net_16", spec);
  spec.net = WavyNet(SplineBasis::kBSplineClamped, 5, 64, 64);
  list.Add("net_64", spec);
  return list.Take();
}

void ExpectLines() { ExpectGoldenLines(Lines()); }

TEST(GoldenSurface, HasTheBytesItHad) { ExpectLines(); }

TEST(GoldenSurface, HasTheSameBytesOnEverySimdTarget) {
  OnEverySimdTarget(&ExpectLines);
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  return terrane::core::GoldenMain(argc, argv, terrane::core::kHeader,
                                   &terrane::core::Lines);
}
