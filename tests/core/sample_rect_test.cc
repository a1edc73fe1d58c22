#include "core/grid/sample_rect.h"

#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace terrane::core {
namespace {

SampleGrid GridOf(std::vector<double> x, std::vector<double> y) {
  SampleGrid grid;
  grid.x = std::move(x);
  grid.y = std::move(y);
  return grid;
}

void ExpectRect(const SampleRect& rect, std::size_t column_begin,
                std::size_t column_end, std::size_t row_begin,
                std::size_t row_end) {
  EXPECT_EQ(rect.column_begin, column_begin);
  EXPECT_EQ(rect.column_end, column_end);
  EXPECT_EQ(rect.row_begin, row_begin);
  EXPECT_EQ(rect.row_end, row_end);
}

TEST(SampleRectTest, HoldsTheBorderOnRisingAndFallingAxes) {
  const SampleGrid grid = GridOf({0, 1, 2, 3, 4}, {40, 30, 20, 10});
  ExpectRect(SamplesIn(grid, {1, 20, 3, 30}), 1, 4, 1, 3);
  ExpectRect(SamplesIn(grid, {0.5, 15, 2.5, 100}), 1, 3, 0, 3);
  ExpectRect(SamplesIn(grid, kEverywhere), 0, 5, 0, 4);
}

TEST(SampleRectTest, BoxesBetweenAndBesideSamplesAreEmpty) {
  const SampleGrid grid = GridOf({0, 1, 2}, {40, 30});
  EXPECT_TRUE(SamplesIn(grid, {1.2, 0, 1.8, 100}).empty());
  EXPECT_TRUE(SamplesIn(grid, {5, 0, 6, 100}).empty());
  EXPECT_TRUE(SamplesIn(grid, {0, 50, 2, 60}).empty());
  EXPECT_FALSE(SamplesIn(grid, {1, 30, 1, 30}).empty());
}

TEST(SampleRectTest, BoxOfIsTheSamplesBox) {
  const SampleGrid grid = GridOf({0, 1, 2}, {40, 30, 20});
  const Box box = BoxOf(grid, {1, 3, 0, 2});
  EXPECT_EQ(box.min_x, 1);
  EXPECT_EQ(box.max_x, 2);
  EXPECT_EQ(box.min_y, 30);
  EXPECT_EQ(box.max_y, 40);
  EXPECT_FALSE(AllSamples(grid).empty());
  EXPECT_EQ(AllSamples(grid).rows(), 3u);
}

}  // namespace
}  // namespace terrane::core
