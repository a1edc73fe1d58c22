// What a request asks of a terrain: checked, with its defaults filled in, and
// cut into tiles.
//
// Pure functions of messages, limits and a valid spec; all products are checked
// for overflow, and nothing is allocated. Threads: any. Errors: violations, by
// the path of the field after `prefix`; when any was added, the plan returned
// is not to be used.
#ifndef TERRANE_SERVER_CONVERT_REQUEST_PLAN_H_
#define TERRANE_SERVER_CONVERT_REQUEST_PLAN_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/field_checks.h"
#include "core/base/violations.h"
#include "core/grid/lattice_window.h"
#include "core/terrain/terrain.h"
#include "core/terrain/terrain_spec.h"
#include "server/actor/limits.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

// Heights that 0 and 65535 of a 16-bit encoding stand for.
struct EncodingRange {
  double minimum = 0;
  double maximum = 0;
};

// The tiles of a StreamTiles request. Tile (column, row) starts at sample
// whole.xy + (column, row) * stride and has tile_size samples a side, or what
// is left of `whole`; its index is row * columns + column.
struct TilePlan {
  int level = 0;
  core::Sampling sampling = core::Sampling::kPoint;
  v1::HeightEncoding encoding = v1::HEIGHT_ENCODING_FLOAT32_LE;
  std::optional<EncodingRange> range;  // of 16 bits, when the request has one
  core::Window whole;
  int tile_size = 0;
  std::int64_t stride = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::int64_t first_tile = 0;
  // Absolute tile indices of the first tile.
  std::int64_t tile_x = 0;
  std::int64_t tile_y = 0;

  std::int64_t total() const { return columns * rows; }
  core::Window TileWindow(std::int64_t column, std::int64_t row) const;
  int bytes_per_sample() const {
    return encoding == v1::HEIGHT_ENCODING_UINT16_LE ? 2 : 4;
  }
};

// Tiles of one size, as an estimate counts them.
struct TileKind {
  core::Window example;
  std::int64_t count = 0;
};

// `spec` is valid, or null when it is not: then only what does not depend on it
// is checked.
TilePlan PlanTiles(const v1::StreamTilesRequest& request,
                   const core::TerrainSpec* spec, const Limits& limits,
                   const std::string& prefix, core::Violations* violations);

// Checks how heights are to be encoded; `range` is null when the request has
// none. Fields "encoding" and "range" below `root`.
void PlanEncoding(v1::HeightEncoding encoding, const v1::HeightRange* range,
                  const core::Path& root, core::Violations* violations,
                  TilePlan* plan);

// The tiles from plan.first_tile on, sorted by size: at most a handful of
// kinds, however many tiles there are.
std::vector<TileKind> RemainingTiles(const TilePlan& plan);

// The samples of a profile: y = 0, height = 1.
core::TileRequest PlanProfile(const v1::GetProfileRequest& request,
                              const core::TerrainSpec* spec,
                              const Limits& limits, const std::string& prefix,
                              core::Violations* violations);

// The points of a GetHeights request.
std::vector<core::Point2> PlanHeights(const v1::GetHeightsRequest& request,
                                      const core::TerrainSpec* spec,
                                      const Limits& limits,
                                      const std::string& prefix,
                                      core::Violations* violations);

// World place of sample (0, 0) of a level and sampling, and the distance of
// neighbouring samples.
core::Frame SampleFrame(const core::Frame& frame, int level,
                        core::Sampling sampling);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_REQUEST_PLAN_H_
