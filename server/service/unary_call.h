// UnaryCall: one unary rpc on the worker pool.
//
// gRPC's thread queues the work and returns. Cancelled (by the client or its
// deadline) before a worker took it, the call ends at once; after that the
// work's stop token is set, and the call ends when the work does, within a
// millisecond. So the request and response that gRPC owns are never touched
// after the end.
//
// Lifetime: owns itself until OnDone; a queued task shares it.
#ifndef TERRANE_SERVER_SERVICE_UNARY_CALL_H_
#define TERRANE_SERVER_SERVICE_UNARY_CALL_H_

#include <grpcpp/support/server_callback.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <utility>

#include "server/service/call_context.h"
#include "server/service/status.h"

namespace terrane::server {

class UnaryCall final : public grpc::ServerUnaryReactor, public WatchedCall {
 public:
  // Fills in the response that gRPC gave the handler, and the record.
  using Handler = std::function<absl::Status(std::stop_token, CallRecord*)>;

  static grpc::ServerUnaryReactor* Start(const ServiceParts& parts,
                                         const char* method,
                                         grpc::CallbackServerContext* context,
                                         Handler handler);

  void OnCancel() override;
  void OnDone() override;
  void EndIfOverdue(const Overdue& overdue) override;

 private:
  enum class State { kQueued, kRunning, kFinished };

  UnaryCall(const ServiceParts& parts, const char* method,
            grpc::CallbackServerContext* context, Handler handler)
      : parts_(parts),
        context_(context),
        deadline_(DeadlineOf(*context)),
        handler_(std::move(handler)),
        ticket_(parts.workers->NextTicket()),
        record_(BeginCall(parts, method, context)) {}

  void Refuse(const absl::Status& refusal);
  void Run();
  void End(absl::Status status);

  const ServiceParts& parts_;
  grpc::CallbackServerContext* const context_;
  const CallRecord::Clock::time_point deadline_;
  const Handler handler_;
  const std::uint64_t ticket_;  // its place among its client's calls
  std::stop_source stop_;
  CallRecord record_;
  CallRecord::Clock::time_point send_begin_;
  std::mutex mutex_;
  State state_ = State::kQueued;
  std::shared_ptr<UnaryCall> self_;
};

// Work that makes its response from a StatusOr.
template <typename Response, typename Make>
UnaryCall::Handler Answer(Response* response, Make make) {
  return [response, make = std::move(make)](std::stop_token stop,
                                            CallRecord* record) {
    absl::StatusOr<Response> made = make(std::move(stop));
    if (!made.ok()) return made.status();
    if constexpr (requires { made->recipe_hash(); }) {
      record->recipe_hash = made->recipe_hash();
    }
    record->bytes = static_cast<std::int64_t>(made->ByteSizeLong());
    *response = *std::move(made);
    return absl::OkStatus();
  };
}

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_UNARY_CALL_H_
