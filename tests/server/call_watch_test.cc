// Calls that the server ends by its own clock. A watch that steps in an hour
// before the deadline is told from gRPC, and from a client, which would not.
#include "server/service/call_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "tests/server/fake_actor.h"
#include "tests/server/scrape.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

constexpr std::chrono::hours kHour{1};

ServerOptions Hasty() {
  ServerOptions options = WithHttp();
  options.deadline_grace = -kHour;
  return options;
}

class CallWatchTest : public ::testing::Test {
 protected:
  static void SetDeadline(grpc::ClientContext* context) {
    context->set_deadline(std::chrono::system_clock::now() + kHour);
  }
  // Whether the server ends `calls` calls of a method.
  static bool Ends(Served* served, const std::string& method, int calls = 1) {
    return EventuallyScraped(served, [&](const Exposition& text) {
      return Calls(text, method, "CANCELLED") == calls;
    });
  }

  FakeActor actor_;
};

TEST_F(CallWatchTest, EndsAStreamWhoseReaderTakesNothing) {
  actor_.tiles().tile_bytes = 8 << 20;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  v1::StreamTilesRequest request;
  request.set_tile_size(100);
  const auto reader = served.terrain->StreamTiles(&context, request);
  EXPECT_TRUE(Ends(&served, "StreamTiles"));
}

TEST_F(CallWatchTest, EndsAStreamAtWork) {
  actor_.tiles().hold = true;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  v1::StreamTilesRequest request;
  request.set_tile_size(1);
  const auto reader = served.terrain->StreamTiles(&context, request);
  EXPECT_TRUE(Ends(&served, "StreamTiles"));
  EXPECT_EQ(actor_.tiles().stopped, actor_.tiles().started);
}

TEST_F(CallWatchTest, EndsAPreparation) {
  actor_.tiles().hold_preparation = true;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  const auto reader = served.terrain->PrepareTerrain(&context, {});
  EXPECT_TRUE(Ends(&served, "PrepareTerrain"));
  EXPECT_EQ(actor_.tiles().stopped, actor_.tiles().started);
}

// The one worker is at the first of them.
TEST_F(CallWatchTest, EndsUnaryCallsAtWorkAndInLine) {
  actor_.tiles().hold = true;
  Served served(&actor_, Hasty());
  const auto ask = [&served] {
    grpc::ClientContext context;
    SetDeadline(&context);
    v1::GetProfileResponse response;
    EXPECT_EQ(served.terrain->GetProfile(&context, {}, &response).error_code(),
              grpc::StatusCode::CANCELLED);
  };
  std::thread first(ask);
  std::thread second(ask);
  first.join();
  second.join();
  EXPECT_TRUE(Ends(&served, "GetProfile", 2));
  EXPECT_EQ(actor_.tiles().stopped, actor_.tiles().started);
}

TEST_F(CallWatchTest, EndsAnUpload) {
  const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  Served served(actor.get(), Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  v1::UploadRasterResponse response;
  const auto writer = served.raster->UploadRaster(&context, &response);
  EXPECT_TRUE(Ends(&served, "UploadRaster"));
}

TEST_F(CallWatchTest, LeavesCallsWithoutADeadlineAlone) {
  actor_.tiles().hold = true;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  v1::StreamTilesRequest request;
  request.set_tile_size(1);
  grpc::ClientContext endless;
  const auto stays = served.terrain->StreamTiles(&endless, request);
  ASSERT_TRUE(Eventually([this] { return actor_.tiles().started == 1; }));
  const auto goes = served.terrain->StreamTiles(&context, request);
  EXPECT_TRUE(Ends(&served, "StreamTiles"));
  EXPECT_EQ(actor_.tiles().stopped, 0);
}

}  // namespace
}  // namespace terrane::server
