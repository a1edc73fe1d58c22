#include "server/service/call_context.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <string_view>

#include "server/service/status.h"

namespace terrane::server {
namespace {

constexpr char kRequestIdKey[] = "x-request-id";

bool IsGoodId(std::string_view id) {
  constexpr std::size_t kMaxSize = 64;
  return !id.empty() && id.size() <= kMaxSize &&
         std::all_of(id.begin(), id.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                  (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
         });
}

std::string NewId() {
  thread_local std::mt19937_64 generator{std::random_device{}()};
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(generator()));
  return text;
}

std::string RequestId(const grpc::CallbackServerContext& context) {
  const auto& metadata = context.client_metadata();
  const auto given = metadata.find(kRequestIdKey);
  if (given != metadata.end()) {
    const std::string_view id(given->second.data(), given->second.size());
    if (IsGoodId(id)) return std::string(id);
  }
  return NewId();
}

}  // namespace

CallRecord BeginCall(const ServiceParts& parts, const char* method,
                     grpc::CallbackServerContext* context) {
  CallRecord record;
  record.method = method;
  record.request_id = RequestId(*context);
  context->AddInitialMetadata(kRequestIdKey, record.request_id);
  record.status = parts.access->Admit(*context, &record);
  AddPushback(record.status, context);
  return record;
}

Admission::TimeLeft TimeLeft(const grpc::CallbackServerContext& context) {
  const auto deadline = context.deadline();
  if (deadline == std::chrono::system_clock::time_point::max()) {
    return std::nullopt;
  }
  return deadline - std::chrono::system_clock::now();
}

void AddPushback(const absl::Status& status,
                 grpc::CallbackServerContext* context) {
  if (const auto delay = RetryDelayOf(status)) {
    context->AddTrailingMetadata("grpc-retry-pushback-ms",
                                 std::to_string(delay->count()));
  }
}

absl::Status CancelStatus(const grpc::CallbackServerContext& context) {
  // A client whose time is up cancels by itself, and that may come a moment
  // before the server's own clock says so.
  constexpr std::chrono::milliseconds kMoment{100};
  return context.deadline() <= std::chrono::system_clock::now() + kMoment
             ? absl::DeadlineExceededError("the deadline has passed")
             : absl::CancelledError("the client cancelled the call");
}

}  // namespace terrane::server
