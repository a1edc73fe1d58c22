#include "server/service/call_context.h"

#include <grpc/support/time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <string_view>

#include "server/service/status.h"
#include "server/service/trace_context.h"

namespace terrane::server {
namespace {

using Clock = CallRecord::Clock;

constexpr char kRequestIdKey[] = "x-request-id";
constexpr char kTraceKey[] = "traceparent";

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

// What the client sent under a key; empty when it sent nothing.
std::string_view Metadata(const grpc::CallbackServerContext& context,
                          const char* key) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(key);
  if (found == metadata.end()) return {};
  return {found->second.data(), found->second.size()};
}

std::string RequestId(const grpc::CallbackServerContext& context) {
  const std::string_view given = Metadata(context, kRequestIdKey);
  return IsGoodId(given) ? std::string(given) : NewId();
}

}  // namespace

CallRecord BeginCall(const ServiceParts& parts, const char* method,
                     grpc::CallbackServerContext* context) {
  CallRecord record;
  record.method = method;
  record.request_id = RequestId(*context);
  record.trace_id =
      TraceIdOf(Metadata(*context, kTraceKey)).value_or(std::string());
  context->AddInitialMetadata(kRequestIdKey, record.request_id);
  parts.calls->Open(record);
  record.status = parts.access->Admit(*context, &record);
  AddPushback(record.status, context);
  return record;
}

Clock::time_point DeadlineOf(const grpc::CallbackServerContext& context) {
  // gRPC's own conversion ends with nanoseconds that do not hold what a client
  // may send.
  constexpr std::chrono::seconds kCentury = std::chrono::hours(24 * 36525);
  const gpr_timespec deadline = context.raw_deadline();
  const gpr_timespec left =
      gpr_time_sub(deadline, gpr_now(deadline.clock_type));
  if (left.tv_sec >= kCentury.count()) return Clock::time_point::max();
  return Clock::now() +
         std::max<std::chrono::seconds>(std::chrono::seconds(left.tv_sec),
                                        -kCentury) +
         std::chrono::nanoseconds(left.tv_nsec);
}

Admission::TimeLeft TimeLeft(Clock::time_point deadline) {
  if (deadline == Clock::time_point::max()) return std::nullopt;
  return deadline - Clock::now();
}

absl::Status ShortOfMemoryError() {
  return RetryLaterError("the server is short of memory; try again",
                         std::chrono::seconds(1));
}

absl::Status AdmitTask(const ServiceParts& parts, Clock::time_point deadline,
                       bool takes_memory, Work* work, CallRecord* record) {
  if (takes_memory && parts.memory->Tight()) {
    record->refusal = Refusal::kMemory;
    return ShortOfMemoryError();
  }
  const Admission::TimeLeft left = TimeLeft(deadline);
  record->estimated_seconds =
      parts.admission->prices().Price(record->method, 0);
  work->client = record->client;
  work->call = work->ticket;
  work->seconds = Admission::Credible(record->estimated_seconds, left);
  const absl::Status status = parts.admission->Admit(*work, left).status();
  if (!status.ok()) record->refusal = Refusal::kDeadline;
  return status;
}

void AddPushback(const absl::Status& status,
                 grpc::CallbackServerContext* context) {
  if (const auto delay = RetryDelayOf(status)) {
    context->AddTrailingMetadata("grpc-retry-pushback-ms",
                                 std::to_string(delay->count()));
  }
}

absl::Status CancelStatus(Clock::time_point deadline) {
  // A client whose time is up cancels by itself, and that may come a moment
  // before the server's own clock says so.
  constexpr std::chrono::milliseconds kMoment{100};
  return deadline <= Clock::now() + kMoment
             ? absl::DeadlineExceededError("the deadline has passed")
             : absl::CancelledError("the client cancelled the call");
}

}  // namespace terrane::server
