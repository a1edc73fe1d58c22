#include "client/tile_shard.h"

#include <algorithm>
#include <cstddef>

namespace terrane::client {
namespace {

// Tiles of the largest size stay below what a server sends in a stream, and a
// stream that is refused or fails takes little with it.
constexpr std::int64_t kMostTilesAStream = 4096;

}  // namespace

TileRun ShardOf(std::int64_t tiles, std::int64_t shards, std::int64_t shard) {
  const std::int64_t each = tiles / shards;
  const std::int64_t longer = tiles % shards;
  const auto first = [&](std::int64_t i) {
    return i * each + std::min(i, longer);
  };
  return {first(shard), first(shard + 1)};
}

std::vector<v1::TileRange> RectanglesOf(
    const v1::TileRange& whole, const std::vector<std::int64_t>& indices) {
  std::vector<v1::TileRange> rectangles;
  for (std::size_t i = 0; i < indices.size();) {
    const std::int64_t row = indices[i] / whole.columns();
    const std::int64_t column = indices[i] % whole.columns();
    const std::int64_t most =
        std::min(whole.columns() - column, kMostTilesAStream);
    std::int64_t count = 1;
    while (++i < indices.size() && count < most &&
           indices[i] == indices[i - 1] + 1) {
      ++count;
    }
    // A run right below one of the same columns continues its rectangle.
    if (!rectangles.empty()) {
      v1::TileRange& last = rectangles.back();
      if (last.x() == whole.x() + column && last.columns() == count &&
          last.y() + last.rows() == whole.y() + row &&
          (last.rows() + 1) * count <= kMostTilesAStream) {
        last.set_rows(last.rows() + 1);
        continue;
      }
    }
    v1::TileRange& run = rectangles.emplace_back();
    run.set_x(whole.x() + column);
    run.set_y(whole.y() + row);
    run.set_columns(count);
    run.set_rows(1);
  }
  return rectangles;
}

}  // namespace terrane::client
