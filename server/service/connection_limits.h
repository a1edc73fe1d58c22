// What one connection may do, as arguments of gRPC's transport.
#ifndef TERRANE_SERVER_SERVICE_CONNECTION_LIMITS_H_
#define TERRANE_SERVER_SERVICE_CONNECTION_LIMITS_H_

#include <grpcpp/server_builder.h>

#include <chrono>

namespace terrane::server {

struct ConnectionLimits {
  int max_connections = 1024;
  // From then on a connection takes no new call (gRPC spreads it by a tenth);
  // its calls have `age_grace` to end.
  std::chrono::seconds max_age{3600};
  std::chrono::seconds age_grace{600};
  // Without a call.
  std::chrono::seconds max_idle{300};
  // For TLS and for the first HTTP/2 frames.
  std::chrono::milliseconds handshake{10'000};
  // Calls at a time; a client's library queues what is more.
  int max_calls = 256;
};

// All but `max_connections`, which is the Acceptor's.
void LimitConnections(const ConnectionLimits& limits,
                      grpc::ServerBuilder* builder);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CONNECTION_LIMITS_H_
