// The named recipes and windows whose bytes are kept in terrain.txt.
#ifndef TERRANE_TESTS_GOLDEN_TERRAIN_CASES_H_
#define TERRANE_TESTS_GOLDEN_TERRAIN_CASES_H_

#include <string>
#include <vector>

#include "core/terrain/terrain.h"

namespace terrane::core {

struct GoldenCase {
  std::string name;
  TerrainSpec spec;
  TileRequest request;

  // The parameters, for people: level, sampling, window and the scalars.
  std::string Parameters() const;
};

// Every source, mapping, domain, dimension, macro shape, constraint and
// refinement, at least once. In a fixed order.
std::vector<GoldenCase> GoldenCases();

}  // namespace terrane::core

#endif  // TERRANE_TESTS_GOLDEN_TERRAIN_CASES_H_
