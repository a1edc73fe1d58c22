#include "core/terrain/correction_table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace terrane::core {
namespace {

struct Entry {
  LatticePoint point;
  float value;
};

CorrectionTable Table(const std::vector<Entry>& entries, std::uint32_t slot,
                      int level, Mirror mirror, int dimensions = 2) {
  CorrectionTable::Builder builder(mirror, dimensions);
  for (const Entry& e : entries) builder.Announce(slot, level, e.point);
  builder.Allocate();
  for (const Entry& e : entries) builder.Add(slot, level, e.point, e.value);
  return std::move(builder).Build();
}

std::vector<float> Read(const CorrectionTable& table, std::uint32_t slot,
                        std::int64_t x, std::int64_t y, std::int64_t spacing,
                        int columns, int rows) {
  GridBuffer buffer;
  const GridView plane = buffer.Shape(columns, rows);
  std::vector<float> values;
  for (int j = 0; j < rows; ++j) std::fill_n(plane.Row(j), columns, 0.0f);
  table.AddTo(slot, x, y, spacing, columns, rows, plane);
  for (int j = 0; j < rows; ++j) {
    values.insert(values.end(), plane.Row(j), plane.Row(j) + columns);
  }
  return values;
}

TEST(CorrectionTableTest, AddsToEveryWindowWhatLiesInIt) {
  std::mt19937_64 engine(1);
  const auto draw = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(
                     engine() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<Entry> entries;
  std::map<std::pair<std::int64_t, std::int64_t>, float> expected;
  for (int k = 0; k < 3000; ++k) {
    const LatticePoint point = {draw(-90, 90), draw(-90, 90)};
    const auto value = static_cast<float>(draw(1, 1000));
    entries.push_back({point, value});
    expected[{point.x, point.y}] += value;
  }
  const CorrectionTable table = Table(entries, 5, 2, {});
  EXPECT_GT(table.MemoryBytes(), 3000 * 6);
  for (int k = 0; k < 200; ++k) {
    const std::int64_t x = draw(-100, 90);
    const std::int64_t y = draw(-100, 90);
    const std::int64_t spacing = draw(1, 2);
    const auto columns = static_cast<int>(draw(1, 80));
    const auto rows = static_cast<int>(draw(1, 80));
    const std::vector<float> read =
        Read(table, 5, x, y, spacing, columns, rows);
    std::size_t at = 0;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i, ++at) {
        const auto found = expected.find({x + spacing * i, y + spacing * j});
        ASSERT_EQ(read[at], found == expected.end() ? 0 : found->second)
            << x << " " << y << " by " << spacing << " at " << i << ", " << j;
      }
    }
  }
}

TEST(CorrectionTableTest, OtherHalfStepsAreLeftAlone) {
  const CorrectionTable table = Table({{{3, 4}, 1}}, 5, 2, {});
  EXPECT_EQ(Read(table, 4, 3, 4, 1, 1, 1)[0], 0);
  EXPECT_EQ(Read(table, 5, 3, 4, 1, 1, 1)[0], 1);
  EXPECT_EQ(Read(table, 6, 3, 4, 1, 1, 1)[0], 0);
  EXPECT_TRUE(CorrectionTable().empty());
}

TEST(CorrectionTableTest, BeyondTheBorderStandsTheMirrorImage) {
  // 3 x 2 cells at level 2: indices 0 to 12 and 0 to 8.
  const Mirror mirror = {Domain{3, 2}};
  const CorrectionTable table =
      Table({{{1, 7}, 2}, {{12, 0}, 3}, {{6, 4}, 5}}, 4, 2, mirror);
  constexpr auto kBeyond = static_cast<int>(CorrectionTable::kBeyondBorder);
  const std::vector<float> read =
      Read(table, 4, -kBeyond, -kBeyond, 1, 13 + 2 * kBeyond, 9 + 2 * kBeyond);
  std::size_t at = 0;
  for (int y = -kBeyond; y <= 8 + kBeyond; ++y) {
    for (int x = -kBeyond; x <= 12 + kBeyond; ++x, ++at) {
      const std::pair inside(Reflect(x, 12), Reflect(y, 8));
      const float expected =
          inside == std::pair<std::int64_t, std::int64_t>(1, 7)    ? 2
          : inside == std::pair<std::int64_t, std::int64_t>(12, 0) ? 3
          : inside == std::pair<std::int64_t, std::int64_t>(6, 4)  ? 5
                                                                   : 0;
      ASSERT_EQ(read[at], expected) << x << ", " << y;
    }
  }
}

TEST(CorrectionTableTest, WhatNoFloatHoldsIsLeftOut) {
  const CorrectionTable table =
      Table({{{0, 0}, CorrectionTable::kLeastValue / 2},
             {{1, 0}, 7},
             {{2, 0}, -CorrectionTable::kLeastValue / 2},
             {{3, 0}, -8}},
            1, 0, {});
  EXPECT_EQ(Read(table, 1, 0, 0, 1, 4, 1), (std::vector<float>{0, 7, 0, -8}));
}

}  // namespace
}  // namespace terrane::core
