// RemoteBackend against servers that fall silent, vanish, or are slow to begin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "client/remote_backend.h"
#include "tests/client/faulty_server.h"
#include "tests/client/relay.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

Patience StallAfter(milliseconds stall) {
  Patience patience;
  patience.stall = stall;
  return patience;
}

class SilenceTest : public testing::Test {
 protected:
  void SetUp() override {
    server_ = Serve(&faulty_, &port_);
    ASSERT_NE(server_, nullptr);
  }
  void TearDown() override {
    server_->Shutdown(std::chrono::system_clock::now());
  }

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

  // Streams all tiles; `on_tile_` sees the index of each.
  absl::Status Stream(RemoteBackend* backend) {
    return backend->StreamTiles(
        v1::StreamTilesRequest(),
        [](const v1::StreamHeader&) { return absl::OkStatus(); },
        [&](const v1::HeightTile& tile) {
          received_ += tile.data()[0];
          if (on_tile_) on_tile_(tile.index());
          return absl::OkStatus();
        },
        {});
  }

  FaultyServer faulty_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  std::string received_;
  std::function<void(std::int64_t)> on_tile_;
};

TEST_F(SilenceTest, SilentStreamIsCancelledAndResumed) {
  faulty_.silent_before = 2;
  RemoteBackend backend(address(), {}, StallAfter(milliseconds(500)));
  EXPECT_EQ(Stream(&backend), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_EQ(faulty_.first_tiles[0], 0);
  EXPECT_EQ(faulty_.first_tiles[1], 2);
}

TEST_F(SilenceTest, ServerThatIsAlwaysSilentIsGivenUp) {
  faulty_.silent_before = 0;
  faulty_.always_silent = true;
  Patience patience = StallAfter(milliseconds(50));
  patience.wait = [](milliseconds, std::stop_token) { return true; };
  RemoteBackend backend(address(), {}, patience);
  const absl::Status status = Stream(&backend);
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("nothing came for"));
}

TEST_F(SilenceTest, SilentPreparationIsDoneAgain) {
  faulty_.silent_prepare_call = 1;
  RemoteBackend backend(address(), {}, StallAfter(milliseconds(500)));
  const auto prepared = backend.PrepareTerrain({}, {}, {});
  ASSERT_TRUE(prepared.ok()) << prepared.status();
  EXPECT_EQ(prepared->recipe_hash(), "sha256:p");
}

TEST_F(SilenceTest, TimeInTheReceiverIsNoSilence) {
  on_tile_ = [](std::int64_t index) {
    if (index == 3) std::this_thread::sleep_for(milliseconds(1500));
  };
  RemoteBackend backend(address(), {}, StallAfter(milliseconds(1000)));
  EXPECT_EQ(Stream(&backend), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_THAT(faulty_.first_tiles, ElementsAre(0));
}

TEST_F(SilenceTest, MachineThatVanishedIsNoticed) {
  faulty_.silent_before = 2;
  Relay relay(port_);
  on_tile_ = [&](std::int64_t index) {
    if (index == 1) relay.FallSilent();
  };
  Patience patience = StallAfter(milliseconds(0));  // no help from there
  patience.ping_after = milliseconds(1000);
  RemoteBackend backend(relay.address(), {}, patience);
  EXPECT_EQ(Stream(&backend), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_THAT(faulty_.first_tiles, ElementsAre(0, 2));
}

TEST_F(SilenceTest, ConnectionMayTakeItsTimeToBegin) {
  Relay relay(port_, milliseconds(2000));
  RemoteBackend backend(relay.address());
  EXPECT_EQ(Stream(&backend), absl::OkStatus());
}

}  // namespace
}  // namespace terrane::client
