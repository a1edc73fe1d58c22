#include "server/service/tile_stream.h"

#include <grpcpp/impl/codegen/proto_utils.h>

#include <utility>

#include "core/base/violations.h"
#include "server/service/status.h"
#include "server/service/tile_message.h"

namespace terrane::server {
namespace {

// How long a refused stream should wait: about what a stream of a few hundred
// tiles takes.
constexpr std::chrono::milliseconds kRetryDelay{1000};

}  // namespace

grpc::ServerWriteReactor<grpc::ByteBuffer>* TileStream::Start(
    const ServiceParts& parts, grpc::CallbackServerContext* context,
    const grpc::ByteBuffer& request) {
  std::shared_ptr<TileStream> stream(new TileStream(parts, context, request));
  stream->self_ = stream;
  stream->EnterGate();
  return stream.get();
}

TileStream::TileStream(const ServiceParts& parts,
                       grpc::CallbackServerContext* context,
                       const grpc::ByteBuffer& request)
    : parts_(parts),
      context_(context),
      request_(request),
      record_(BeginCall("StreamTiles", context)) {}

void TileStream::EnterGate() {
  // Locked, so that the task cannot end the stream before the ticket is kept.
  std::unique_lock lock(mutex_);
  queued_ = true;
  ticket_ = parts_.gate->Enter([stream = self_] { Submit(stream); });
  if (ticket_.has_value()) return;
  queued_ = false;
  const absl::Status refusal =
      RetryLaterError("too many streams are waiting; try again", kRetryDelay);
  context_->AddTrailingMetadata("grpc-retry-pushback-ms",
                                std::to_string(kRetryDelay.count()));
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
  const absl::Status status = job_ == nullptr ? Open() : MakeTile(scratch);
  std::unique_lock lock(mutex_);
  running_ = false;
  record_.queued += start - submitted;
  record_.generated += Clock::now() - start;
  if (status.ok()) {
    ahead_ = std::move(made_);
    all_made_ = next_tile_ == job_->total();
  } else {
    // The core knows that it was stopped, the call knows why.
    EndWith(absl::IsCancelled(status) ? CancelStatus(*context_) : status);
  }
  Advance(std::move(lock));
}

absl::Status TileStream::Open() {
  v1::StreamTilesRequest request;
  const grpc::Status parsed =
      grpc::SerializationTraits<v1::StreamTilesRequest>::Deserialize(&request_,
                                                                     &request);
  if (!parsed.ok()) {
    return absl::InvalidArgumentError(
        "the request is not a StreamTilesRequest");
  }
  auto job = parts_.actor->OpenTiles(request, stop_.get_token());
  if (!job.ok()) return job.status();
  job_ = *std::move(job);
  next_tile_ = job_->first();
  record_.recipe_hash = job_->header().recipe_hash();
  made_ = HeaderMessage(job_->header());
  return absl::OkStatus();
}

absl::Status TileStream::MakeTile(core::TileScratch* scratch) {
  tile_.set_allocated_data(parts_.buffers->Take().release());
  const absl::Status status =
      job_->MakeTile(next_tile_, stop_.get_token(), scratch, &tile_);
  if (!status.ok()) return status;
  ++next_tile_;
  record_.tiles += 1;
  record_.samples += tile_.window().width() * tile_.window().height();
  record_.bytes += static_cast<std::int64_t>(tile_.data().size());
  made_ = TakeTileMessage(parts_.buffers, &tile_);
  return absl::OkStatus();
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
  }
  const bool generate = MayGenerate() && job_ != nullptr;
  if (generate) queued_ = true;
  if (all_made_ && !ahead_.has_value() && !writing_) EndWith(absl::OkStatus());
  finished_ = end_.has_value() && !writing_ && !running_;
  const bool finish = finished_;
  if (finish) record_.status = *end_;
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
  parts_.log->Write(record_);
  self_.reset();
}

}  // namespace terrane::server
