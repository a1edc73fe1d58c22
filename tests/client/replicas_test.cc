// RemoteBackend against two replicas, by list and by name, one of which may go
// away.
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "client/remote_backend.h"
#include "tests/client/faulty_server.h"

// The resolver of names, c-ares, which gRPC has for dns:///, keeps some bytes
// until the process ends.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libcares\n";
}

namespace terrane::client {
namespace {

constexpr char kRasterId[] = "sha256:r";

// One replica: the same tiles as the other one, one sample each. Once told to
// hold, it keeps a stream after its second tile until it is stopped.
class Replica : public v1::TerrainService::Service,
                public v1::RasterService::Service {
 public:
  Replica() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(),
                             &port_);
    builder.RegisterService(static_cast<v1::TerrainService::Service*>(this));
    builder.RegisterService(static_cast<v1::RasterService::Service*>(this));
    server_ = builder.BuildAndStart();
  }
  ~Replica() override { Stop(); }

  int port() const { return port_; }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  // As a killed process: the streams are cut.
  void Stop() {
    server_->Shutdown(std::chrono::system_clock::now());
    server_->Wait();
  }

  grpc::Status StreamTiles(
      grpc::ServerContext* context, const v1::StreamTilesRequest* request,
      grpc::ServerWriter<v1::StreamTilesResponse>* writer) override {
    if (needs_raster && uploads == 0) {
      return NotKept("RASTER_NOT_FOUND", "raster_id", kRasterId);
    }
    ++streams;
    v1::StreamTilesResponse message = Header();
    writer->Write(message);
    for (std::int64_t i = request->first_tile(); i < kTiles; ++i) {
      if (holds && i == 2) {
        while (!context->IsCancelled()) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return {grpc::StatusCode::UNAVAILABLE, "stopped"};
      }
      *message.mutable_tile() = Tile(i);
      writer->Write(message);
    }
    return grpc::Status::OK;
  }

  grpc::Status UploadRaster(grpc::ServerContext*,
                            grpc::ServerReader<v1::UploadRasterRequest>* reader,
                            v1::UploadRasterResponse* response) override {
    v1::UploadRasterRequest part;
    while (reader->Read(&part)) {
    }
    ++uploads;
    response->set_raster_id(kRasterId);
    return grpc::Status::OK;
  }

  std::atomic<bool> holds = false;
  std::atomic<bool> needs_raster = false;
  std::atomic<int> streams = 0;
  std::atomic<int> uploads = 0;

 private:
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

class ReplicasTest : public testing::Test {
 protected:
  // Streams all tiles; `on_tile` sees each.
  std::string Stream(const std::function<void(std::int64_t)>& on_tile) {
    return Stream(&backend_, on_tile);
  }
  static std::string Stream(RemoteBackend* backend,
                            const std::function<void(std::int64_t)>& on_tile) {
    std::string received;
    const absl::Status status = backend->StreamTiles(
        v1::StreamTilesRequest(),
        [](const v1::StreamHeader&) { return absl::OkStatus(); },
        [&](const v1::HeightTile& tile) {
          received += tile.data()[0];
          on_tile(tile.index());
          return absl::OkStatus();
        },
        {});
    EXPECT_EQ(status, absl::OkStatus());
    return received;
  }

  Replica first_;
  Replica second_;
  RemoteBackend backend_{first_.address() + "," + second_.address()};
};

TEST_F(ReplicasTest, CallsGoRoundRobin) {
  // Until both connections stand, calls go to the first that does.
  const auto give_up =
      std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while ((first_.streams == 0 || second_.streams == 0) &&
         std::chrono::steady_clock::now() < give_up) {
    EXPECT_EQ(Stream([](std::int64_t) {}), "012345");
  }
  const int first = first_.streams;
  const int second = second_.streams;
  for (int i = 0; i < 10; ++i) Stream([](std::int64_t) {});
  EXPECT_EQ(first_.streams - first, 5);
  EXPECT_EQ(second_.streams - second, 5);
}

TEST_F(ReplicasTest, StreamOfAStoppedReplicaGoesOnAtTheOther) {
  first_.holds = true;
  second_.holds = true;
  std::jthread stopper;
  const std::string received = Stream([&](std::int64_t index) {
    if (index != 1 || stopper.joinable()) return;
    // Both would hold: the one that serves the stream stops, the other is free.
    Replica* serving = first_.streams > 0 ? &first_ : &second_;
    Replica* other = serving == &first_ ? &second_ : &first_;
    other->holds = false;
    stopper = std::jthread([serving] { serving->Stop(); });
  });
  EXPECT_EQ(received, "012345");
  EXPECT_EQ(first_.streams + second_.streams, 2);
  EXPECT_EQ(first_.streams, 1);
}

TEST_F(ReplicasTest, NameIsDialled) {
  RemoteBackend backend("dns:///localhost:" + std::to_string(first_.port()));
  EXPECT_EQ(Stream(&backend, [](std::int64_t) {}), "012345");
  EXPECT_EQ(first_.streams, 1);
}

// Uploads go round robin too, as if to spite the stream that follows.
TEST_F(ReplicasTest, RasterIsBroughtWhileBothReplicasServe) {
  first_.needs_raster = true;
  second_.needs_raster = true;
  const auto raster = std::make_shared<const core::Raster>(
      core::Raster{2, 2, {}, std::vector<float>(4, 1.0F)});
  ASSERT_TRUE(backend_.UploadRaster(raster, {}).ok());
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(Stream([](std::int64_t) {}), "012345");
    // Both have lost it.
    first_.uploads = 0;
    second_.uploads = 0;
  }
}

TEST_F(ReplicasTest, RasterIsBroughtToTheReplicaThatLacksIt) {
  first_.needs_raster = true;
  second_.needs_raster = true;
  const auto raster = std::make_shared<const core::Raster>(
      core::Raster{2, 2, {}, std::vector<float>(4, 1.0F)});
  ASSERT_TRUE(backend_.UploadRaster(raster, {}).ok());
  EXPECT_EQ(first_.uploads + second_.uploads, 1);
  Replica* keeps = first_.uploads > 0 ? &first_ : &second_;
  keeps->Stop();
  EXPECT_EQ(Stream([](std::int64_t) {}), "012345");
  EXPECT_EQ(first_.uploads, 1);
  EXPECT_EQ(second_.uploads, 1);
}

}  // namespace
}  // namespace terrane::client
