// PrepareTerrain over loopback: progress, the result, cancellation, and streams
// that are cancelled while their terrain is made ready.
#include "server/service/prepare_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "tests/server/fake_actor.h"
#include "tests/server/scrape.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

using std::chrono::steady_clock;
using ::testing::HasSubstr;

class PrepareCallTest : public ::testing::Test {
 protected:
  std::unique_ptr<grpc::ClientReader<v1::PrepareTerrainResponse>> Prepare(
      grpc::ClientContext* context) {
    return served_.terrain->PrepareTerrain(context, {});
  }

  FakeActor actor_;
  Served served_{&actor_, WithHttp()};
};

TEST_F(PrepareCallTest, ResultIsTheLastMessage) {
  grpc::ClientContext context;
  const auto reader = Prepare(&context);
  v1::PrepareTerrainResponse message;
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.prepared().recipe_hash(), "sha256:fake");
  EXPECT_FALSE(reader->Read(&message));
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_THAT(served_.StopAndReadLog(),
              HasSubstr("\"method\":\"PrepareTerrain\",\"code\":\"OK\""));
}

TEST_F(PrepareCallTest, ProgressComesAtLeastOnceASecond) {
  actor_.tiles().hold_preparation = true;
  grpc::ClientContext context;
  const auto reader = Prepare(&context);
  v1::PrepareTerrainResponse message;
  // A machine that stands still makes one gap longer, not all.
  steady_clock::duration smallest_gap = steady_clock::duration::max();
  steady_clock::time_point before = steady_clock::now();
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(reader->Read(&message));
    EXPECT_EQ(message.progress().fraction(), 0.25);
    const steady_clock::time_point now = steady_clock::now();
    smallest_gap = std::min(smallest_gap, now - before);
    before = now;
  }
  EXPECT_LT(smallest_gap, std::chrono::seconds(1));
  actor_.tiles().hold_preparation = false;
  while (message.has_progress()) ASSERT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.has_prepared());
  EXPECT_TRUE(reader->Finish().ok());
}

// The only worker is busy: the second call waits in line, and says so.
TEST_F(PrepareCallTest, QueuedCallShowsProgressAndCanBeCancelled) {
  actor_.tiles().hold_preparation = true;
  grpc::ClientContext first_context;
  const auto first = Prepare(&first_context);
  ASSERT_TRUE(Eventually([&] { return actor_.tiles().started == 1; }));
  grpc::ClientContext second_context;
  const auto second = Prepare(&second_context);
  v1::PrepareTerrainResponse message;
  ASSERT_TRUE(second->Read(&message));
  EXPECT_EQ(message.progress().fraction(), 0);
  second_context.TryCancel();
  EXPECT_EQ(second->Finish().error_code(), grpc::StatusCode::CANCELLED);
  // The client knows at once; the server needs a moment to.
  EXPECT_TRUE(EventuallyScraped(&served_, [](const Exposition& text) {
    return Calls(text, "PrepareTerrain", "CANCELLED") == 1;
  }));
  actor_.tiles().hold_preparation = false;
  while (first->Read(&message)) {
  }
  EXPECT_TRUE(first->Finish().ok());
  served_.StopAndReadLog();
  EXPECT_EQ(actor_.tiles().started, 1);
}

TEST_F(PrepareCallTest, CancellingEndsTheWork) {
  actor_.tiles().hold_preparation = true;
  grpc::ClientContext context;
  const auto reader = Prepare(&context);
  ASSERT_TRUE(Eventually([&] { return actor_.tiles().started == 1; }));
  context.TryCancel();
  EXPECT_TRUE(Eventually([&] { return actor_.tiles().stopped == 1; }));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_THAT(served_.StopAndReadLog(), HasSubstr("\"code\":\"CANCELLED\""));
}

TEST_F(PrepareCallTest, PassedDeadlineEndsTheWork) {
  actor_.tiles().hold_preparation = true;
  ASSERT_TRUE(EventuallyStarts(actor_.tiles(), [this](auto deadline) {
    grpc::ClientContext context;
    context.set_deadline(deadline);
    const auto reader = Prepare(&context);
    v1::PrepareTerrainResponse message;
    while (reader->Read(&message)) {
    }
    EXPECT_EQ(reader->Finish().error_code(),
              grpc::StatusCode::DEADLINE_EXCEEDED);
  }));
  EXPECT_TRUE(Eventually(
      [&] { return actor_.tiles().stopped == actor_.tiles().started; }));
}

TEST_F(PrepareCallTest, StreamCancelledDuringPreparationEndsTheWork) {
  actor_.tiles().hold_preparation = true;
  grpc::ClientContext context;
  v1::StreamTilesRequest request;
  request.set_tile_size(1);
  const auto reader = served_.terrain->StreamTiles(&context, request);
  ASSERT_TRUE(Eventually([&] { return actor_.tiles().started == 1; }));
  context.TryCancel();
  EXPECT_TRUE(Eventually([&] { return actor_.tiles().stopped == 1; }));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

}  // namespace
}  // namespace terrane::server
