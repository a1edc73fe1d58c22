#include "client/status_details.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "core/base/violations.h"
#include "terrane/v1/common.pb.h"

namespace terrane::client {
namespace {

constexpr char kPushbackKey[] = "grpc-retry-pushback-ms";
// No server asks for more than this in earnest.
constexpr std::int64_t kMaxRetryDelayMs = 3'600'000;

// The reasons of ErrorInfo that an upload mends, and the key of the content's
// id.
struct MissingContent {
  const char* reason;
  const char* key;
};
constexpr std::array<MissingContent, 2> kMissingContents = {{
    {"RASTER_NOT_FOUND", "raster_id"},
    {"SPOT_TABLE_NOT_FOUND", "table_id"},
}};

std::chrono::milliseconds RetryDelay(std::int64_t ms) {
  return std::chrono::milliseconds(
      std::clamp<std::int64_t>(ms, 0, kMaxRetryDelayMs));
}

// The details travel under the type URLs of google.rpc, whose field numbers the
// messages of terrane.v1 have; so the name after the last slash tells them
// apart.
std::string_view TypeName(const google::protobuf::Any& detail) {
  const std::string_view url = detail.type_url();
  return url.substr(url.rfind('/') + 1);
}

void AddDetail(const google::protobuf::Any& detail,
               core::Violations* violations, RemoteError* error) {
  const std::string_view type = TypeName(detail);
  if (type == "google.rpc.BadRequest") {
    v1::BadRequest bad_request;
    if (!bad_request.ParseFromString(detail.value())) return;
    for (const v1::FieldViolation& violation : bad_request.field_violations()) {
      violations->Add(violation.field(), violation.description());
    }
  } else if (type == "google.rpc.ErrorInfo") {
    v1::ErrorInfo info;
    if (!info.ParseFromString(detail.value())) return;
    for (const MissingContent& missing : kMissingContents) {
      const auto id = info.metadata().find(missing.key);
      if (info.reason() == missing.reason && id != info.metadata().end()) {
        error->missing_content = id->second;
      }
    }
  } else if (type == "google.rpc.RetryInfo") {
    v1::RetryInfo retry;
    if (!retry.ParseFromString(detail.value())) return;
    const std::int64_t seconds = std::clamp<std::int64_t>(
        retry.retry_delay().seconds(), 0, kMaxRetryDelayMs / 1000);
    error->retry_delay =
        RetryDelay(seconds * 1000 + retry.retry_delay().nanos() / 1'000'000);
  }
}

void AddPushback(const TrailingMetadata& trailing, RemoteError* error) {
  const auto found = trailing.find(kPushbackKey);
  if (found == trailing.end()) return;
  const char* const end = found->second.data() + found->second.size();
  std::int64_t ms = 0;
  const auto [rest, fault] = std::from_chars(found->second.data(), end, ms);
  if (fault != std::errc() || rest != end || ms < 0) {
    error->turned_away = true;
  } else {
    error->retry_delay = RetryDelay(ms);
  }
}

}  // namespace

RemoteError DecodeStatus(const grpc::Status& status,
                         const TrailingMetadata& trailing) {
  RemoteError error;
  if (status.ok()) return error;
  // gRPC's codes and Abseil's are the same numbers.
  error.status =
      absl::Status(static_cast<absl::StatusCode>(status.error_code()),
                   status.error_message());
  v1::ErrorStatus details;
  core::Violations violations;
  if (details.ParseFromString(status.error_details())) {
    for (const google::protobuf::Any& detail : details.details()) {
      AddDetail(detail, &violations, &error);
    }
  }
  if (!error.retry_delay.has_value()) AddPushback(trailing, &error);
  if (status.error_code() == grpc::StatusCode::INVALID_ARGUMENT &&
      !violations.empty()) {
    error.status = violations.ToStatus();
  }
  return error;
}

}  // namespace terrane::client
