// The channel to a server: plain or TLS, with or without a token.
//
// Threads: from one; the channel itself from any.
#ifndef TERRANE_CLIENT_CHANNEL_H_
#define TERRANE_CLIENT_CHANNEL_H_

#include <grpcpp/channel.h>

#include <chrono>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/channel_security.h"
#include "client/patience.h"

namespace terrane::client {

// Channels to the same server share one TCP connection, unless each has its
// own.
enum class ChannelKind { kShared, kOwnConnection };

// `server` is as client/server_address.h reads it. Connects with the first
// call, and again whenever it must; `ping_after` is as in client/patience.h.
// Errors: INVALID_ARGUMENT when it is no address, when a file cannot be read,
// when a token would leave this machine without TLS, or when a list of
// addresses lacks the name in their certificates.
absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(
    const std::string& server, const ChannelSecurity& security,
    ChannelKind kind, std::chrono::milliseconds ping_after = kPingAfter);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHANNEL_H_
