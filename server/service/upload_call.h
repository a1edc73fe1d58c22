// UploadCall: one client-streaming rpc that brings content in chunks.
//
// Reads a message, hands it to a worker (hashing a chunk takes milliseconds),
// reads the next. One of both is always under way until Finish, so a cancelled
// call ends by itself: its read fails. So does one whose client sends nothing
// for too long: the room that its content takes is others', too.
//
// Lifetime: owns itself until OnDone.
#ifndef TERRANE_SERVER_SERVICE_UPLOAD_CALL_H_
#define TERRANE_SERVER_SERVICE_UPLOAD_CALL_H_

#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "server/service/call_context.h"
#include "server/service/status.h"

namespace terrane::server {

template <typename Request, typename Response>
class UploadCall final : public grpc::ServerReadReactor<Request>,
                         public WatchedCall {
 public:
  static grpc::ServerReadReactor<Request>* Start(
      const ServiceParts& parts, const char* method,
      grpc::CallbackServerContext* context, Response* response,
      std::unique_ptr<Upload<Request, Response>> upload) {
    std::shared_ptr<UploadCall> call(
        new UploadCall(parts, method, context, response, std::move(upload)));
    call->self_ = call;
    if (call->record_.status.ok()) {
      parts.watch->Add(call);
      call->ReadNext();
    } else {
      call->End(call->record_.status);
    }
    return call.get();
  }

  void OnReadDone(bool ok) override {
    {
      std::lock_guard lock(mutex_);
      reading_since_.reset();
    }
    Work share;
    share.client = record_.client;
    share.ticket = ticket_;
    parts_.workers->Submit(
        std::move(share),
        [this, ok, submitted = Clock::now()](core::TileScratch*) {
          const Clock::time_point start = Clock::now();
          record_.queued += start - submitted;
          if (ok) {
            Add(start);
          } else {
            Complete(start);
          }
        });
  }

  void OnDone() override {
    parts_.calls->Close(&record_);
    self_.reset();
  }

  void EndIfOverdue(const Overdue& overdue) override {
    {
      std::lock_guard lock(mutex_);
      if (ended_) return;
      const bool stalls = reading_since_.has_value() &&
                          *reading_since_ <= overdue.waiting_since;
      if (!stalls && deadline_ > overdue.deadline) return;
      if (stalls) stalled_ = true;
      cancelling_ = true;
    }
    context_->TryCancel();  // the read fails; reactions may run in here
    {
      std::lock_guard lock(mutex_);
      cancelling_ = false;
      if (!ended_) return;
    }
    FinishAtLast();
  }

 private:
  using Clock = std::chrono::steady_clock;

  UploadCall(const ServiceParts& parts, const char* method,
             grpc::CallbackServerContext* context, Response* response,
             std::unique_ptr<Upload<Request, Response>> upload)
      : parts_(parts),
        context_(context),
        deadline_(DeadlineOf(*context)),
        response_(response),
        record_(BeginCall(parts, method, context)),
        ticket_(parts.workers->NextTicket()),
        upload_(std::move(upload)) {}

  void Add(Clock::time_point start) {
    const absl::Status status = upload_->Add(part_);
    record_.bytes += static_cast<std::int64_t>(part_.chunk().size());
    record_.generated += Clock::now() - start;
    if (status.ok()) {
      ReadNext();
    } else {
      End(status);
    }
  }

  // An upload grows with each chunk, so each one is asked whether it may.
  void ReadNext() {
    if (parts_.memory->Tight()) {
      record_.refusal = Refusal::kMemory;
      const absl::Status refusal = ShortOfMemoryError();
      AddPushback(refusal, context_);
      return End(refusal);
    }
    {
      std::lock_guard lock(mutex_);
      reading_since_ = Clock::now();
    }
    this->StartRead(&part_);
  }

  void Complete(Clock::time_point start) {
    if (stalled_) {
      return End(absl::AbortedError("the client sends nothing any more"));
    }
    if (context_->IsCancelled()) return End(CancelStatus(deadline_));
    absl::StatusOr<Response> response = upload_->Finish();
    record_.generated += Clock::now() - start;
    if (!response.ok()) return End(response.status());
    *response_ = *std::move(response);
    End(absl::OkStatus());
  }

  void End(absl::Status status) {
    upload_.reset();
    record_.status = std::move(status);
    {
      std::lock_guard lock(mutex_);
      ended_ = true;
      if (cancelling_) return;
    }
    FinishAtLast();
  }

  void FinishAtLast() {
    parts_.linger->Then(context_->peer(), [this] {
      this->Finish(ToGrpcStatus(record_.status, record_.request_id));
    });
  }

  const ServiceParts& parts_;
  grpc::CallbackServerContext* const context_;
  const Clock::time_point deadline_;
  Response* const response_;
  CallRecord record_;
  const std::uint64_t ticket_;
  std::unique_ptr<Upload<Request, Response>> upload_;
  Request part_;
  std::shared_ptr<UploadCall> self_;

  std::mutex mutex_;
  // Since when a message is waited for.
  std::optional<Clock::time_point> reading_since_;
  bool cancelling_ = false;  // the watch ends it, and needs the context
  bool ended_ = false;       // its status is there
  std::atomic<bool> stalled_ = false;
};

// The reactor of a call whose content `upload` takes.
template <typename Request, typename Response>
grpc::ServerReadReactor<Request>* StartUpload(
    const ServiceParts& parts, const char* method,
    grpc::CallbackServerContext* context, Response* response,
    std::unique_ptr<Upload<Request, Response>> upload) {
  return UploadCall<Request, Response>::Start(parts, method, context, response,
                                              std::move(upload));
}

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_UPLOAD_CALL_H_
