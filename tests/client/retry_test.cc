// How often, and after which waits, RemoteBackend tries again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "client/remote_backend.h"
#include "tests/client/faulty_server.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;
using testing::Each;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class RetryTest : public testing::Test {
 protected:
  void SetUp() override {
    server_ = Serve(&faulty_, &port_);
    ASSERT_NE(server_, nullptr);
    backend_ = Backend();
  }
  void TearDown() override {
    if (server_ != nullptr) server_->Shutdown();
  }

  // Waits are noted, and take no time unless `on_wait` takes it.
  std::unique_ptr<RemoteBackend> Backend() {
    Patience patience;
    patience.wait = [this](milliseconds duration, std::stop_token stop) {
      waits_.push_back(duration);
      if (on_wait_) on_wait_(duration);
      return !stop.stop_requested();
    };
    return std::make_unique<RemoteBackend>("127.0.0.1:" + std::to_string(port_),
                                           ChannelSecurity(), patience);
  }

  absl::Status GetPreset() {
    return backend_->GetPreset(v1::GetPresetRequest(), {}).status();
  }
  absl::Status Prepare() {
    return backend_->PrepareTerrain({}, {}, {}).status();
  }
  void Stop() {
    server_->Shutdown(std::chrono::system_clock::now());
    server_->Wait();
    server_.reset();
  }

  FaultyServer faulty_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<RemoteBackend> backend_;
  std::vector<milliseconds> waits_;
  std::function<void(milliseconds)> on_wait_;
};

TEST_F(RetryTest, RefusalsAreOutlastedAsTheServerAsks) {
  faulty_.preset_status = ComeBackAfter(milliseconds(700));
  faulty_.failing_preset_calls = 3;
  EXPECT_EQ(GetPreset(), absl::OkStatus());
  EXPECT_EQ(faulty_.preset_calls, 4);
  EXPECT_THAT(waits_, SizeIs(3));
  EXPECT_THAT(waits_, Each(Ge(milliseconds(700))));
}

TEST_F(RetryTest, SoAreThoseThatOnlyTheMetadataDate) {
  faulty_.preset_status = {grpc::StatusCode::RESOURCE_EXHAUSTED, "busy"};
  faulty_.pushback = "4000";
  faulty_.failing_preset_calls = 3;
  EXPECT_EQ(GetPreset(), absl::OkStatus());
  EXPECT_THAT(waits_, SizeIs(3));
  EXPECT_THAT(waits_, Each(Ge(milliseconds(4000))));
}

TEST_F(RetryTest, RefusalWithoutATimeIsFinal) {
  faulty_.preset_status = {grpc::StatusCode::RESOURCE_EXHAUSTED, "too large"};
  EXPECT_EQ(GetPreset(), absl::ResourceExhaustedError("too large"));
  EXPECT_THAT(waits_, IsEmpty());
}

TEST_F(RetryTest, WhoIsTurnedAwayDoesNotComeBack) {
  faulty_.preset_status = {grpc::StatusCode::UNAVAILABLE, "go away"};
  faulty_.pushback = "-1";
  EXPECT_EQ(GetPreset().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(faulty_.preset_calls, 1);
}

TEST_F(RetryTest, UnaryCallThatTheServerBrokeIsNotTriedAgain) {
  for (const grpc::StatusCode code :
       {grpc::StatusCode::UNKNOWN, grpc::StatusCode::INTERNAL}) {
    faulty_.preset_status = {code, "broken"};
    EXPECT_EQ(GetPreset().message(), "broken");
  }
  EXPECT_EQ(faulty_.preset_calls, 2);
  EXPECT_THAT(waits_, IsEmpty());
}

TEST_F(RetryTest, CallThatTheServerEndedIsNoInterrupt) {
  faulty_.preset_status = {grpc::StatusCode::CANCELLED, "enough"};
  const absl::Status status = GetPreset();
  EXPECT_EQ(status.code(), absl::StatusCode::kAborted);
  EXPECT_THAT(std::string(status.message()), HasSubstr("enough"));
  EXPECT_EQ(faulty_.preset_calls, 1);
}

TEST_F(RetryTest, ClientsDoNotReturnTogether) {
  faulty_.preset_status = ComeBackAfter(milliseconds(100));
  std::set<milliseconds> first_waits;
  for (int client = 0; client < 20; ++client) {
    waits_.clear();
    backend_ = Backend();
    EXPECT_FALSE(GetPreset().ok());
    ASSERT_THAT(waits_, SizeIs(8));
    first_waits.insert(waits_.front());
  }
  // Of a hundred that there are.
  EXPECT_THAT(first_waits, SizeIs(Ge(5U)));
}

TEST_F(RetryTest, ServerThatIsNotThereIsGivenUpSoon) {
  Stop();
  const absl::Status status = GetPreset();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("127.0.0.1:" + std::to_string(port_)));
  EXPECT_THAT(waits_, SizeIs(2));
}

TEST_F(RetryTest, RestartBetweenTwoCallsIsOutlasted) {
  EXPECT_EQ(GetPreset(), absl::OkStatus());
  Stop();
  on_wait_ = [this](milliseconds duration) {
    // Later than a server that has never answered would be given up.
    if (waits_.size() == 4) server_ = Serve(&faulty_, &port_);
    SleepFor(duration, {});
  };
  EXPECT_EQ(GetPreset(), absl::OkStatus());
  EXPECT_THAT(waits_, SizeIs(Ge(4U)));
  EXPECT_EQ(faulty_.preset_calls, 2);
}

TEST_F(RetryTest, RefusalShowsThatAServerIsThere) {
  faulty_.preset_status = ComeBackAfter(milliseconds(0));
  faulty_.failing_preset_calls = 1;
  on_wait_ = [this](milliseconds duration) {
    if (waits_.size() == 1) Stop();
    if (waits_.size() == 4) server_ = Serve(&faulty_, &port_);
    SleepFor(duration, {});
  };
  EXPECT_EQ(GetPreset(), absl::OkStatus());
  EXPECT_THAT(waits_, SizeIs(Ge(4U)));
}

TEST_F(RetryTest, PreparationThatKillsTheServerEachTimeIsGivenUp) {
  faulty_.dies_of_preparing = true;
  EXPECT_EQ(Prepare().code(), absl::StatusCode::kUnavailable);
  // The first try, which got farther than ever, and eight that did not.
  EXPECT_EQ(faulty_.prepare_calls, 9);
}

TEST_F(RetryTest, StreamThatOnlyRepeatsItsHeaderIsGivenUp) {
  faulty_.tiles_before_cut = 0;
  int headers = 0;
  const absl::Status status = backend_->StreamTiles(
      v1::StreamTilesRequest(),
      [&](const v1::StreamHeader&) {
        ++headers;
        return absl::OkStatus();
      },
      [](const v1::HeightTile&) { return absl::OkStatus(); }, {});
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(faulty_.first_tiles, SizeIs(9));
  EXPECT_EQ(headers, 1);
}

}  // namespace
}  // namespace terrane::client
