// What a gRPC status says beyond its code: decodes grpc-status-details-bin into
// an absl::Status with violations, content to upload again, time to wait. A
// proxy or another server may ask for that time only in the trailing metadata
// (grpc-retry-pushback-ms, gRPC's proposal A6). Pure functions. Threads: any.
#ifndef TERRANE_CLIENT_STATUS_DETAILS_H_
#define TERRANE_CLIENT_STATUS_DETAILS_H_

#include <grpcpp/support/status.h>
#include <grpcpp/support/string_ref.h>

#include <chrono>
#include <map>
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
  // Wait at least this long.
  std::optional<std::chrono::milliseconds> retry_delay;
  // Do not come back at all: the metadata name no time from 0 on.
  bool turned_away = false;
};

using TrailingMetadata = std::multimap<grpc::string_ref, grpc::string_ref>;

// Details that do not parse are left out: the code and message still stand. A
// RetryInfo goes before the metadata.
RemoteError DecodeStatus(const grpc::Status& status,
                         const TrailingMetadata& trailing = {});

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_STATUS_DETAILS_H_
