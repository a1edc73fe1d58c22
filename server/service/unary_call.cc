#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerUnaryReactor* UnaryCall::Start(const ServiceParts& parts,
                                           const char* method,
                                           grpc::CallbackServerContext* context,
                                           Handler handler) {
  std::shared_ptr<UnaryCall> call(
      new UnaryCall(parts, method, context, std::move(handler)));
  call->self_ = call;
  CallRecord& record = call->record_;
  if (!record.status.ok()) {
    call->state_ = State::kFinished;
    call->End(record.status);
    return call.get();
  }
  // What only looks something up takes no memory.
  const bool generates = ScopeOf(method) == kGenerateScope;
  Work share;
  share.ticket = call->ticket_;
  const absl::Status admitted =
      AdmitTask(parts, call->deadline_, generates, &share, &record);
  if (!admitted.ok()) {
    call->Refuse(admitted);
    return call.get();
  }
  parts.watch->Add(call);
  parts.workers->Submit(std::move(share),
                        [call](core::TileScratch*) { call->Run(); });
  return call.get();
}

void UnaryCall::Refuse(const absl::Status& refusal) {
  {
    std::lock_guard lock(mutex_);
    if (state_ != State::kQueued) return;  // cancelled meanwhile
    state_ = State::kFinished;
  }
  AddPushback(refusal, context_);
  End(refusal);
}

void UnaryCall::Run() {
  const auto start = std::chrono::steady_clock::now();
  {
    std::lock_guard lock(mutex_);
    if (state_ != State::kQueued) return;
    state_ = State::kRunning;
  }
  record_.queued = start - record_.begin;
  absl::Status status = handler_(stop_.get_token(), &record_);
  record_.generated = std::chrono::steady_clock::now() - start;
  {
    std::lock_guard lock(mutex_);
    state_ = State::kFinished;
  }
  if (status.ok()) {
    parts_.admission->prices().Learn(
        record_.method, 0,
        std::chrono::duration<double>(record_.generated).count());
  }
  // The core knows that it was stopped, the call knows why.
  End(absl::IsCancelled(status) ? CancelStatus(deadline_) : status);
}

void UnaryCall::OnCancel() {
  stop_.request_stop();
  {
    std::lock_guard lock(mutex_);
    if (state_ != State::kQueued) return;
    state_ = State::kFinished;
  }
  record_.queued = CallRecord::Clock::now() - record_.begin;
  End(CancelStatus(deadline_));
}

void UnaryCall::EndIfOverdue(const Overdue& overdue) {
  if (deadline_ <= overdue.deadline) OnCancel();
}

void UnaryCall::End(absl::Status status) {
  record_.status = std::move(status);
  send_begin_ = CallRecord::Clock::now();
  parts_.linger->Then(context_->peer(), [call = self_] {
    call->Finish(ToGrpcStatus(call->record_.status, call->record_.request_id));
  });
}

void UnaryCall::OnDone() {
  parts_.workers->Leave(ticket_);
  record_.sending = CallRecord::Clock::now() - send_begin_;
  parts_.calls->Close(&record_);
  self_.reset();
}

}  // namespace terrane::server
