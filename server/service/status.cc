#include "server/service/status.h"

#include <google/protobuf/message_lite.h>

#include <vector>

#include "absl/strings/cord.h"
#include "absl/types/optional.h"
#include "core/base/violations.h"
#include "server/actor/error_reason.h"
#include "terrane/v1/common.pb.h"

namespace terrane::server {
namespace {

constexpr char kRetryPayload[] = "terrane.retry_ms";
constexpr char kTypePrefix[] = "type.googleapis.com/google.rpc.";

// The codes have the same numbers, but only those of the API are let through: a
// new one has to be thought about here.
grpc::StatusCode ToGrpcCode(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kOk:
      return grpc::StatusCode::OK;
    case absl::StatusCode::kCancelled:
      return grpc::StatusCode::CANCELLED;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kOutOfRange:
      return grpc::StatusCode::INVALID_ARGUMENT;
    case absl::StatusCode::kDeadlineExceeded:
      return grpc::StatusCode::DEADLINE_EXCEEDED;
    case absl::StatusCode::kNotFound:
      return grpc::StatusCode::NOT_FOUND;
    case absl::StatusCode::kAlreadyExists:
      return grpc::StatusCode::ALREADY_EXISTS;
    case absl::StatusCode::kPermissionDenied:
      return grpc::StatusCode::PERMISSION_DENIED;
    case absl::StatusCode::kUnauthenticated:
      return grpc::StatusCode::UNAUTHENTICATED;
    case absl::StatusCode::kResourceExhausted:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case absl::StatusCode::kFailedPrecondition:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case absl::StatusCode::kAborted:
      return grpc::StatusCode::ABORTED;
    case absl::StatusCode::kUnimplemented:
      return grpc::StatusCode::UNIMPLEMENTED;
    case absl::StatusCode::kUnavailable:
      return grpc::StatusCode::UNAVAILABLE;
    case absl::StatusCode::kDataLoss:
      return grpc::StatusCode::DATA_LOSS;
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::
        kDoNotUseReservedForFutureExpansionUseDefaultInSwitchInstead_:
      return grpc::StatusCode::INTERNAL;
  }
  return grpc::StatusCode::INTERNAL;
}

// Cuts a UTF-8 text without cutting a character.
std::string Cut(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  constexpr char kMore[] = "...";
  std::size_t end = bytes - (sizeof kMore - 1);
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) {
    --end;
  }
  text.resize(end);
  return text + kMore;
}

void AddDetail(const std::string& type,
               const google::protobuf::MessageLite& detail,
               v1::ErrorStatus* status) {
  google::protobuf::Any* any = status->add_details();
  any->set_type_url(kTypePrefix + type);
  any->set_value(detail.SerializeAsString());
}

// As many violations as fit; the last entry then says how many do not.
v1::BadRequest ToBadRequest(const std::vector<core::Violation>& violations) {
  constexpr std::size_t kMaxTextBytes = 512;
  // For the envelope, and the entry about what was left out.
  constexpr std::size_t kReservedBytes = kMaxMessageBytes + 256;
  v1::BadRequest bad_request;
  for (std::size_t i = 0; i < violations.size(); ++i) {
    v1::FieldViolation* entry = bad_request.add_field_violations();
    entry->set_field(Cut(violations[i].field, kMaxTextBytes));
    entry->set_description(Cut(violations[i].description, kMaxTextBytes));
    if (bad_request.ByteSizeLong() > kMaxDetailBytes - kReservedBytes) {
      entry->set_field("(more)");
      entry->set_description("and " + std::to_string(violations.size() - i) +
                             " more");
      break;
    }
  }
  return bad_request;
}

std::string Details(const absl::Status& status, grpc::StatusCode code,
                    const std::string& message) {
  v1::ErrorStatus details;
  details.set_code(code);
  details.set_message(message);
  const std::vector<core::Violation> violations = core::ViolationsOf(status);
  if (!violations.empty()) {
    AddDetail("BadRequest", ToBadRequest(violations), &details);
  }
  if (const std::optional<ErrorReason> reason = ReasonOf(status)) {
    v1::ErrorInfo info;
    info.set_reason(reason->reason);
    info.set_domain("terrane");
    (*info.mutable_metadata())[reason->key] =
        Cut(reason->value, kMaxMessageBytes);
    AddDetail("ErrorInfo", info, &details);
  }
  if (const auto delay = RetryDelayOf(status)) {
    v1::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(delay->count() / 1000);
    retry.mutable_retry_delay()->set_nanos(
        static_cast<int>(delay->count() % 1000) * 1'000'000);
    AddDetail("RetryInfo", retry, &details);
  }
  return details.details().empty() ? std::string()
                                   : details.SerializeAsString();
}

}  // namespace

absl::Status RetryLaterError(const std::string& message,
                             std::chrono::milliseconds delay) {
  absl::Status status = absl::ResourceExhaustedError(message);
  status.SetPayload(kRetryPayload, absl::Cord(std::to_string(delay.count())));
  return status;
}

std::optional<std::chrono::milliseconds> RetryDelayOf(
    const absl::Status& status) {
  const absl::optional<absl::Cord> payload = status.GetPayload(kRetryPayload);
  if (!payload.has_value()) return std::nullopt;
  return std::chrono::milliseconds(std::stoll(std::string(*payload)));
}

std::string CodeNameOf(const absl::Status& status) {
  // Both name their codes alike.
  return absl::StatusCodeToString(
      static_cast<absl::StatusCode>(ToGrpcCode(status.code())));
}

bool IsServerFault(const absl::Status& status) {
  return ToGrpcCode(status.code()) == grpc::StatusCode::INTERNAL;
}

grpc::Status ToGrpcStatus(const absl::Status& status,
                          const std::string& request_id) {
  if (status.ok()) return grpc::Status::OK;
  if (IsServerFault(status)) {
    return {grpc::StatusCode::INTERNAL,
            "internal error, request id " + request_id};
  }
  const grpc::StatusCode code = ToGrpcCode(status.code());
  const std::string message =
      Cut(std::string(status.message()), kMaxMessageBytes);
  return {code, message, Details(status, code, message)};
}

}  // namespace terrane::server
