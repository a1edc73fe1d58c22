// Flowers over loopback: what only the network adds to flower_actor_test.cc.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/server/read_all.h"
#include "tests/server/recipe_text.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

TEST(ServedFlowerTest, EveryCallIsServed) {
  const std::unique_ptr<Actor> actor = MakeActor({}, 2);
  Served served(actor.get());
  const auto request = FromJson<v1::StreamFlowerRequest>(
      R"({"flower": {"preset": "flower/daisy", "plants": 30}})");
  {
    grpc::ClientContext context;
    const auto reader = served.flower->StreamFlower(&context, request);
    const auto expected = ReadAll(actor->flowers().Open(request));
    v1::StreamFlowerResponse message;
    for (const v1::StreamFlowerResponse& one : expected) {
      ASSERT_TRUE(reader->Read(&message));
      EXPECT_EQ(message.SerializeAsString(), one.SerializeAsString());
    }
    EXPECT_FALSE(reader->Read(&message));
    EXPECT_TRUE(reader->Finish().ok());
  }
  {
    grpc::ClientContext context;
    v1::EstimateFlowerRequest ask;
    *ask.mutable_flower() = request.flower();
    v1::EstimateFlowerResponse estimate;
    ASSERT_TRUE(served.flower->EstimateFlower(&context, ask, &estimate).ok());
    EXPECT_GT(estimate.instances(), 30);
  }
  {
    grpc::ClientContext context;
    v1::GetFlowerPresetRequest ask;
    ask.set_name("flower/rose");
    v1::GetFlowerPresetResponse answer;
    ASSERT_TRUE(served.flower->GetFlowerPreset(&context, ask, &answer).ok());
    EXPECT_EQ(answer.preset().name(), "flower/rose");
  }
  grpc::ClientContext context;
  const auto reader =
      served.flower->StreamFlower(&context, v1::StreamFlowerRequest());
  v1::StreamFlowerResponse message;
  EXPECT_FALSE(reader->Read(&message));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

}  // namespace
}  // namespace terrane::server
