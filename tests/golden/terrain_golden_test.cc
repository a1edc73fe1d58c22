// The bytes of every kind of terrain, kept as text: a change of any bit of any
// of them shows up here, and Debug, Release, sanitizer builds and every SIMD
// target are held to the same lines.
//
//   golden_terrain_test           compares with terrain.txt
//   golden_terrain_test --bless   writes terrain.txt anew
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "hwy/targets.h"
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

std::uint64_t Hash(const std::vector<float>& heights) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const float height : heights) {
    const auto bits = std::bit_cast<std::uint32_t>(height);
    for (int byte = 0; byte < 4; ++byte) {
      hash = (hash ^ (bits >> 8 * byte & 0xFF)) * 0x100000001B3u;
    }
  }
  return hash;
}

std::string Line(const GoldenCase& golden) {
  const std::vector<float> heights = Generate(golden);
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -minimum;
  double sum = 0;
  double count = 0;
  for (const float height : heights) {
    if (std::isnan(height)) continue;
    minimum = std::min(minimum, height);
    maximum = std::max(maximum, height);
    sum += static_cast<double>(height);
    count += 1;
  }
  char numbers[128];
  std::snprintf(numbers, sizeof(numbers), "%016llx | %.9g | %.9g | %.9g",
                static_cast<unsigned long long>(Hash(heights)),
                static_cast<double>(minimum), static_cast<double>(maximum),
                sum / count);
  return golden.name + " | " + std::to_string(kTerrainRevision) + " | " +
         golden.Parameters() + " | " + numbers;
}

std::map<std::string, std::string> ReadGoldenLines() {
  std::map<std::string, std::string> lines;
  std::ifstream file(TERRANE_GOLDEN_FILE);
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') {
      lines[line.substr(0, line.find(" | "))] = line;
    }
  }
  return lines;
}

int Bless() {
  std::ofstream file(TERRANE_GOLDEN_FILE);
  file << kHeader;
  for (const GoldenCase& golden : GoldenCases()) file << Line(golden) << "\n";
  file.close();
  const bool good = file.good() && !testing::Test::HasFailure();
  std::printf("%s %s\n", good ? "wrote" : "could not write",
              TERRANE_GOLDEN_FILE);
  return good ? 0 : 1;
}

void ExpectGoldenLines() {
  const std::map<std::string, std::string> lines = ReadGoldenLines();
  const std::vector<GoldenCase> cases = GoldenCases();
  EXPECT_EQ(lines.size(), cases.size()) << "cases without a line, or the other "
                                           "way round, or two of one name";
  for (const GoldenCase& golden : cases) {
    const auto line = lines.find(golden.name);
    if (line == lines.end()) {
      ADD_FAILURE() << "no line for " << golden.name;
    } else {
      EXPECT_EQ(Line(golden), line->second);
    }
  }
}

TEST(GoldenTerrain, HasTheBytesItHad) { ExpectGoldenLines(); }

TEST(GoldenTerrain, HasTheSameBytesOnEverySimdTarget) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ExpectGoldenLines();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc == 2 && std::strcmp(argv[1], "--bless") == 0) {
    return terrane::core::Bless();
  }
  return RUN_ALL_TESTS();
}
