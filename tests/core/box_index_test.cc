#include "core/grid/box_index.h"

#include <limits>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

std::vector<std::uint32_t> Query(const BoxIndex& index, const Box& box) {
  std::vector<std::uint32_t> ids;
  EXPECT_TRUE(index.Query(box, kAll, &ids));
  return ids;
}

TEST(BoxIndexTest, FindsWhatALoopFindsInAscendingOrder) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1000);
  std::uniform_real_distribution<double> size(0, 40);
  const auto random_box = [&] {
    const double x = place(random);
    const double y = place(random);
    return Box{x, y, x + size(random), y + size(random)};
  };
  std::vector<Box> boxes(2000);
  for (Box& box : boxes) box = random_box();
  const BoxIndex index(boxes);
  for (int n = 0; n < 200; ++n) {
    const Box box = random_box();
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].Intersects(box)) expected.push_back(i);
    }
    EXPECT_EQ(Query(index, box), expected);
  }
}

TEST(BoxIndexTest, BordersTouch) {
  const std::vector<Box> boxes{{0, 0, 1, 1}, {1, 1, 2, 2}, {3, 3, 3, 3}};
  const BoxIndex index(boxes);
  EXPECT_THAT(Query(index, {1, 1, 1, 1}), ElementsAre(0, 1));
  EXPECT_THAT(Query(index, {2, 2, 3, 3}), ElementsAre(1, 2));
  EXPECT_THAT(Query(index, {4, 4, 5, 5}), IsEmpty());
}

TEST(BoxIndexTest, EndlessBoxes) {
  std::vector<Box> boxes(50, Box{5, kEverywhere.min_y, 6, kEverywhere.max_y});
  boxes[7] = {8, kEverywhere.min_y, 9, kEverywhere.max_y};
  const BoxIndex index(boxes);
  EXPECT_THAT(Query(index, {8.5, 1e15, 8.5, 1e15}), ElementsAre(7));
  EXPECT_EQ(Query(index, kEverywhere).size(), 50u);
}

TEST(BoxIndexTest, StopsAboveTheMost) {
  const std::vector<Box> boxes(10, Box{0, 0, 1, 1});
  const BoxIndex index(boxes);
  std::vector<std::uint32_t> ids;
  EXPECT_FALSE(index.Query({0, 0, 1, 1}, 9, &ids));
  EXPECT_TRUE(index.Query({0, 0, 1, 1}, 10, &ids));
  EXPECT_TRUE(index.Query({2, 2, 3, 3}, 0, &ids));
}

TEST(BoxIndexTest, NoBoxes) {
  EXPECT_THAT(Query(BoxIndex({}), kEverywhere), IsEmpty());
}

}  // namespace
}  // namespace terrane::core
