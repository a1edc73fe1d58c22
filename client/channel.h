// The channel to a server: plain or TLS, with or without a token.
//
// Threads: from one; the channel itself from any.
#ifndef TERRANE_CLIENT_CHANNEL_H_
#define TERRANE_CLIENT_CHANNEL_H_

#include <grpcpp/channel.h>
#include <grpcpp/support/channel_arguments.h>

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/channel_security.h"

namespace terrane::client {

// True for "HOST:PORT" that is this machine, whatever the network does.
bool IsThisMachine(const std::string& target);

// Connects with the first call. Errors: INVALID_ARGUMENT when a file cannot be
// read, or when a token would leave this machine without TLS.
absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(
    const std::string& target, const ChannelSecurity& security,
    const grpc::ChannelArguments& arguments);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHANNEL_H_
