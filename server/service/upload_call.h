// UploadCall: one client-streaming rpc that brings content in chunks.
//
// Reads a message, hands it to a worker (hashing a chunk takes milliseconds),
// reads the next. One of both is always under way until Finish, so a cancelled
// call ends by itself: its read fails.
//
// Lifetime: owns itself until OnDone.
#ifndef TERRANE_SERVER_SERVICE_UPLOAD_CALL_H_
#define TERRANE_SERVER_SERVICE_UPLOAD_CALL_H_

#include <grpcpp/support/server_callback.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>

#include "server/service/call_context.h"
#include "server/service/status.h"

namespace terrane::server {

template <typename Request, typename Response>
class UploadCall final : public grpc::ServerReadReactor<Request> {
 public:
  UploadCall(const ServiceParts& parts, const char* method,
             grpc::CallbackServerContext* context, Response* response,
             std::unique_ptr<Upload<Request, Response>> upload)
      : parts_(parts),
        context_(context),
        response_(response),
        record_(BeginCall(parts, method, context)),
        ticket_(parts.workers->NextTicket()),
        upload_(std::move(upload)) {
    if (record_.status.ok()) {
      ReadNext();
    } else {
      End(record_.status);
    }
  }

  void OnReadDone(bool ok) override {
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
    delete this;
  }

 private:
  using Clock = std::chrono::steady_clock;

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
    this->StartRead(&part_);
  }

  void Complete(Clock::time_point start) {
    if (context_->IsCancelled()) return End(CancelStatus(*context_));
    absl::StatusOr<Response> response = upload_->Finish();
    record_.generated += Clock::now() - start;
    if (response.ok()) *response_ = *std::move(response);
    End(response.status());
  }

  void End(absl::Status status) {
    upload_.reset();
    record_.status = std::move(status);
    parts_.linger->Then(context_->peer(), [this] {
      this->Finish(ToGrpcStatus(record_.status, record_.request_id));
    });
  }

  const ServiceParts& parts_;
  grpc::CallbackServerContext* const context_;
  Response* const response_;
  CallRecord record_;
  const std::uint64_t ticket_;
  std::unique_ptr<Upload<Request, Response>> upload_;
  Request part_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_UPLOAD_CALL_H_
