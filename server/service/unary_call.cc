#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerUnaryReactor* UnaryCall::Start(const ServiceParts& parts,
                                           const char* method,
                                           grpc::CallbackServerContext* context,
                                           Work work) {
  std::shared_ptr<UnaryCall> call(
      new UnaryCall(parts, method, context, std::move(work)));
  call->self_ = call;
  parts.workers->Submit([call](core::TileScratch*) { call->Run(); });
  return call.get();
}

void UnaryCall::Run() {
  const auto start = std::chrono::steady_clock::now();
  {
    std::lock_guard lock(mutex_);
    if (state_ != State::kQueued) return;
    state_ = State::kRunning;
  }
  record_.queued = start - record_.begin;
  absl::Status status = work_(stop_.get_token(), &record_);
  record_.generated = std::chrono::steady_clock::now() - start;
  {
    std::lock_guard lock(mutex_);
    state_ = State::kFinished;
  }
  // The core knows that it was stopped, the call knows why.
  End(absl::IsCancelled(status) ? CancelStatus(*context_) : status);
}

void UnaryCall::OnCancel() {
  stop_.request_stop();
  {
    std::lock_guard lock(mutex_);
    if (state_ != State::kQueued) return;
    state_ = State::kFinished;
  }
  End(CancelStatus(*context_));
}

void UnaryCall::End(absl::Status status) {
  record_.status = std::move(status);
  send_begin_ = CallRecord::Clock::now();
  Finish(ToGrpcStatus(record_.status, record_.request_id));
}

void UnaryCall::OnDone() {
  record_.sending = CallRecord::Clock::now() - send_begin_;
  parts_.calls->Close(&record_);
  self_.reset();
}

}  // namespace terrane::server
