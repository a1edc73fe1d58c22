#include "server/actor/error_reason.h"

#include "absl/strings/cord.h"
#include "absl/types/optional.h"

namespace terrane::server {
namespace {

constexpr char kPayloadType[] = "terrane.reason";

}  // namespace

absl::Status WithReason(absl::Status status, const ErrorReason& reason) {
  // reason, NUL, key, NUL, value: only the value comes from a request, and it
  // is last, so that whatever it holds cannot break the framing.
  status.SetPayload(kPayloadType, absl::Cord(reason.reason + '\0' + reason.key +
                                             '\0' + reason.value));
  return status;
}

absl::Status NotFoundError(const std::string& message,
                           const ErrorReason& reason) {
  return WithReason(absl::NotFoundError(message), reason);
}

std::optional<ErrorReason> ReasonOf(const absl::Status& status) {
  const absl::optional<absl::Cord> payload = status.GetPayload(kPayloadType);
  if (!payload.has_value()) return std::nullopt;
  const std::string text(*payload);
  const std::size_t reason_end = text.find('\0');
  const std::size_t key_end = text.find('\0', reason_end + 1);
  return ErrorReason{text.substr(0, reason_end),
                     text.substr(reason_end + 1, key_end - reason_end - 1),
                     text.substr(key_end + 1)};
}

}  // namespace terrane::server
