// Served bytes per second, and what a server reaches that sends the same
// messages from a ready buffer: both over loopback, in turn, in one run.
//
//   terrane_served_bench [--tiles N] [--rounds N] [--workers N]
//
// The ratio says what generating costs a client; the wire is the wall when it
// is near 1. Directly, and through one HAProxy where it is installed. Prints a
// table; every figure is the median of the rounds.
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <spdlog/sinks/null_sink.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "server/service/server.h"
#include "terrane/v1/terrain.grpc.pb.h"
#include "tests/bench/local_haproxy.h"

namespace terrane::server {
namespace {

using Clock = std::chrono::steady_clock;
using RawTerrainService = v1::TerrainService::WithRawCallbackMethod_StreamTiles<
    v1::TerrainService::Service>;

grpc::ByteBuffer Serialized(const v1::StreamTilesResponse& message) {
  const grpc::Slice slice(message.SerializeAsString());
  return grpc::ByteBuffer(&slice, 1);
}

// Sends one header and the same tile again and again, without any work.
class ReadyService final : public RawTerrainService {
 public:
  ReadyService(const v1::StreamTilesResponse& header,
               const v1::StreamTilesResponse& tile, int tiles)
      : header_(Serialized(header)), tile_(Serialized(tile)), tiles_(tiles) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamTiles(
      grpc::CallbackServerContext*, const grpc::ByteBuffer*) override {
    return new Stream(*this);
  }

 private:
  class Stream final : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
   public:
    explicit Stream(const ReadyService& service) : service_(service) {
      outgoing_ = service_.header_;
      StartWrite(&outgoing_);
    }
    void OnWriteDone(bool ok) override {
      if (!ok || sent_ == service_.tiles_) {
        Finish(grpc::Status::OK);
        return;
      }
      ++sent_;
      outgoing_ = service_.tile_;
      StartWrite(&outgoing_);
    }
    void OnDone() override { delete this; }

   private:
    const ReadyService& service_;
    grpc::ByteBuffer outgoing_;
    int sent_ = 0;
  };

  const grpc::ByteBuffer header_, tile_;
  const int tiles_;
};

std::unique_ptr<v1::TerrainService::Stub> Connect(int port) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return v1::TerrainService::NewStub(
      grpc::CreateCustomChannel("127.0.0.1:" + std::to_string(port),
                                grpc::InsecureChannelCredentials(), arguments));
}

v1::StreamTilesRequest Request(v1::FractalSource source, int tiles) {
  v1::StreamTilesRequest request;
  request.mutable_terrain()->mutable_recipe()->set_source(source);
  request.set_level(20);
  request.mutable_tiles()->set_columns(tiles);
  request.mutable_tiles()->set_rows(1);
  request.set_tile_size(256);
  return request;
}

// Reads a whole stream; bytes of heights a second.
double BytesPerSecond(v1::TerrainService::Stub* stub,
                      const v1::StreamTilesRequest& request) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(60));
  const Clock::time_point start = Clock::now();
  const auto reader = stub->StreamTiles(&context, request);
  v1::StreamTilesResponse message;
  double bytes = 0;
  while (reader->Read(&message)) {
    bytes += static_cast<double>(message.tile().data().size());
  }
  const grpc::Status status = reader->Finish();
  if (!status.ok()) {
    std::fprintf(stderr, "stream failed: %s\n", status.error_message().c_str());
    std::exit(1);
  }
  return bytes / std::chrono::duration<double>(Clock::now() - start).count();
}

// `connections` streams at the same time, each on a connection of its own.
double Total(int port, int connections, const v1::StreamTilesRequest& request) {
  std::vector<double> rates(static_cast<std::size_t>(connections));
  std::vector<std::jthread> threads;
  for (double& rate : rates) {
    threads.emplace_back([port, &request, &rate] {
      rate = BytesPerSecond(Connect(port).get(), request);
    });
  }
  threads.clear();
  double total = 0;
  for (const double rate : rates) total += rate;
  return total;
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::pair<v1::StreamTilesResponse, v1::StreamTilesResponse> FirstMessages(
    int port) {
  grpc::ClientContext context;
  const auto stub = Connect(port);
  const auto reader =
      stub->StreamTiles(&context, Request(v1::FRACTAL_SOURCE_SUBDIVISION, 1));
  std::pair<v1::StreamTilesResponse, v1::StreamTilesResponse> messages;
  reader->Read(&messages.first);
  reader->Read(&messages.second);
  reader->Finish();
  return messages;
}

// Where clients find both servers: themselves, or doors of a proxy.
struct Path {
  const char* name;
  int ready_port;
  int generated_port;
};

struct Choice {
  int tiles;
  int rounds;
};

void PrintRows(const Path& path, const Choice& choice) {
  const std::pair<const char*, v1::FractalSource> sources[] = {
      {"MIDPOINT", v1::FRACTAL_SOURCE_MIDPOINT},
      {"SUBDIVISION", v1::FRACTAL_SOURCE_SUBDIVISION}};
  for (const auto& [name, source] : sources) {
    const v1::StreamTilesRequest request = Request(source, choice.tiles);
    for (const int connections : {1, 2, 4}) {
      std::vector<double> generated;
      std::vector<double> from_buffer;
      for (int round = 0; round < choice.rounds; ++round) {
        from_buffer.push_back(Total(path.ready_port, connections, request));
        generated.push_back(Total(path.generated_port, connections, request));
      }
      std::printf("%-8s %-12s %12d %12.0f %14.0f %10.2f\n", path.name, name,
                  connections, Median(from_buffer) / 1e6,
                  Median(generated) / 1e6,
                  Median(generated) / Median(from_buffer));
      std::fflush(stdout);
    }
  }
}

int Run(const Choice& choice, int workers) {
  const std::unique_ptr<Actor> actor = MakeActor(Limits(), workers);
  CallLog log(std::make_shared<spdlog::logger>(
                  "bench", std::make_shared<spdlog::sinks::null_sink_mt>()),
              LogFormat::kText);
  ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.workers = workers;
  const auto server = Server::Start(options, actor.get(), &log);
  if (!server.ok()) {
    std::fprintf(stderr, "%s\n", server.status().ToString().c_str());
    return 1;
  }
  const auto [header, tile] = FirstMessages((*server)->port());
  ReadyService ready(header, tile, choice.tiles);
  int ready_port = 0;
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(),
                           &ready_port);
  builder.RegisterService(&ready);
  const std::unique_ptr<grpc::Server> ready_server = builder.BuildAndStart();

  std::printf("%d tiles of 256 x 256 float32 a stream, %d workers\n",
              choice.tiles, workers);
  std::printf("%-8s %-12s %12s %12s %14s %10s\n", "path", "source",
              "connections", "ready MB/s", "generated MB/s", "ratio");
  PrintRows({"direct", ready_port, (*server)->port()}, choice);
  const auto proxy = LocalHaproxy::Start({ready_port, (*server)->port()});
  if (!proxy.ok()) {
    std::fprintf(stderr, "without HAProxy: %s\n",
                 std::string(proxy.status().message()).c_str());
    return 0;
  }
  const std::vector<int>& doors = (*proxy)->doors();
  PrintRows({"HAProxy", doors[0], doors[1]}, choice);
  return 0;
}

}  // namespace
}  // namespace terrane::server

int main(int argc, char** argv) {
  CLI::App app("Served bytes per second against a ready buffer, over loopback");
  terrane::server::Choice choice{.tiles = 2000, .rounds = 5};
  int workers = static_cast<int>(std::thread::hardware_concurrency());
  app.add_option("--tiles", choice.tiles, "Tiles of a stream")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--rounds", choice.rounds, "Rounds; the median counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--workers", workers, "Worker threads of the server")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return terrane::server::Run(choice, workers);
}
