#include "server/service/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <thread>

namespace terrane::server {
namespace {

constexpr int kMaxMetadataBytes = 8 * 1024;
// Streams that may stand in line for each one that runs.
constexpr std::size_t kWaitingPerActive = 4;
// Buffers of tiles kept for the next ones.
constexpr std::size_t kBufferPoolBytes = std::size_t{64} << 20;

constexpr const char* kServices[] = {v1::TerrainService::service_full_name(),
                                     v1::SurfaceService::service_full_name(),
                                     v1::TreeService::service_full_name(),
                                     v1::FlowerService::service_full_name(),
                                     v1::RenderService::service_full_name(),
                                     v1::RasterService::service_full_name(),
                                     v1::SpotTableService::service_full_name(),
                                     v1::InfoService::service_full_name()};

}  // namespace

Server::Server(const ServerOptions& options, Actor* actor, CallLog* log)
    : memory_(options.memory_limit_bytes),
      gate_(static_cast<std::size_t>(options.limits.max_concurrent_streams),
            kWaitingPerActive * static_cast<std::size_t>(
                                    options.limits.max_concurrent_streams)),
      workers_(options.workers),
      metrics_(kServices, Gauges()),
      calls_(log, &metrics_),
      parts_{
          .actor = actor,
          .workers = &workers_,
          .gate = &gate_,
          .memory = &memory_,
          .calls = &calls_,
          .buffers = std::make_shared<BufferPool>(kBufferPoolBytes),
      },
      terrain_service_(parts_),
      surface_service_(parts_),
      tree_service_(parts_),
      flower_service_(parts_),
      render_service_(parts_),
      raster_service_(parts_),
      spot_table_service_(parts_),
      info_service_(parts_) {}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(
    const ServerOptions& options, Actor* actor, CallLog* log) {
  std::unique_ptr<Server> server(new Server(options, actor, log));
  grpc::EnableDefaultHealthCheckService(true);
  if (options.reflection) {
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  }
  grpc::ServerBuilder builder;
  builder.AddListeningPort(options.listen, grpc::InsecureServerCredentials(),
                           &server->port_);
  builder.RegisterService(&server->terrain_service_);
  builder.RegisterService(&server->surface_service_);
  builder.RegisterService(&server->tree_service_);
  builder.RegisterService(&server->flower_service_);
  builder.RegisterService(&server->render_service_);
  builder.RegisterService(&server->raster_service_);
  builder.RegisterService(&server->spot_table_service_);
  builder.RegisterService(&server->info_service_);
  builder.SetMaxReceiveMessageSize(
      static_cast<int>(options.limits.max_request_bytes));
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
  // Two servers on one port would share its calls at random.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  // gRPC inflates a request before it looks at the size: a small one could fill
  // the memory. So requests come as they are (UNIMPLEMENTED otherwise).
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  server->server_ = builder.BuildAndStart();
  if (server->server_ == nullptr || server->port_ == 0) {
    return absl::UnavailableError("cannot listen on " + options.listen);
  }
  server->SetServing(true);
  if (!options.http_listen.empty()) {
    auto http = HttpEndpoint::Start(options.http_listen, server->Pages());
    if (!http.ok()) return http.status();
    server->http_ = *std::move(http);
  }
  return server;
}

ServerGauges Server::Gauges() {
  ServerGauges gauges;
  gauges.workers = [this] { return workers_.load().workers; };
  gauges.workers_busy = [this] { return workers_.load().busy; };
  gauges.memory_bytes = [this] {
    return static_cast<double>(memory_.ResidentBytes());
  };
  if (const auto limit = memory_.limit_bytes()) {
    gauges.memory_limit_bytes = [limit] { return static_cast<double>(*limit); };
  }
  return gauges;
}

HttpPages Server::Pages() {
  return {{"/livez", [] { return HttpReply{.body = "ok\n"}; }},
          {"/readyz",
           [this] {
             return ready_ ? HttpReply{.body = "ok\n"}
                           : HttpReply{.status = 503, .body = "draining\n"};
           }},
          {"/metrics", [this] {
             return HttpReply{.content_type = kMetricsContentType,
                              .body = metrics_.Text()};
           }}};
}

std::optional<int> Server::http_port() const {
  if (http_ == nullptr) return std::nullopt;
  return http_->port();
}

Server::~Server() {
  if (server_ != nullptr) Drain({}, {});
}

void Server::SetServing(bool serving) {
  grpc::HealthCheckServiceInterface* health = server_->GetHealthCheckService();
  health->SetServingStatus("", serving);
  for (const char* name : kServices) health->SetServingStatus(name, serving);
  ready_ = serving;
}

void Server::Drain(std::chrono::milliseconds grace,
                   std::chrono::milliseconds drain) {
  SetServing(false);
  std::this_thread::sleep_for(grace);
  server_->Shutdown(std::chrono::system_clock::now() + drain);
  server_->Wait();
}

}  // namespace terrane::server
