#include "server/service/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <thread>
#include <utility>

#include "server/service/descriptor_limit.h"

namespace terrane::server {
namespace {

// Streams that may stand in line for each one that runs.
constexpr std::size_t kWaitingPerActive = 4;
// Buffers of tiles kept for the next ones.
constexpr std::size_t kBufferPoolBytes = std::size_t{64} << 20;

}  // namespace

Server::Server(const ServerOptions& options, Access access, Actor* actor,
               CallLog* log)
    : access_(std::move(access)),
      gate_(static_cast<std::size_t>(options.limits.max_concurrent_streams),
            kWaitingPerActive * static_cast<std::size_t>(
                                    options.limits.max_concurrent_streams)),
      workers_(options.workers),
      admission_(&workers_, options.patience),
      stalls_(options.stream_idle),
      parts_{actor,
             &workers_,
             &admission_,
             &gate_,
             &stalls_,
             log,
             std::make_shared<BufferPool>(kBufferPoolBytes),
             &access_},
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
  auto acceptor = Acceptor::Listen(options.listen, FitConnections(wanted));
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
  acceptor_->Start([grpc_in](int fd) {
    grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters
        connection;
    connection.fd = fd;
    grpc_in->HandleNewConnection(&connection);
  });
  return absl::OkStatus();
}

Server::~Server() {
  if (server_ != nullptr) Drain({}, {});
}

void Server::SetServing(bool serving) {
  grpc::HealthCheckServiceInterface* health = server_->GetHealthCheckService();
  for (const char* name : {"", v1::TerrainService::service_full_name(),
                           v1::SurfaceService::service_full_name(),
                           v1::TreeService::service_full_name(),
                           v1::FlowerService::service_full_name(),
                           v1::RenderService::service_full_name(),
                           v1::RasterService::service_full_name(),
                           v1::SpotTableService::service_full_name(),
                           v1::InfoService::service_full_name()}) {
    health->SetServingStatus(name, serving);
  }
}

void Server::Drain(std::chrono::milliseconds grace,
                   std::chrono::milliseconds drain) {
  SetServing(false);
  std::this_thread::sleep_for(grace);
  acceptor_->Stop();
  server_->Shutdown(std::chrono::system_clock::now() + drain);
  server_->Wait();
}

}  // namespace terrane::server
