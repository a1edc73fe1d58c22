// What a gRPC status says beyond its code: decodes grpc-status-details-bin into
// an absl::Status with violations, content to upload again, time to wait.
// Threads: any.
#ifndef TERRANE_CLIENT_STATUS_DETAILS_H_
#define TERRANE_CLIENT_STATUS_DETAILS_H_

#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace terrane::client {

struct RemoteError {
  // The gRPC code and message; INVALID_ARGUMENT carries the violations.
  absl::Status status;
  // Id of uploaded content that the server does not keep, or no longer: a
  // raster or a spot table. Empty when the error is another.
  std::string missing_content;
  // RetryInfo: wait at least this long.
  std::optional<std::chrono::milliseconds> retry_delay;
};

// Details that do not parse are left out: the code and message still stand.
RemoteError DecodeStatus(const grpc::Status& status);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_STATUS_DETAILS_H_
