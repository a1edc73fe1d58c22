// A server on a free loopback port, a client's stubs, and the log it wrote.
#ifndef TERRANE_TESTS_SERVER_SERVED_H_
#define TERRANE_TESTS_SERVER_SERVED_H_

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <memory>
#include <mutex>
#include <sstream>
#include <string>

#include "server/service/server.h"
#include "terrane/v1/flower.grpc.pb.h"
#include "terrane/v1/info.grpc.pb.h"
#include "terrane/v1/raster.grpc.pb.h"
#include "terrane/v1/render.grpc.pb.h"
#include "terrane/v1/spot_table.grpc.pb.h"
#include "terrane/v1/surface.grpc.pb.h"
#include "terrane/v1/terrain.grpc.pb.h"
#include "terrane/v1/tree.grpc.pb.h"

namespace terrane::server {

class Served {
 public:
  explicit Served(Actor* actor, ServerOptions options = {})
      : log_(std::make_shared<spdlog::logger>(
                 "test",
                 std::make_shared<spdlog::sinks::ostream_sink_mt>(lines_)),
             LogFormat::kJson) {
    options.listen = "127.0.0.1:0";
    auto server = Server::Start(options, actor, &log_);
    EXPECT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    channel_ = grpc::CreateCustomChannel(
        "127.0.0.1:" + std::to_string(server_->port()),
        grpc::InsecureChannelCredentials(), ClientArguments());
    terrain = v1::TerrainService::NewStub(channel_);
    surface = v1::SurfaceService::NewStub(channel_);
    tree = v1::TreeService::NewStub(channel_);
    flower = v1::FlowerService::NewStub(channel_);
    render = v1::RenderService::NewStub(channel_);
    raster = v1::RasterService::NewStub(channel_);
    spot_table = v1::SpotTableService::NewStub(channel_);
    info = v1::InfoService::NewStub(channel_);
  }

  Server& server() { return *server_; }
  const std::shared_ptr<grpc::Channel>& channel() { return channel_; }
  // Ends the server; the lines of its log.
  std::string StopAndReadLog() {
    server_.reset();
    return lines_.str();
  }

  std::unique_ptr<v1::TerrainService::Stub> terrain;
  std::unique_ptr<v1::SurfaceService::Stub> surface;
  std::unique_ptr<v1::TreeService::Stub> tree;
  std::unique_ptr<v1::FlowerService::Stub> flower;
  std::unique_ptr<v1::RenderService::Stub> render;
  std::unique_ptr<v1::RasterService::Stub> raster;
  std::unique_ptr<v1::SpotTableService::Stub> spot_table;
  std::unique_ptr<v1::InfoService::Stub> info;

 private:
  static grpc::ChannelArguments ClientArguments() {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(64 << 20);
    // A connection of its own for every test.
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return arguments;
  }

  std::ostringstream lines_;
  CallLog log_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
};

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_SERVED_H_
