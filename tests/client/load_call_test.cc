// Calls of a load test over gRPC, against a server that damages its answers.
#include "client/bench/load_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "client/backend.h"
#include "client/remote_backend.h"
#include "tests/client/damaging_server.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;

class LoadCallTest : public testing::Test {
 protected:
  LoadCallTest() {
    WorkloadOptions options;
    options.tile_size = 1;
    options.tiles = 2;
    RemoteBackend backend(server_.address());
    workload_.emplace(
        Workload::Create(options, MixWeights{1}, &backend, {}).value());
  }

  CallResult Call(CallMaker* calls, const PlannedRequest& plan,
                  std::chrono::milliseconds deadline) {
    std::promise<CallResult> result;
    const std::unique_ptr<LoadCall> call =
        calls->Make(plan, LoadClock::now() + deadline,
                    [&](CallResult came) { result.set_value(came); });
    call->Start();
    return result.get_future().get();
  }
  std::unique_ptr<CallMaker> MakeCalls(int connections, int clients) {
    return MakeGrpcCalls(server_.address(), {}, connections, clients,
                         &*workload_)
        .value();
  }
  CallResult CallOnce(
      std::chrono::milliseconds deadline = std::chrono::seconds(20)) {
    return Call(MakeCalls(1, 1).get(), {}, deadline);
  }

  DamagingServer server_;
  std::optional<Workload> workload_;
};

TEST_F(LoadCallTest, WholeAnswerIsCounted) {
  const auto start = LoadClock::now();
  const CallResult result = CallOnce();
  EXPECT_EQ(result.code, grpc::StatusCode::OK) << result.message;
  EXPECT_EQ(result.tiles, 2);
  EXPECT_EQ(result.samples, 2);
  EXPECT_EQ(result.bytes, 8);
  ASSERT_TRUE(result.first_data.has_value());
  EXPECT_LE(start, *result.first_data);
  EXPECT_LE(*result.first_data, result.end);
  EXPECT_TRUE(server_.clients().empty());
}

TEST_F(LoadCallTest, DamagedTileIsDataLoss) {
  server_.fault = Fault::kDamagedTile;
  const CallResult result = CallOnce();
  EXPECT_EQ(result.code, grpc::StatusCode::DATA_LOSS);
  EXPECT_THAT(result.message, HasSubstr("checksum"));
  EXPECT_EQ(result.tiles, 0);
}

TEST_F(LoadCallTest, StreamThatEndsTooEarlyIsDataLoss) {
  server_.fault = Fault::kMissingTile;
  const CallResult result = CallOnce();
  EXPECT_EQ(result.code, grpc::StatusCode::DATA_LOSS);
  EXPECT_THAT(result.message, HasSubstr("1 of 2 tiles"));
}

TEST_F(LoadCallTest, RefusalKeepsItsCode) {
  server_.fault = Fault::kRefusal;
  const CallResult result = CallOnce();
  EXPECT_EQ(result.code, grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(result.message, "too much");
  EXPECT_FALSE(result.first_data.has_value());
}

TEST_F(LoadCallTest, DeadlineEndsACallThatHangs) {
  server_.fault = Fault::kHang;
  EXPECT_EQ(CallOnce(std::chrono::milliseconds(200)).code,
            grpc::StatusCode::DEADLINE_EXCEEDED);
}

TEST_F(LoadCallTest, ConnectionsAndClientsAreTheirOwn) {
  const std::unique_ptr<CallMaker> calls = MakeCalls(3, 2);
  for (int i = 0; i < 6; ++i) {
    const CallResult result = Call(calls.get(), {.number = i, .client = i % 2},
                                   std::chrono::seconds(20));
    EXPECT_EQ(result.code, grpc::StatusCode::OK) << result.message;
  }
  EXPECT_EQ(server_.peers().size(), 3U);
  EXPECT_THAT(server_.clients(),
              testing::ElementsAre("198.18.0.1", "198.18.0.2"));
}

}  // namespace
}  // namespace terrane::client
