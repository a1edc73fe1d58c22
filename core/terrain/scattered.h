// Heights at scattered world points, by way of small windows.
//
// Points are grouped by the block of the lattice they lie in; each group costs
// one window. Determinism: a height depends on its own point alone.
#ifndef TERRANE_CORE_TERRAIN_SCATTERED_H_
#define TERRANE_CORE_TERRAIN_SCATTERED_H_

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "core/terrain/terrain.h"

namespace terrane::core {

// A point's cell at the level, and where in it the point lies.
struct ScatteredPoint {
  std::int64_t x = 0, y = 0;        // lattice point at or before the point
  double along_x = 0, along_y = 0;  // share of the way to the next, [0, 1)
  std::uint32_t id = 0;
};

struct ScatteredScratch {
  std::vector<ScatteredPoint> points;
  std::vector<float> heights;
};

// As Terrain::GenerateAt.
absl::Status GenerateScattered(const Terrain& terrain, int level,
                               std::span<const Point2> points,
                               const std::stop_token& stop,
                               TileScratch* scratch,
                               ScatteredScratch* scattered,
                               std::span<float> out);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_SCATTERED_H_
