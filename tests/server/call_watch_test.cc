// The watch alone, and calls that it ends. One that steps in an hour before the
// deadline is told from gRPC, and from a client, which would not.
#include "server/service/call_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "tests/server/fake_actor.h"
#include "tests/server/scrape.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::hours kHour{1};

class NotingCall : public WatchedCall {
 public:
  void EndIfOverdue(const Overdue& overdue) override {
    const Clock::time_point now = Clock::now();
    deadline_age = now - overdue.deadline;
    waiting_age = now - overdue.waiting_since;
    ++looks;
  }

  std::atomic<int> looks = 0;
  std::atomic<Clock::duration> deadline_age{};
  std::atomic<Clock::duration> waiting_age{};
};

TEST(CallWatch, LooksAgainAndAgainAtWhatIsThere) {
  CallWatch watch(kHour, std::chrono::milliseconds(100));
  const auto stays = std::make_shared<NotingCall>();
  auto goes = std::make_shared<NotingCall>();
  watch.Add(stays);
  watch.Add(goes);
  ASSERT_TRUE(
      Eventually([&] { return stays->looks >= 3 && goes->looks >= 3; }));
  EXPECT_GE(stays->deadline_age.load(), kHour);
  EXPECT_LT(stays->deadline_age.load(), 2 * kHour);
  EXPECT_GE(stays->waiting_age.load(), std::chrono::milliseconds(100));
  EXPECT_LT(stays->waiting_age.load(), kHour);
  // The watch does not keep it.
  const std::weak_ptr<NotingCall> gone = goes;
  goes.reset();
  EXPECT_TRUE(Eventually([&] { return gone.expired(); }));
  const int before = stays->looks;
  EXPECT_TRUE(Eventually([&] { return stays->looks > before + 1; }));
}

ServerOptions Hasty() {
  ServerOptions options = WithHttp();
  options.deadline_grace = -kHour;
  return options;
}

class OverdueCallTest : public ::testing::Test {
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

  static std::unique_ptr<grpc::ClientReader<v1::StreamTilesResponse>> Stream(
      Served* served, int tiles, grpc::ClientContext* context) {
    v1::StreamTilesRequest request;
    request.set_tile_size(tiles);  // the fake actor's number of them
    return served->terrain->StreamTiles(context, request);
  }

  FakeActor actor_;
};

TEST_F(OverdueCallTest, EndsAStreamWhoseReaderTakesNothing) {
  actor_.tiles().tile_bytes = 8 << 20;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  const auto reader = Stream(&served, 100, &context);
  EXPECT_TRUE(Ends(&served, "StreamTiles"));
}

TEST_F(OverdueCallTest, EndsAStreamAtWork) {
  actor_.tiles().hold = true;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  const auto reader = Stream(&served, 1, &context);
  EXPECT_TRUE(Ends(&served, "StreamTiles"));
  EXPECT_EQ(actor_.tiles().stopped, actor_.tiles().started);
}

TEST_F(OverdueCallTest, EndsAPreparation) {
  actor_.tiles().hold_preparation = true;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  const auto reader = served.terrain->PrepareTerrain(&context, {});
  EXPECT_TRUE(Ends(&served, "PrepareTerrain"));
  EXPECT_EQ(actor_.tiles().stopped, actor_.tiles().started);
}

// The one worker is at the first of them.
TEST_F(OverdueCallTest, EndsUnaryCallsAtWorkAndInLine) {
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

TEST_F(OverdueCallTest, EndsAnUpload) {
  const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  Served served(actor.get(), Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  v1::UploadRasterResponse response;
  const auto writer = served.raster->UploadRaster(&context, &response);
  EXPECT_TRUE(Ends(&served, "UploadRaster"));
}

TEST_F(OverdueCallTest, LeavesCallsWithoutADeadlineAlone) {
  actor_.tiles().hold = true;
  Served served(&actor_, Hasty());
  grpc::ClientContext context;
  SetDeadline(&context);
  grpc::ClientContext endless;
  const auto stays = Stream(&served, 1, &endless);
  ASSERT_TRUE(Eventually([this] { return actor_.tiles().started == 1; }));
  const auto goes = Stream(&served, 1, &context);
  EXPECT_TRUE(Ends(&served, "StreamTiles"));
  EXPECT_EQ(actor_.tiles().stopped, 0);
}

}  // namespace
}  // namespace terrane::server
