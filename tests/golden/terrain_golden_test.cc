// The bytes of every kind of terrain, kept as text: a change of any bit of any
// of them shows up here, and Debug, Release, sanitizer builds and every SIMD
// target are held to the same lines.
//
//   golden_terrain_test           compares with terrain.txt
//   golden_terrain_test --bless   writes terrain.txt anew
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/golden/golden_file.h"
#include "tests/golden/terrain_cases.h"

namespace terrane::core {
namespace {

constexpr char kHeader[] =
    "# Golden terrains: one line a case of tests/golden/terrain_cases.cc.\n"
    "#   name | revision | parameters | hash | minimum | maximum | mean\n"
    "# The hash is FNV-1a, 64 bits, of the heights as little-endian float32.\n"
    "# New bytes need a new kTerrainRevision (core/terrain/terrain_spec.h); "
    "then\n"
    "# write this file anew with: golden_terrain_test --bless\n";

std::vector<float> Generate(const GoldenCase& golden) {
  const TileRequest& request = golden.request;
  std::vector<float> heights(
      static_cast<std::size_t>(request.window.width * request.window.height));
  const auto terrain = Terrain::Create(golden.spec);
  EXPECT_TRUE(terrain.ok()) << golden.name << ": " << terrain.status();
  if (!terrain.ok()) return {};
  TileScratch scratch;
  const absl::Status status =
      (*terrain)->Generate(request, {}, &scratch, heights);
  EXPECT_TRUE(status.ok()) << golden.name << ": " << status;
  return heights;
}

std::string Line(const GoldenCase& golden) {
  return golden.name + " | " + std::to_string(kTerrainRevision) + " | " +
         golden.Parameters() + " | " + ValueColumns(Generate(golden));
}

GoldenLines Lines() {
  GoldenLines lines;
  for (const GoldenCase& golden : GoldenCases()) {
    lines.emplace_back(golden.name, Line(golden));
  }
  return lines;
}

void ExpectLines() { ExpectGoldenLines(Lines()); }

TEST(GoldenTerrain, HasTheBytesItHad) { ExpectLines(); }

TEST(GoldenTerrain, HasTheSameBytesOnEverySimdTarget) {
  OnEverySimdTarget(&ExpectLines);
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  return terrane::core::GoldenMain(argc, argv, terrane::core::kHeader,
                                   &terrane::core::Lines);
}
