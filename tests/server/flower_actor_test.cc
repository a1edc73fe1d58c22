// Flowers through the Actor: parts, resuming, the resolved recipe, estimates,
// errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/violations.h"
#include "server/actor/actor.h"
#include "server/actor/presets.h"
#include "tests/server/read_all.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

// A mesh of two parts, two others, and instances of two blocks.
constexpr char kBed[] = R"("flower": {"recipe": {"seed": "3", "petals": [
    {"count": 40, "blade": {"columns": 120, "rows": 120, "sketches": [
        {"points": [{"x": 0.3, "y": 0.3}, {"x": 0.4, "y": 0.7}]}]}}],
    "solids": [{"count": 8}], "stem": {"variants": 1},
    "bed": {"plants": 400}}})";

class FlowerActorTest : public ::testing::Test {
 protected:
  std::vector<v1::StreamFlowerResponse> Parts(const std::string& json) {
    return ReadAll(flowers().Open(FromJson<v1::StreamFlowerRequest>(json)));
  }
  std::vector<std::string> Fields(const std::string& json) {
    std::vector<std::string> fields;
    const auto run = flowers().Open(FromJson<v1::StreamFlowerRequest>(json));
    for (const core::Violation& one : core::ViolationsOf(run.status())) {
      fields.push_back(one.field);
    }
    return fields;
  }
  const FlowerMaker& flowers() { return actor_->flowers(); }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
};

TEST_F(FlowerActorTest, PrototypesComeWholeThenInstancesOfThem) {
  const auto messages = Parts(std::string("{") + kBed + "}");
  const v1::FlowerHeader& header = messages[0].header();
  EXPECT_EQ(header.prototypes(), 3);
  EXPECT_EQ(header.rows(), 49 * 400);
  ASSERT_EQ(header.parts(), static_cast<std::int64_t>(messages.size()) - 1);
  std::vector<v1::PrototypeInfo> infos;
  std::vector<std::size_t> vertices(3);
  std::vector<std::size_t> indices(3);
  std::int64_t rows = 0;
  for (std::size_t k = 1; k < messages.size(); ++k) {
    EXPECT_LT(messages[k].ByteSizeLong(), 1u << 20);
    if (messages[k].has_prototype()) {
      EXPECT_EQ(rows, 0);
      const v1::PrototypePart& part = messages[k].prototype();
      EXPECT_EQ(part.part(), static_cast<std::int64_t>(k) - 1);
      if (part.has_info()) infos.push_back(part.info());
      ASSERT_EQ(infos.size(), static_cast<std::size_t>(part.prototype()) + 1);
      vertices[infos.size() - 1] += part.positions().size() / 12;
      indices[infos.size() - 1] += part.indices().size() / 4;
      continue;
    }
    EXPECT_EQ(messages[k].instances().first_row(), rows);
    rows += messages[k].instances().rows();
  }
  EXPECT_EQ(rows, header.rows());
  for (std::size_t k = 0; k < infos.size(); ++k) {
    EXPECT_EQ(static_cast<std::size_t>(infos[k].vertices()), vertices[k]);
    EXPECT_EQ(static_cast<std::size_t>(infos[k].indices()), indices[k]);
  }
  EXPECT_GT(vertices[1], 8192u);
}

TEST_F(FlowerActorTest, EveryPartCanBeTheFirst) {
  const auto whole = Parts(std::string("{") + kBed + "}");
  for (std::size_t first = 0; first < whole.size(); ++first) {
    const auto rest = Parts(std::string("{") + kBed + R"(, "firstPart": ")" +
                            std::to_string(first) + "\"}");
    ASSERT_EQ(rest.size(), whole.size() - first);
    for (std::size_t k = 1; k < rest.size(); ++k) {
      EXPECT_EQ(rest[k].SerializeAsString(),
                whole[first + k].SerializeAsString());
    }
  }
  EXPECT_THAT(Fields(std::string("{") + kBed + R"(, "firstPart": "99"})"),
              ElementsAre("first_part"));
}

TEST_F(FlowerActorTest, TheResolvedRecipeIsTheSameFlower) {
  const auto messages = Parts(std::string("{") + kBed + "}");
  v1::StreamFlowerRequest again;
  *again.mutable_flower()->mutable_recipe() = messages[0].header().recipe();
  const auto same = ReadAll(flowers().Open(again));
  ASSERT_EQ(same.size(), messages.size());
  for (std::size_t k = 0; k < same.size(); ++k) {
    EXPECT_EQ(same[k].SerializeAsString(), messages[k].SerializeAsString());
  }
}

// Every preset is valid, stays what it is when resolved, and is a recipe whose
// every field survives the way to the core and back.
TEST_F(FlowerActorTest, PresetsStandForThemselves) {
  ASSERT_FALSE(FlowerPresets().empty());
  for (const auto& [name, preset] : FlowerPresets()) {
    v1::StreamFlowerRequest request;
    request.mutable_flower()->set_preset(name);
    const auto run = flowers().Open(request);
    ASSERT_TRUE(run.ok()) << name << ": " << run.status();
    EXPECT_FALSE(preset.title().empty()) << name;
    EXPECT_FALSE(preset.description().empty()) << name;
    v1::StreamFlowerResponse header;
    ASSERT_TRUE((*run)->Next({}, &header).ok());
    EXPECT_THAT(header.header().warnings(), testing::IsEmpty()) << name;
    v1::StreamFlowerRequest resolved;
    *resolved.mutable_flower()->mutable_recipe() = header.header().recipe();
    const auto again = flowers().Open(resolved);
    ASSERT_TRUE(again.ok()) << name << ": " << again.status();
    EXPECT_EQ((*again)->recipe_hash(), (*run)->recipe_hash()) << name;
  }
}

TEST_F(FlowerActorTest, AChoiceReplacesWhatItNames) {
  const auto hash = [this](const std::string& extra) {
    auto run = flowers().Open(FromJson<v1::StreamFlowerRequest>(
        R"({"flower": {"preset": "flower/rose")" + extra + "}}"));
    EXPECT_TRUE(run.ok()) << run.status();
    return (*run)->recipe_hash();
  };
  const std::string own = hash("");
  for (const char* extra :
       {R"(, "seed": "7")", R"(, "stage": 0.25)", R"(, "plants": 5)",
        R"(, "method": "PETAL_METHOD_BEZIER")"}) {
    EXPECT_NE(hash(extra), own) << extra;
  }
}

TEST_F(FlowerActorTest, EstimatesAreExact) {
  const auto estimate = *flowers().Estimate(
      FromJson<v1::EstimateFlowerRequest>(std::string("{") + kBed + "}"));
  EXPECT_EQ(estimate.prototypes(), 3);
  EXPECT_EQ(estimate.instances(), 49 * 400);
  EXPECT_EQ(estimate.instance_bytes(), 53 * 49 * 400);
  std::int64_t bytes = 0;
  std::int64_t vertices = 0;
  for (const auto& message : Parts(std::string("{") + kBed + "}")) {
    const v1::PrototypePart& part = message.prototype();
    vertices += static_cast<std::int64_t>(part.positions().size() / 12);
    bytes += static_cast<std::int64_t>(
        part.positions().size() + part.normals().size() + part.uvs().size() +
        part.colors().size() + part.indices().size());
  }
  EXPECT_EQ(estimate.vertices(), vertices);
  EXPECT_EQ(estimate.prototype_bytes(), bytes);
  EXPECT_GE(estimate.memory_bytes(), bytes);
}

TEST_F(FlowerActorTest, EveryViolationIsNamed) {
  EXPECT_THAT(
      Fields(R"({"flower": {"recipe": {"unitM": -1, "method": 9, "petals": [
          {"organ": "FLOWER_ORGAN_STEM", "count": -3, "angleDeg": "NaN",
           "blade": {"sketches": [{"points": [{"x": 0.3, "y": 0.5},
               {"x": 0.3, "y": 0.4}]}], "steps": 99,
               "material": {"roughness": 2}}}],
          "bed": {"plants": 2000000}, "stage": 1.5}}})"),
      UnorderedElementsAre(
          "flower.recipe.unit_m", "flower.recipe.method",
          "flower.recipe.petals[0].organ", "flower.recipe.petals[0].count",
          "flower.recipe.petals[0].angle_deg",
          HasSubstr("flower.recipe.petals[0].blade.sketches[0].points"),
          "flower.recipe.petals[0].blade.steps",
          "flower.recipe.petals[0].blade.material.roughness",
          "flower.recipe.bed.plants", "flower.recipe.stage"));
}

TEST_F(FlowerActorTest, TooManyAndTooFewAreRefused) {
  std::string groups;
  for (int k = 0; k < 40; ++k) {
    groups += std::string(k == 0 ? "" : ", ") + R"({"count": 1})";
  }
  EXPECT_THAT(Fields(R"({"flower": {"recipe": {"solids": [)" + groups + "]}}}"),
              ElementsAre("flower.recipe.solids"));
  EXPECT_THAT(Fields(R"({"flower": {"recipe": {}}})"),
              testing::Not(testing::IsEmpty()));
  EXPECT_THAT(Fields(R"({"flower": {"recipe": {"solids": [{}], "stem":
                  {"material": {"name": ")" +
                     std::string(65, 'x') + R"("}}}}})"),
              ElementsAre("flower.recipe.stem.material.name"));
  EXPECT_THAT(Fields("{}"), ElementsAre("flower"));
  EXPECT_THAT(Fields(R"({"flower": {"preset": "flower/rose", "plants": 0}})"),
              ElementsAre("flower.plants"));
  EXPECT_TRUE(
      absl::IsNotFound(flowers()
                           .Open(FromJson<v1::StreamFlowerRequest>(
                               R"({"flower": {"preset": "flower/nothing"}})"))
                           .status()));
}

TEST_F(FlowerActorTest, NoFieldHidesAnother) {
  EXPECT_THAT(Fields(R"({"flower": {"preset": "flower/nothing", "plants": 0},
                         "firstPart": "-1"})"),
              ElementsAre("flower.plants", "first_part"));
  EXPECT_THAT(Fields(R"({"flower": {"preset": "flower/rose", "stage": 2},
                         "firstPart": "-1"})"),
              ElementsAre("flower.preset.stage", "first_part"));
}

// Once it was asked to stop, nothing is made, but all is checked all the same.
TEST_F(FlowerActorTest, APartThatThereIsNotIsRefusedBeforeWork) {
  std::stop_source stop;
  stop.request_stop();
  const auto open = [&](const std::string& first) {
    return flowers()
        .Open(FromJson<v1::StreamFlowerRequest>(std::string("{") + kBed +
                                                R"(, "firstPart": ")" + first +
                                                "\"}"),
              stop.get_token())
        .status();
  };
  EXPECT_TRUE(absl::IsInvalidArgument(open("99"))) << open("99");
  EXPECT_TRUE(absl::IsCancelled(open("0"))) << open("0");
}

TEST_F(FlowerActorTest, StopEndsARun) {
  auto run = flowers().Open(FromJson<v1::StreamFlowerRequest>(
      R"({"flower": {"recipe": {"solids": [{}], "bed": {"plants": 1000000}}}})"));
  ASSERT_TRUE(run.ok());
  std::stop_source stop;
  v1::StreamFlowerResponse message;
  ASSERT_TRUE((*run)->Next(stop.get_token(), &message).ok());
  ASSERT_TRUE((*run)->Next(stop.get_token(), &message).ok());
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled((*run)->Next(stop.get_token(), &message)));
}

}  // namespace
}  // namespace terrane::server
