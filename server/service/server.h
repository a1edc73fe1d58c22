// Server: the services of an Actor on a gRPC port, with health, probes, metrics
// and an ordered end.
//
// Threads: Start, Drain and the destructor from one thread; calls are served on
// gRPC's threads and generated on the worker pool's.
#ifndef TERRANE_SERVER_SERVICE_SERVER_H_
#define TERRANE_SERVER_SERVICE_SERVER_H_

#include <grpcpp/channel.h>
#include <grpcpp/server.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "server/actor/actor.h"
#include "server/service/acceptor.h"
#include "server/service/access.h"
#include "server/service/call_book.h"
#include "server/service/call_context.h"
#include "server/service/connection_limits.h"
#include "server/service/flower_service.h"
#include "server/service/http_endpoint.h"
#include "server/service/info_service.h"
#include "server/service/linger.h"
#include "server/service/memory_watch.h"
#include "server/service/metrics.h"
#include "server/service/raster_service.h"
#include "server/service/render_service.h"
#include "server/service/spot_table_service.h"
#include "server/service/surface_service.h"
#include "server/service/terrain_service.h"
#include "server/service/tls.h"
#include "server/service/tree_service.h"

namespace terrane::server {

struct ServerOptions {
  std::string listen = "127.0.0.1:50051";  // port 0 takes a free one
  Limits limits;
  int workers = 1;
  // A call without a deadline is refused when it would not begin in this time.
  std::chrono::seconds patience{60};
  // A stream whose reader takes nothing for this time is ended.
  std::chrono::milliseconds stream_idle{60'000};
  // A call that gRPC has not ended so long after its deadline is ended by the
  // server's own clock.
  std::chrono::milliseconds deadline_grace{1000};
  bool reflection = false;
  ConnectionLimits connections;
  TlsFiles tls;
  AccessOptions access;
  // Where probes and metrics are answered over plain HTTP; empty: nowhere.
  std::string http_listen;
  // Most memory the process is to take; without it, memory refuses nothing.
  std::optional<std::int64_t> memory_limit_bytes;
};

class Server {
 public:
  // Serves `actor` and writes a line per call to `log`; both outlive the
  // server. Errors: UNAVAILABLE when an address cannot be listened on,
  // INVALID_ARGUMENT for an option that cannot be followed.
  static absl::StatusOr<std::unique_ptr<Server>> Start(
      const ServerOptions& options, Actor* actor, CallLog* log);
  // Cancels what is still running.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // The port that was taken.
  int port() const { return acceptor_->port(); }
  const Acceptor& acceptor() const { return *acceptor_; }
  // The port of http_listen; nothing when it was empty.
  std::optional<int> http_port() const;

  // The ordered end: health says NOT_SERVING and /readyz 503, `grace` lets
  // balancers see it, then no new connection or call is taken and the running
  // calls have `drain` to end, and their readers to take what was sent, before
  // they are cancelled. The server is over then: once.
  void Drain(std::chrono::milliseconds grace, std::chrono::milliseconds drain);

 private:
  Server(const ServerOptions& options, Access access, Actor* actor,
         CallLog* log);

  absl::Status Build(const ServerOptions& options);
  ServerGauges Gauges();
  // /livez, /readyz and /metrics.
  HttpPages Pages();
  void SetServing(bool serving);

  const Access access_;
  // Before what its pointers name: tasks that a pool still runs as it goes use
  // them.
  ServiceParts parts_;
  MemoryWatch memory_;
  StreamGate gate_;
  WorkerPool workers_;
  Admission admission_;
  CallWatch watch_;
  Linger linger_;
  Metrics metrics_;
  CallBook calls_;
  TerrainServiceImpl terrain_service_;
  SurfaceServiceImpl surface_service_;
  TreeServiceImpl tree_service_;
  FlowerServiceImpl flower_service_;
  RenderServiceImpl render_service_;
  RasterServiceImpl raster_service_;
  SpotTableServiceImpl spot_table_service_;
  InfoServiceImpl info_service_;
  std::atomic<bool> ready_ = false;
  bool drained_ = false;
  // Last, so that they go first: no call outlives what it works with.
  std::unique_ptr<grpc::Server> server_;
  // Hands connections to the server.
  std::unique_ptr<Acceptor> acceptor_;
  std::unique_ptr<HttpEndpoint> http_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_SERVER_H_
