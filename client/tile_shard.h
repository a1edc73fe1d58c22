// Tiles split over shards: which tiles a shard makes, and what it asks for.
//
// Tiles are counted row-major over the whole range. A shard makes one run of
// them; runs follow each other without a gap, and their lengths differ by at
// most one, the longer ones first.
#ifndef TERRANE_CLIENT_TILE_SHARD_H_
#define TERRANE_CLIENT_TILE_SHARD_H_

#include <cstdint>
#include <vector>

#include "terrane/v1/common.pb.h"

namespace terrane::client {

// Tiles [first, end).
struct TileRun {
  std::int64_t first = 0;
  std::int64_t end = 0;
};

// `shard` is 0 to shards - 1.
TileRun ShardOf(std::int64_t tiles, std::int64_t shards, std::int64_t shard);

// Tiles of `whole`, by their rising indices, as few rectangles in that order,
// each small enough for a stream.
std::vector<v1::TileRange> RectanglesOf(
    const v1::TileRange& whole, const std::vector<std::int64_t>& indices);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TILE_SHARD_H_
