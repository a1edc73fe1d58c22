#include "server/service/tile_stream.h"

#include <utility>

#include "core/base/violations.h"
#include "server/service/status.h"

namespace terrane::server {
namespace {

// How long a refused stream should wait: about what a stream of a few hundred
// tiles takes.
constexpr std::chrono::milliseconds kRetryDelay{1000};

}  // namespace

grpc::ServerWriteReactor<grpc::ByteBuffer>* TileStream::Start(
    const ServiceParts& parts, const char* method,
    grpc::CallbackServerContext* context,
    std::unique_ptr<StreamSource> source) {
  std::shared_ptr<TileStream> stream(
      new TileStream(parts, method, context, std::move(source)));
  stream->self_ = stream;
  stream->EnterGate();
  return stream.get();
}

TileStream::TileStream(const ServiceParts& parts, const char* method,
                       grpc::CallbackServerContext* context,
                       std::unique_ptr<StreamSource> source)
    : parts_(parts),
      context_(context),
      source_(std::move(source)),
      record_(BeginCall(method, context)) {}

void TileStream::EnterGate() {
  if (parts_.memory->Tight()) {
    return Refuse(Refusal::kMemory,
                  RetryLaterError("the server is short of memory; try again",
                                  kRetryDelay));
  }
  {
    // Locked, so that the task cannot end the stream before the ticket is kept.
    std::lock_guard lock(mutex_);
    queued_ = true;
    ticket_ = parts_.gate->Enter([stream = self_] { Submit(stream); });
    if (ticket_.has_value()) return;
    queued_ = false;
  }
  Refuse(
      Refusal::kStreams,
      RetryLaterError("too many streams are waiting; try again", kRetryDelay));
}

void TileStream::Refuse(Refusal reason, const absl::Status& refusal) {
  context_->AddTrailingMetadata("grpc-retry-pushback-ms",
                                std::to_string(kRetryDelay.count()));
  std::unique_lock lock(mutex_);
  record_.refusal = reason;
  EndWith(refusal);
  Advance(std::move(lock));
}

void TileStream::Submit(std::shared_ptr<TileStream> stream) {
  WorkerPool* const workers = stream->parts_.workers;
  workers->Submit([stream = std::move(stream),
                   submitted = Clock::now()](core::TileScratch* scratch) {
    stream->RunTask(submitted, scratch);
  });
}

void TileStream::RunTask(Clock::time_point submitted,
                         core::TileScratch* scratch) {
  const Clock::time_point start = Clock::now();
  {
    std::lock_guard lock(mutex_);
    queued_ = false;
    if (end_.has_value()) return;  // cancelled while in the queue
    running_ = true;
  }
  // Only this task touches the source and the record while it runs.
  auto made = opened_ ? source_->Next(stop_.get_token(), scratch, &record_)
                      : source_->Open(stop_.get_token(), &record_);
  std::unique_lock lock(mutex_);
  running_ = false;
  record_.queued += start - submitted;
  record_.generated += Clock::now() - start;
  if (made.ok()) {
    opened_ = true;
    ahead_ = *std::move(made);
    all_made_ = source_->AllMade();
  } else {
    // The core knows that it was stopped, the call knows why.
    EndWith(absl::IsCancelled(made.status()) ? CancelStatus(*context_)
                                             : made.status());
  }
  Advance(std::move(lock));
}

void TileStream::EndWith(const absl::Status& status) {
  if (!end_.has_value()) end_ = status;
}

bool TileStream::MayGenerate() const {
  return !queued_ && !running_ && !ahead_.has_value() && !all_made_ &&
         !end_.has_value();
}

void TileStream::Advance(std::unique_lock<std::mutex> lock) {
  if (finished_) return;
  const bool write = !writing_ && ahead_.has_value() && !end_.has_value();
  if (write) {
    outgoing_ = *std::move(ahead_);
    ahead_.reset();
    writing_ = true;
    write_begin_ = Clock::now();
  }
  const bool generate = MayGenerate() && opened_;
  if (generate) queued_ = true;
  if (all_made_ && !ahead_.has_value() && !writing_) EndWith(absl::OkStatus());
  finished_ = end_.has_value() && !writing_ && !running_;
  const bool finish = finished_;
  if (finish) {
    record_.status = *end_;
    record_.sending = sending_;
  }
  // Once unlocked the stream can end at any time, and then lets go of itself.
  const std::shared_ptr<TileStream> keep = self_;
  lock.unlock();
  if (generate) Submit(keep);
  if (write) StartWrite(&outgoing_);
  if (finish) Finish(ToGrpcStatus(record_.status, record_.request_id));
}

void TileStream::OnWriteDone(bool ok) {
  std::unique_lock lock(mutex_);
  writing_ = false;
  sending_ += Clock::now() - write_begin_;
  if (!ok) EndWith(CancelStatus(*context_));
  Advance(std::move(lock));
}

void TileStream::OnCancel() {
  stop_.request_stop();
  std::unique_lock lock(mutex_);
  EndWith(CancelStatus(*context_));
  Advance(std::move(lock));
}

void TileStream::OnDone() {
  if (ticket_.has_value()) parts_.gate->Leave(*ticket_);
  parts_.calls->Close(&record_);
  self_.reset();
}

}  // namespace terrane::server
