#include "tests/golden/golden_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>

#include "hwy/targets.h"

namespace terrane::core {
namespace {

std::uint64_t Hash(const std::vector<float>& values) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int byte = 0; byte < 4; ++byte) {
      hash = (hash ^ (bits >> 8 * byte & 0xFF)) * 0x100000001B3u;
    }
  }
  return hash;
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

int Bless(const char* header, const GoldenLines& lines) {
  std::ofstream file(TERRANE_GOLDEN_FILE);
  file << header;
  for (const auto& [name, line] : lines) file << line << "\n";
  file.close();
  const bool good = file.good() && !testing::Test::HasFailure();
  std::printf("%s %s\n", good ? "wrote" : "could not write",
              TERRANE_GOLDEN_FILE);
  return good ? 0 : 1;
}

}  // namespace

std::string ValueColumns(const std::vector<float>& values) {
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -minimum;
  double sum = 0;
  double count = 0;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
    sum += static_cast<double>(value);
    count += 1;
  }
  char text[128];
  std::snprintf(text, sizeof(text), "%016llx | %.9g | %.9g | %.9g",
                static_cast<unsigned long long>(Hash(values)),
                static_cast<double>(minimum), static_cast<double>(maximum),
                sum / count);
  return text;
}

void ExpectGoldenLines(const GoldenLines& lines) {
  const std::map<std::string, std::string> golden = ReadGoldenLines();
  EXPECT_EQ(golden.size(), lines.size()) << "cases without a line, or the "
                                            "other way round, or two of one "
                                            "name";
  for (const auto& [name, line] : lines) {
    const auto found = golden.find(name);
    if (found == golden.end()) {
      ADD_FAILURE() << "no line for " << name;
    } else {
      EXPECT_EQ(line, found->second);
    }
  }
}

int GoldenMain(int argc, char** argv, const char* header,
               GoldenLines (*make_lines)()) {
  testing::InitGoogleTest(&argc, argv);
  if (argc == 2 && std::strcmp(argv[1], "--bless") == 0) {
    return Bless(header, make_lines());
  }
  return RUN_ALL_TESTS();
}

void OnEverySimdTarget(void (*expect)()) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    expect();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace terrane::core
