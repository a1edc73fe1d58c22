#include "server/service/prepare_call.h"

#include <utility>

#include "server/service/status.h"

namespace terrane::server {
namespace {

constexpr std::chrono::milliseconds kProgressInterval{500};

}  // namespace

grpc::ServerWriteReactor<v1::PrepareTerrainResponse>* PrepareCall::Start(
    const ServiceParts& parts, grpc::CallbackServerContext* context,
    const v1::PrepareTerrainRequest* request) {
  std::shared_ptr<PrepareCall> call(new PrepareCall(parts, context, request));
  call->self_ = call;
  Work share;
  {
    std::unique_lock lock(call->mutex_);
    const absl::Status status = call->Admit(&share);
    if (!status.ok()) {
      call->outcome_ = status;
      call->EndIfReady(std::move(lock));
      return call.get();
    }
    call->SetTimer();
  }
  parts.watch->Add(call);
  parts.workers->Submit(std::move(share),
                        [call](core::TileScratch*) { call->Run(); });
  return call.get();
}

absl::Status PrepareCall::Admit(Work* share) {
  if (!record_.status.ok()) return record_.status;
  // Minutes, perhaps.
  record_.call_class = CallClass::kBatch;
  share->work_class = WorkClass::kBatch;
  share->ticket = ticket_;
  const absl::Status status =
      AdmitTask(parts_, deadline_, true, share, &record_);
  AddPushback(status, context_);
  return status;
}

void PrepareCall::Run() {
  const Clock::time_point start = Clock::now();
  {
    std::lock_guard lock(mutex_);
    if (outcome_.has_value()) return;  // cancelled while it was queued
    running_ = true;
  }
  absl::StatusOr<v1::PreparedTerrain> outcome = parts_.actor->PrepareTerrain(
      *request_,
      [this](double fraction) {
        std::lock_guard lock(mutex_);
        fraction_ = fraction;
      },
      stop_.get_token());
  // The core knows that it was stopped, the call knows why.
  if (absl::IsCancelled(outcome.status())) outcome = CancelStatus(deadline_);

  std::unique_lock lock(mutex_);
  running_ = false;
  record_.queued = start - record_.begin;
  record_.generated = Clock::now() - start;
  if (outcome.ok()) {
    record_.recipe_hash = outcome->recipe_hash();
    parts_.admission->prices().Learn(
        record_.method, 0,
        std::chrono::duration<double>(record_.generated).count());
  }
  if (!outcome_.has_value()) outcome_ = std::move(outcome);
  EndIfReady(std::move(lock));
}

void PrepareCall::SetTimer() {
  // A new alarm each time: setting one again inside its own callback would
  // destroy what is being run.
  timer_.emplace();
  timer_->Set(std::chrono::system_clock::now() + kProgressInterval,
              [call = self_](bool expired) {
                if (expired) call->OnTimer();
              });
}

void PrepareCall::OnTimer() {
  std::unique_lock lock(mutex_);
  if (outcome_.has_value()) return;
  SetTimer();
  if (writing_) return;
  writing_ = true;
  write_began_ = Clock::now();
  message_.mutable_progress()->set_fraction(fraction_);
  // Once unlocked the call can end at any time, and then lets go of itself.
  const std::shared_ptr<PrepareCall> keep = self_;
  lock.unlock();
  StartWrite(&message_);
}

void PrepareCall::EndIfReady(std::unique_lock<std::mutex> lock) {
  if (finished_ || writing_ || running_ || cancelling_ ||
      !outcome_.has_value()) {
    return;
  }
  finished_ = true;
  record_.status = outcome_->status();
  const grpc::Status status = ToGrpcStatus(record_.status, record_.request_id);
  const std::shared_ptr<PrepareCall> keep = self_;
  lock.unlock();
  // Nobody sets the timer any more. It goes now: it shares this call, which
  // holds it.
  timer_.reset();
  parts_.linger->Then(context_->peer(), [keep, status] {
    if (status.ok()) {
      *keep->message_.mutable_prepared() = **std::move(keep->outcome_);
      keep->StartWriteAndFinish(&keep->message_, grpc::WriteOptions(), status);
    } else {
      keep->Finish(status);
    }
  });
}

void PrepareCall::OnWriteDone(bool ok) {
  std::unique_lock lock(mutex_);
  writing_ = false;
  // The reader has gone; OnCancel comes, too.
  if (!ok) stop_.request_stop();
  EndIfReady(std::move(lock));
}

void PrepareCall::OnCancel() {
  stop_.request_stop();
  std::unique_lock lock(mutex_);
  if (!running_ && !outcome_.has_value()) {
    record_.queued = Clock::now() - record_.begin;
    outcome_ = CancelStatus(deadline_);
  }
  EndIfReady(std::move(lock));
}

void PrepareCall::EndIfOverdue(const Overdue& overdue) {
  {
    std::lock_guard lock(mutex_);
    if (finished_) return;
    const bool stalled = writing_ && write_began_ <= overdue.waiting_since;
    if (!stalled && deadline_ > overdue.deadline) return;
    if (stalled) {
      outcome_ = absl::AbortedError("the reader takes no message any more");
    }
    cancelling_ = true;
  }
  context_->TryCancel();  // a write fails; reactions may run in here
  std::unique_lock lock(mutex_);
  cancelling_ = false;
  EndIfReady(std::move(lock));
}

void PrepareCall::OnDone() {
  parts_.workers->Leave(ticket_);
  parts_.calls->Close(&record_);
  self_.reset();
}

}  // namespace terrane::server
