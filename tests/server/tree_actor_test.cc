// Trees through the Actor: rows, leaves, tubes, forests, estimates, errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/violations.h"
#include "server/actor/actor.h"
#include "tests/server/recipe_text.h"
#include "tests/server/tree_runs.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kLarge[] = R"("tree": {"recipe": {"lengthMode":
  "LENGTH_MODE_RELATIVE", "dimensions": 3, "depth": 13, "seed": "4",
  "leaves": {"count": 2}}})";

class TreeActorTest : public ::testing::Test {
 protected:
  std::vector<v1::StreamTreeResponse> Rows(const std::string& json) {
    return ReadAll(trees().OpenRows(FromJson<v1::StreamTreeRequest>(json)));
  }
  std::vector<v1::StreamTreeLeavesResponse> Leaves(const std::string& json) {
    return ReadAll(
        trees().OpenLeaves(FromJson<v1::StreamTreeLeavesRequest>(json)));
  }
  std::vector<v1::StreamTreeMeshResponse> Mesh(const std::string& json) {
    return ReadAll(trees().OpenMesh(FromJson<v1::StreamTreeMeshRequest>(json)));
  }
  std::vector<v1::StreamForestResponse> Forest(const std::string& json) {
    return ReadAll(trees().OpenForest(FromJson<v1::StreamForestRequest>(json)));
  }
  template <typename Run>
  static std::vector<std::string> Fields(const Run& run) {
    std::vector<std::string> fields;
    for (const core::Violation& one : core::ViolationsOf(run.status())) {
      fields.push_back(one.field);
    }
    return fields;
  }
  const TreeMaker& trees() { return actor_->trees(); }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
};

TEST_F(TreeActorTest, ADepthIsAPrefixOfTheNextByteForByte) {
  std::string parents;
  std::string ends;
  std::vector<std::int64_t> generation_ends;
  for (int depth = 0; depth <= 8; ++depth) {
    const TreeColumns tree = ColumnsOf(Rows(
        R"({"tree": {"recipe": {"lengthMode": "LENGTH_MODE_RELATIVE"},
            "depth": )" +
        std::to_string(depth) + "}}"));
    EXPECT_EQ(tree.parents.substr(0, parents.size()), parents) << depth;
    EXPECT_EQ(tree.ends.substr(0, ends.size()), ends) << depth;
    EXPECT_GT(tree.parents.size(), parents.size());
    parents = tree.parents;
    ends = tree.ends;
    generation_ends.push_back(tree.rows);
    EXPECT_EQ(tree.generation_ends, generation_ends);
  }
}

TEST_F(TreeActorTest, BlocksAreBoundedAndTheFirstIsSmall) {
  const auto messages = Rows(std::string("{") + kLarge + "}");
  ASSERT_GE(messages.size(), 4u);
  EXPECT_TRUE(messages[0].has_header());
  EXPECT_LE(messages[1].segments().rows(), 256);
  for (std::size_t k = 1; k < messages.size(); ++k) {
    EXPECT_LE(messages[k].segments().rows(), 16'384);
    EXPECT_LT(messages[k].ByteSizeLong(), 1u << 20);
  }
}

TEST_F(TreeActorTest, AResumedStreamIsTheRest) {
  const TreeColumns whole = ColumnsOf(Rows(std::string("{") + kLarge + "}"));
  for (const std::int64_t row :
       {std::int64_t{1}, std::int64_t{255}, std::int64_t{5000}, whole.rows - 1,
        whole.rows}) {
    const TreeColumns rest =
        ColumnsOf(Rows(std::string("{") + kLarge + R"(, "fromRow": ")" +
                       std::to_string(row) + "\"}"),
                  row);
    const auto at = static_cast<std::size_t>(row);
    EXPECT_EQ(rest.rows, whole.rows - row);
    EXPECT_EQ(rest.parents, whole.parents.substr(4 * at));
    EXPECT_EQ(rest.starts, whole.starts.substr(12 * at));
    EXPECT_EQ(rest.flags, whole.flags.substr(at));
    EXPECT_EQ(rest.extensions, whole.extensions.substr(4 * at));
  }
}

TEST_F(TreeActorTest, TheResolvedRecipeIsTheSameTree) {
  const auto messages = Rows(std::string("{") + kLarge + "}");
  const v1::TreeHeader& header = messages[0].header();
  EXPECT_EQ(header.revision(), 1);
  EXPECT_THAT(header.recipe_hash(), testing::StartsWith("sha256:"));
  EXPECT_EQ(header.recipe().genetic().population(), 8);
  EXPECT_DOUBLE_EQ(header.recipe().trunk_radius(), 15.5);
  v1::StreamTreeRequest again;
  *again.mutable_tree()->mutable_recipe() = header.recipe();
  const auto same = ReadAll(trees().OpenRows(again));
  ASSERT_EQ(same.size(), messages.size());
  for (std::size_t k = 0; k < same.size(); ++k) {
    EXPECT_EQ(same[k].SerializeAsString(), messages[k].SerializeAsString());
  }
}

TEST_F(TreeActorTest, LeavesSitOnTipsAndResume) {
  const auto messages = Leaves(std::string("{") + kLarge + "}");
  ASSERT_GE(messages.size(), 3u);
  const TreeColumns tree = ColumnsOf(Rows(std::string("{") + kLarge + "}"));
  const std::int64_t tips_from = tree.generation_ends[12];
  std::string positions;
  std::int64_t count = 0;
  for (std::size_t k = 1; k < messages.size(); ++k) {
    const v1::LeafRows& leaves = messages[k].leaves();
    EXPECT_EQ(leaves.first_leaf(), count);
    EXPECT_LE(leaves.leaves(), 16'384);
    count += leaves.leaves();
    positions += leaves.positions();
  }
  // Two for each branch of the last generation, and for those that ended.
  EXPECT_GE(count, 2 * (tree.rows - tips_from));
  const std::int64_t from = count / 2 + 1;
  const auto rest = Leaves(std::string("{") + kLarge + R"(, "fromLeaf": ")" +
                           std::to_string(from) + "\"}");
  std::string rest_positions;
  for (std::size_t k = 1; k < rest.size(); ++k) {
    rest_positions += rest[k].leaves().positions();
  }
  EXPECT_EQ(rest[1].leaves().first_leaf(), from);
  EXPECT_EQ(rest_positions,
            positions.substr(12 * static_cast<std::size_t>(from)));
}

TEST_F(TreeActorTest, TubesResumeAndCanLeaveGenerationsOut) {
  const auto messages = Mesh(std::string("{") + kLarge + "}");
  ASSERT_GE(messages.size(), 4u);
  const auto rest = Mesh(std::string("{") + kLarge + R"(, "firstBlock": "2"})");
  ASSERT_EQ(rest.size(), messages.size() - 2);
  for (std::size_t k = 1; k < rest.size(); ++k) {
    EXPECT_EQ(rest[k].SerializeAsString(), messages[k + 2].SerializeAsString());
  }
  const auto coarse = Mesh(std::string("{") + kLarge +
                           R"(, "tubes": {"lastGeneration": 3, "sides": 5}})");
  const auto shallow = Mesh(
      R"({"tree": {"recipe": {"lengthMode": "LENGTH_MODE_RELATIVE",
          "dimensions": 3, "depth": 3, "seed": "4", "leaves": {"count": 2}}},
          "tubes": {"sides": 5}})");
  ASSERT_EQ(coarse.size(), shallow.size());
  for (std::size_t k = 1; k < coarse.size(); ++k) {
    EXPECT_EQ(coarse[k].SerializeAsString(), shallow[k].SerializeAsString());
  }
}

TEST_F(TreeActorTest, AForestIsItsTreesOneAfterTheOther) {
  const auto forest = Forest(
      R"({"tree": {"recipe": {"leaves": {}}}, "leaves": true,
          "seeds": {"firstSeed": "-1", "count": "3"}})");
  std::vector<TreeColumns> trees(3);
  std::vector<std::int64_t> leaves(3);
  std::int64_t ended = 0;
  for (std::size_t k = 1; k < forest.size(); ++k) {
    const v1::ForestBlock& block = forest[k].block();
    ASSERT_EQ(block.tree(), ended);
    if (block.has_leaves()) {
      leaves[static_cast<std::size_t>(block.tree())] += block.leaves().leaves();
    } else {
      trees[static_cast<std::size_t>(block.tree())].Add(block.segments());
    }
    if (block.ends_tree()) ++ended;
  }
  EXPECT_EQ(ended, 3);
  for (int k = 0; k < 3; ++k) {
    const std::string one = R"({"tree": {"recipe": {"leaves": {}}, "seed": ")" +
                            std::to_string(k - 1) + "\"}}";
    const TreeColumns alone = ColumnsOf(Rows(one));
    const auto index = static_cast<std::size_t>(k);
    EXPECT_EQ(trees[index].ends, alone.ends) << k;
    EXPECT_EQ(trees[index].chromosomes, alone.chromosomes) << k;
    std::int64_t leaves_alone = 0;
    for (const auto& message : Leaves(one)) {
      leaves_alone += message.leaves().leaves();
    }
    EXPECT_EQ(leaves[index], leaves_alone);
  }
}

TEST_F(TreeActorTest, AForestOfPlacementsResumesAtATree) {
  const std::string placed = R"("tree": {"recipe": {"form": "TREE_FORM_PLAIN",
      "depth": 3}}, "placements": {"placements": [{"seed": "1", "x": 5},
      {"seed": "2", "y": -3, "scale": 2}, {"seed": "3", "yawDeg": 90}]})";
  const auto whole = Forest("{" + placed + "}");
  const auto rest = Forest("{" + placed + R"(, "firstTree": "2"})");
  ASSERT_EQ(whole.size(), 4u);
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_EQ(rest[1].SerializeAsString(), whole[3].SerializeAsString());
}

TEST_F(TreeActorTest, EstimatesAreBoundsAndExactForPlainTrees) {
  const auto estimate = [this](const std::string& json) {
    return *trees().Estimate(FromJson<v1::EstimateTreeRequest>(json));
  };
  const auto large = estimate(std::string("{") + kLarge + "}");
  const TreeColumns rows = ColumnsOf(Rows(std::string("{") + kLarge + "}"));
  EXPECT_GE(large.segments_most(), rows.rows);
  EXPECT_EQ(large.data_bytes_most(), large.segments_most() * 49);
  EXPECT_EQ(large.leaves_most(), large.segments_most() * 2);
  EXPECT_GT(large.cpu_seconds_most(), 0);
  EXPECT_GT(large.memory_bytes_most(), 0);
  EXPECT_EQ(estimate(R"({"tree": {"recipe": {"form": "TREE_FORM_PLAIN"}}})")
                .segments_most(),
            255);
}

TEST_F(TreeActorTest, ATrunkWithoutLengthEndsWithAnError) {
  EXPECT_THAT(Fields(trees().OpenRows(FromJson<v1::StreamTreeRequest>(
                  R"({"tree": {"recipe": {"genetic": {"trunk": 0}}}})"))),
              ElementsAre("tree.recipe.genetic.trunk"));
}

TEST_F(TreeActorTest, EveryViolationIsNamed) {
  const auto run = trees().OpenMesh(FromJson<v1::StreamTreeMeshRequest>(
      R"({"tree": {"recipe": {"depth": 99, "dimensions": 4, "form": 7,
          "genetic": {"leftShare": 1.5, "population": 65, "density": 9,
                      "angleMinDeg": "NaN"}}},
          "tubes": {"sides": 2}, "firstBlock": "-1"})"));
  EXPECT_THAT(
      Fields(run),
      testing::UnorderedElementsAre(
          "tree.recipe.form", "tree.recipe.dimensions", "tree.recipe.depth",
          "tree.recipe.genetic.density", "tree.recipe.genetic.left_share",
          "tree.recipe.genetic.population", "tree.recipe.genetic.angle_min_deg",
          "tubes.sides", "first_block"));
}

TEST_F(TreeActorTest, TooLargeIsRefusedBeforeItGrows) {
  EXPECT_THAT(Fields(trees().OpenRows(FromJson<v1::StreamTreeRequest>(
                  R"({"tree": {"recipe": {"depth": 32,
                      "lengthMode": "LENGTH_MODE_RELATIVE"}}})"))),
              ElementsAre("tree.recipe.depth"));
  const auto forest = [this](const std::string& trees_json) {
    return trees().OpenForest(FromJson<v1::StreamForestRequest>(
        R"({"tree": {"recipe": {}}, )" + trees_json + "}"));
  };
  const auto many = forest(R"("seeds": {"count": "1000000000"})");
  EXPECT_THAT(Fields(many), ElementsAre("seeds.count"));
  EXPECT_THAT(std::string(many.status().message()),
              HasSubstr("must be in [1, 1000000], got 1000000000"));
  EXPECT_THAT(Fields(forest(R"("seeds": {"count": "1000000"})")),
              ElementsAre("trees"));
  EXPECT_THAT(Fields(forest(R"("seeds": {"count": "0"})")),
              ElementsAre("seeds.count"));
  EXPECT_THAT(Fields(forest(R"("placements": {"placements": [{"x": "NaN",
                               "scale": -1, "yawDeg": 400}]})")),
              ElementsAre("placements.placements[0].x",
                          "placements.placements[0].scale",
                          "placements.placements[0].yaw_deg"));
}

TEST_F(TreeActorTest, WhatIsNotThereIsSaid) {
  EXPECT_TRUE(
      absl::IsNotFound(trees()
                           .OpenRows(FromJson<v1::StreamTreeRequest>(
                               R"({"tree": {"preset": "tree/nothing"}})"))
                           .status()));
  EXPECT_THAT(Fields(trees().OpenRows({})), ElementsAre("tree"));
  EXPECT_THAT(Fields(trees().OpenLeaves(FromJson<v1::StreamTreeLeavesRequest>(
                  R"({"tree": {"recipe": {}}})"))),
              ElementsAre("tree"));
  EXPECT_THAT(Fields(trees().OpenForest(FromJson<v1::StreamForestRequest>(
                  R"({"tree": {"recipe": {}}, "leaves": true})"))),
              ElementsAre("leaves", "trees"));
}

// A wrong field hides none of the others, nor does an unknown preset.
TEST_F(TreeActorTest, NoFieldHidesAnother) {
  EXPECT_THAT(Fields(trees().OpenRows(FromJson<v1::StreamTreeRequest>(
                  R"({"tree": {"preset": "tree/nothing"}, "fromRow": "-1"})"))),
              ElementsAre("from_row"));
  EXPECT_THAT(
      Fields(trees().OpenMesh(FromJson<v1::StreamTreeMeshRequest>(
          R"({"tree": {"preset": "tree/nothing"}, "tubes": {"sides": 2}})"))),
      ElementsAre("tubes.sides"));
  EXPECT_THAT(Fields(trees().OpenForest(FromJson<v1::StreamForestRequest>(
                  R"({"tree": {"preset": "tree/nothing"}, "firstTree": "-1",
                      "seeds": {"count": "0"}})"))),
              ElementsAre("seeds.count", "first_tree"));
}

TEST_F(TreeActorTest, AnIndexBehindTheEndIsAViolationWhenTheTreeHasEnded) {
  auto run = trees().OpenRows(FromJson<v1::StreamTreeRequest>(
      R"({"tree": {"recipe": {"depth": 1}}, "fromRow": "5"})"));
  ASSERT_TRUE(run.ok());
  v1::StreamTreeResponse message;
  ASSERT_TRUE((*run)->Next({}, &message).ok());
  EXPECT_THAT(core::ViolationsOf((*run)->Next({}, &message)),
              ElementsAre(testing::Field(&core::Violation::field, "from_row")));
}

TEST_F(TreeActorTest, StopEndsARun) {
  auto run = trees().OpenRows(
      FromJson<v1::StreamTreeRequest>(std::string("{") + kLarge + "}"));
  ASSERT_TRUE(run.ok());
  v1::StreamTreeResponse message;
  ASSERT_TRUE((*run)->Next({}, &message).ok());
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled((*run)->Next(stop.get_token(), &message)));
}

}  // namespace
}  // namespace terrane::server
