// A machine-readable reason on a Status, which the service turns into an
// ErrorInfo detail (proto/terrane/v1/common.proto). Threads: any.
#ifndef TERRANE_SERVER_ACTOR_ERROR_REASON_H_
#define TERRANE_SERVER_ACTOR_ERROR_REASON_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace terrane::server {

struct ErrorReason {
  std::string reason;  // such as "RASTER_NOT_FOUND"
  std::string key;     // of what it is about, such as "raster_id"
  std::string value;
};

inline constexpr std::string_view kRasterNotFound = "RASTER_NOT_FOUND";
inline constexpr std::string_view kSpotTableNotFound = "SPOT_TABLE_NOT_FOUND";
inline constexpr std::string_view kPresetNotFound = "PRESET_NOT_FOUND";

// The status, with a reason.
absl::Status WithReason(absl::Status status, const ErrorReason& reason);
// NOT_FOUND with a reason.
absl::Status NotFoundError(const std::string& message,
                           const ErrorReason& reason);

// The reason a status carries.
std::optional<ErrorReason> ReasonOf(const absl::Status& status);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_ERROR_REASON_H_
