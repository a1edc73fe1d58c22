// The one place where an absl::Status becomes a grpc::Status.
//
// Every code is mapped by an exhaustive switch. What a client can act on comes
// along in grpc-status-details-bin, which standard clients decode: BadRequest
// (violations), ErrorInfo (reason) and RetryInfo. A fault of the server is
// answered with an id and nothing else; the log has the same id and the text.
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_STATUS_H_
#define TERRANE_SERVER_SERVICE_STATUS_H_

#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace terrane::server {

// Longest grpc-message, and most bytes of details: together they stay below the
// 8 KiB of metadata that clients accept.
inline constexpr std::size_t kMaxMessageBytes = 1024;
inline constexpr std::size_t kMaxDetailBytes = 4096;

// RESOURCE_EXHAUSTED that says when to come back.
absl::Status RetryLaterError(const std::string& message,
                             std::chrono::milliseconds delay);

// When to come back, if the status says so.
std::optional<std::chrono::milliseconds> RetryDelayOf(
    const absl::Status& status);

grpc::Status ToGrpcStatus(const absl::Status& status,
                          const std::string& request_id);

// The name of the code that ToGrpcStatus gives a status, such as "NOT_FOUND".
std::string CodeNameOf(const absl::Status& status);

// True for the codes that ToGrpcStatus answers with an id only: a fault of the
// server, whose text belongs into the log.
bool IsServerFault(const absl::Status& status);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STATUS_H_
