// Calls of a load test over gRPC, against a server that damages its answers.
#include "client/bench/load_call.h"

#include <gmock/gmock.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <future>
#include <mutex>
#include <set>
#include <thread>

#include "client/backend.h"
#include "client/remote_backend.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;

enum class Fault { kNone, kDamagedTile, kMissingTile, kRefusal, kHang };

class FaultyServer : public v1::TerrainService::Service {
 public:
  FaultyServer() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(),
                             &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }
  ~FaultyServer() override { server_->Shutdown(); }

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

  grpc::Status GetPreset(grpc::ServerContext*, const v1::GetPresetRequest*,
                         v1::GetPresetResponse* response) override {
    response->mutable_preset()->mutable_recipe()->set_dimensions(2);
    return grpc::Status::OK;
  }

  // Two tiles of one sample.
  grpc::Status StreamTiles(
      grpc::ServerContext* context, const v1::StreamTilesRequest* request,
      grpc::ServerWriter<v1::StreamTilesResponse>* writer) override {
    {
      const std::lock_guard lock(mutex_);
      peers_.insert(context->peer());
      const auto header = context->client_metadata().find("x-forwarded-for");
      if (header != context->client_metadata().end()) {
        clients_.insert({header->second.data(), header->second.size()});
      }
    }
    if (fault == Fault::kRefusal) {
      return {grpc::StatusCode::RESOURCE_EXHAUSTED, "too much"};
    }
    v1::StreamTilesResponse message;
    message.mutable_header()->set_tile_size(1);
    message.mutable_header()->set_tile_columns(2);
    message.mutable_header()->set_tile_rows(1);
    *message.mutable_header()->mutable_window() = request->window();
    writer->Write(message);
    for (int i = 0; i < (fault == Fault::kMissingTile ? 1 : 2); ++i) {
      v1::HeightTile* tile = message.mutable_tile();
      tile->set_index(i);
      tile->set_total(2);
      *tile->mutable_window() = request->window();
      tile->mutable_window()->set_x(request->window().x() + i);
      tile->mutable_window()->set_width(1);
      tile->set_data("1234");
      tile->set_checksum(XXH3_64bits("1234", 4) +
                         (fault == Fault::kDamagedTile ? 1 : 0));
      writer->Write(message);
    }
    while (fault == Fault::kHang && !context->IsCancelled()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return grpc::Status::OK;
  }

  std::set<std::string> peers() const {
    const std::lock_guard lock(mutex_);
    return peers_;
  }
  std::set<std::string> clients() const {
    const std::lock_guard lock(mutex_);
    return clients_;
  }

  std::atomic<Fault> fault = Fault::kNone;

 private:
  mutable std::mutex mutex_;
  std::set<std::string> peers_;
  std::set<std::string> clients_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

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

  FaultyServer server_;
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
