#include "client/tile_shard.h"

#include <gtest/gtest.h>

#include <numeric>

namespace terrane::client {
namespace {

// The tiles of rectangles, row by row, as indices in `whole`.
std::vector<std::int64_t> IndicesOf(
    const v1::TileRange& whole, const std::vector<v1::TileRange>& rectangles) {
  std::vector<std::int64_t> indices;
  for (const v1::TileRange& part : rectangles) {
    for (std::int64_t y = part.y(); y < part.y() + part.rows(); ++y) {
      for (std::int64_t x = part.x(); x < part.x() + part.columns(); ++x) {
        indices.push_back((y - whole.y()) * whole.columns() + x - whole.x());
      }
    }
  }
  return indices;
}

v1::TileRange Range(std::int64_t x, std::int64_t y, std::int64_t columns,
                    std::int64_t rows) {
  v1::TileRange range;
  range.set_x(x);
  range.set_y(y);
  range.set_columns(columns);
  range.set_rows(rows);
  return range;
}

std::vector<std::int64_t> Indices(std::int64_t first, std::int64_t end) {
  std::vector<std::int64_t> indices(static_cast<std::size_t>(end - first));
  std::iota(indices.begin(), indices.end(), first);
  return indices;
}

TEST(TileShard, ShardsFollowEachOtherAndAreBalanced) {
  for (const std::int64_t tiles : {1, 2, 7, 20, 1000}) {
    for (const std::int64_t shards : {1, 2, 3, 7, 999}) {
      std::int64_t next = 0;
      std::int64_t length = tiles / shards + 1;
      for (std::int64_t shard = 0; shard < shards; ++shard) {
        const TileRun run = ShardOf(tiles, shards, shard);
        EXPECT_EQ(run.first, next);
        EXPECT_LE(run.end - run.first, length);  // the longer ones first
        EXPECT_GE(run.end - run.first, tiles / shards);
        length = run.end - run.first;
        next = run.end;
      }
      EXPECT_EQ(next, tiles);
    }
  }
}

TEST(TileShard, ARunIsThreeRectanglesAtMost) {
  const v1::TileRange whole = Range(-3, 5, 10, 8);
  for (std::int64_t first = 0; first < 80; ++first) {
    for (std::int64_t end = first + 1; end <= 80; ++end) {
      const auto rectangles = RectanglesOf(whole, Indices(first, end));
      EXPECT_LE(rectangles.size(), 3u);
      EXPECT_EQ(IndicesOf(whole, rectangles), Indices(first, end));
    }
  }
}

TEST(TileShard, WhatIsMissingHereAndThereIsAskedForOnce) {
  const v1::TileRange whole = Range(0, 0, 4, 4);
  const std::vector<std::int64_t> missing = {0, 3, 5, 6, 9, 10, 12, 15};
  const auto rectangles = RectanglesOf(whole, missing);
  EXPECT_EQ(IndicesOf(whole, rectangles), missing);
  EXPECT_EQ(rectangles.size(), 5u);  // 5, 6 and 9, 10 are one
  EXPECT_TRUE(RectanglesOf(whole, {}).empty());
}

TEST(TileShard, NoRectangleIsTooLargeForAStream) {
  const v1::TileRange wide = Range(0, 0, 10'000, 3);
  const auto rectangles = RectanglesOf(wide, Indices(0, 30'000));
  EXPECT_EQ(IndicesOf(wide, rectangles), Indices(0, 30'000));
  for (const v1::TileRange& part : rectangles) {
    EXPECT_LE(part.columns() * part.rows(), 4096);
  }
  const v1::TileRange high = Range(0, 0, 3, 10'000);
  for (const v1::TileRange& part : RectanglesOf(high, Indices(0, 30'000))) {
    EXPECT_LE(part.columns() * part.rows(), 4096);
  }
}

}  // namespace
}  // namespace terrane::client
