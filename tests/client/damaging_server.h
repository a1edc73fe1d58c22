// A server of two tiles that damages or refuses its answers as a test says.
#ifndef TERRANE_TESTS_CLIENT_DAMAGING_SERVER_H_
#define TERRANE_TESTS_CLIENT_DAMAGING_SERVER_H_

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <xxhash.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "terrane/v1/terrain.grpc.pb.h"

namespace terrane::client {

enum class Fault {
  kNone,
  kDamagedTile,
  kMissingTile,
  kRefusal,
  kUnavailable,
  kHang
};

class DamagingServer : public v1::TerrainService::Service {
 public:
  DamagingServer() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(),
                             &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }
  ~DamagingServer() override { server_->Shutdown(); }

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
    if (fault == Fault::kUnavailable) {
      return {grpc::StatusCode::UNAVAILABLE, "not now"};
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

}  // namespace terrane::client

#endif  // TERRANE_TESTS_CLIENT_DAMAGING_SERVER_H_
