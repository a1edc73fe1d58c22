// Spots of a file in a recipe, and errors that come back by their place in it.
#include "client/chosen_spots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/chosen_terrain.h"
#include "core/base/violations.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;

ChosenTerrain WithSpots() {
  const auto spots = std::make_shared<SpotFile>();
  spots->path = "a.csv";
  spots->table.x = {1, 2, 3};
  spots->table.source = {2, 5, 9};
  spots->lines.push_back({{}, {}, {}, 0, 12});
  ChosenTerrain terrain;
  terrain.spots = spots;
  return terrain;
}

TEST(NameRowsTest, RowsAreNamedByTheirPlaceInTheFile) {
  core::Violations violations;
  violations.Add("terrain.recipe.spots.table[1]",
                 "must have the height of spots.table[0], which is at the same "
                 "point: 5, got 6");
  violations.Add("request.terrain.recipe.spots.lines[0].heights",
                 "must not rise beside spots.table[2]");
  EXPECT_THAT(
      core::ViolationsOf(NameRows(violations.ToStatus(), WithSpots())),
      ElementsAre(core::Violation{"a.csv line 5",
                                  "must have the height of a.csv line 2, which "
                                  "is at the same point: 5, got 6"},
                  core::Violation{"a.csv line 12.heights",
                                  "must not rise beside a.csv line 9"}));
}

TEST(NameRowsTest, WhatIsNotInTheFileStaysAsItIs) {
  const absl::Status unknown =
      core::ViolationError("recipe.spots.table[3]", "spots.table[x] level");
  EXPECT_EQ(core::ViolationsOf(NameRows(unknown, WithSpots())),
            core::ViolationsOf(unknown));
  const absl::Status other = absl::UnavailableError("spots.table[0]");
  EXPECT_EQ(NameRows(other, WithSpots()), other);
  EXPECT_EQ(NameRows(unknown, ChosenTerrain()), unknown);
}

}  // namespace
}  // namespace terrane::client
