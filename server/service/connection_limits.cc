#include "server/service/connection_limits.h"

#include <grpc/impl/codegen/grpc_types.h>

namespace terrane::server {
namespace {

using std::chrono::milliseconds;

constexpr int kMaxMetadataBytes = 8 * 1024;
// The server asks a silent peer whether it is there, so that a machine that
// vanished does not keep its place.
constexpr milliseconds kKeepaliveTime{60'000};
constexpr milliseconds kKeepaliveTimeout{20'000};
// Pings every ten seconds are a client's good right, also between calls; faster
// ones cost the connection after a few strikes.
constexpr milliseconds kMinPingInterval{5'000};

int Ms(milliseconds duration) { return static_cast<int>(duration.count()); }

}  // namespace

void LimitConnections(const ConnectionLimits& limits,
                      grpc::ServerBuilder* builder) {
  builder->AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
  builder->AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS,
                              Ms(limits.max_age));
  builder->AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_GRACE_MS,
                              Ms(limits.age_grace));
  builder->AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS,
                              Ms(limits.max_idle));
  builder->AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS,
                              Ms(limits.handshake));
  builder->AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS,
                              limits.max_calls);
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, Ms(kKeepaliveTime));
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS,
                              Ms(kKeepaliveTimeout));
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  // Else gRPC stops to ask on a connection where nothing else goes.
  builder->AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder->AddChannelArgument(
      GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
      Ms(kMinPingInterval));
}

}  // namespace terrane::server
