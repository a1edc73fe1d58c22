#include "server/service/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <thread>
#include <utility>

#include "server/service/descriptor_limit.h"

namespace terrane::server {
namespace {

// Streams that may stand in line for each one that runs.
constexpr std::size_t kWaitingPerActive = 4;
// Buffers of tiles kept for the next ones, and their part of a memory limit.
constexpr std::int64_t kBufferPoolBytes = std::int64_t{64} << 20;
constexpr std::int64_t kBufferPoolPart = 16;

constexpr const char* kServices[] = {v1::TerrainService::service_full_name(),
                                     v1::SurfaceService::service_full_name(),
                                     v1::TreeService::service_full_name(),
                                     v1::FlowerService::service_full_name(),
                                     v1::RenderService::service_full_name(),
                                     v1::RasterService::service_full_name(),
                                     v1::SpotTableService::service_full_name(),
                                     v1::InfoService::service_full_name()};

std::size_t BufferPoolBytes(std::optional<std::int64_t> memory_limit_bytes) {
  const std::int64_t part =
      memory_limit_bytes.value_or(kBufferPoolBytes * kBufferPoolPart) /
      kBufferPoolPart;
  return static_cast<std::size_t>(std::min(kBufferPoolBytes, part));
}

}  // namespace

Server::Server(const ServerOptions& options, Access access, Actor* actor,
               CallLog* log)
    : access_(std::move(access)),
      parts_{
          .actor = actor,
          .workers = &workers_,
          .admission = &admission_,
          .gate = &gate_,
          .watch = &watch_,
          .memory = &memory_,
          .calls = &calls_,
          .buffers = std::make_shared<BufferPool>(
              BufferPoolBytes(options.memory_limit_bytes)),
          .access = &access_,
          .linger = &linger_,
      },
      memory_(options.memory_limit_bytes),
      gate_(static_cast<std::size_t>(options.limits.max_concurrent_streams),
            kWaitingPerActive * static_cast<std::size_t>(
                                    options.limits.max_concurrent_streams)),
      workers_(options.workers),
      admission_(&workers_, options.patience),
      watch_(options.deadline_grace, options.stream_idle),
      metrics_(kServices, Gauges()),
      calls_(log, &metrics_, &access_),
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
  auto access = Access::Create(options.access);
  if (!access.ok()) return access.status();
  std::unique_ptr<Server> server(
      new Server(options, *std::move(access), actor, log));
  const int wanted = options.connections.max_connections;
  // Later than the watch, which knows why, and whose cancelling waits for it.
  const std::chrono::milliseconds connection_idle = options.stream_idle * 3 / 2;
  auto acceptor =
      Acceptor::Listen(options.listen, FitConnections(wanted), connection_idle);
  if (!acceptor.ok()) return acceptor.status();
  server->acceptor_ = *std::move(acceptor);
  const int most = server->acceptor_->max_connections();
  if (most < wanted) {
    log->Event("connections limited",
               "to " + std::to_string(most) + " instead of " +
                   std::to_string(wanted) + ", by the limit of descriptors");
  }
  const absl::Status built = server->Build(options);
  if (!built.ok()) return built;
  server->SetServing(true);
  if (!options.http_listen.empty()) {
    auto http = HttpEndpoint::Start(options.http_listen, server->Pages());
    if (!http.ok()) return http.status();
    server->http_ = *std::move(http);
  }
  return server;
}

absl::Status Server::Build(const ServerOptions& options) {
  auto credentials = MakeServerCredentials(options.tls);
  if (!credentials.ok()) return credentials.status();
  grpc::EnableDefaultHealthCheckService(true);
  if (options.reflection) {
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  }
  grpc::ServerBuilder builder;
  const std::shared_ptr<grpc::experimental::ExternalConnectionAcceptor>
      grpc_in = builder.experimental().AddExternalConnectionAcceptor(
          grpc::ServerBuilder::experimental_type::ExternalConnectionType::
              FROM_FD,
          *credentials);
  builder.RegisterService(&terrain_service_);
  builder.RegisterService(&surface_service_);
  builder.RegisterService(&tree_service_);
  builder.RegisterService(&flower_service_);
  builder.RegisterService(&render_service_);
  builder.RegisterService(&raster_service_);
  builder.RegisterService(&spot_table_service_);
  builder.RegisterService(&info_service_);
  builder.SetMaxReceiveMessageSize(
      static_cast<int>(options.limits.max_request_bytes));
  LimitConnections(options.connections, &builder);
  // gRPC inflates a request before it looks at the size: a small one could fill
  // the memory. So requests come as they are (UNIMPLEMENTED otherwise).
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) {
    return absl::InternalError("gRPC's server does not start");
  }
  acceptor_->Start(
      [grpc_in](int fd) {
        grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters
            connection;
        connection.fd = fd;
        grpc_in->HandleNewConnection(&connection);
      },
      [this] { metrics_.CountRefusal(Refusal::kConnections); });
  return absl::OkStatus();
}

ServerGauges Server::Gauges() {
  ServerGauges gauges;
  gauges.workers = [this] { return workers_.load().workers; };
  gauges.workers_busy = [this] { return workers_.load().busy; };
  gauges.backlog_seconds[CallClass::kInteractive] = [this] {
    return workers_.load().interactive_seconds;
  };
  gauges.backlog_seconds[CallClass::kBatch] = [this] {
    return workers_.load().batch_seconds;
  };
  gauges.connections = [this] { return acceptor_->connections(); };
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
  if (server_ != nullptr && !drained_) Drain({}, {});
}

void Server::SetServing(bool serving) {
  grpc::HealthCheckServiceInterface* health = server_->GetHealthCheckService();
  health->SetServingStatus("", serving);
  for (const char* name : kServices) health->SetServingStatus(name, serving);
  ready_ = serving;
}

void Server::Drain(std::chrono::milliseconds grace,
                   std::chrono::milliseconds drain) {
  drained_ = true;
  SetServing(false);
  std::this_thread::sleep_for(grace);
  acceptor_->Stop();
  linger_.Begin([this](int port) { return acceptor_->SocketsFrom(port); },
                Linger::Clock::now() + drain);
  server_->Shutdown(std::chrono::system_clock::now() + drain);
  server_->Wait();
}

}  // namespace terrane::server
