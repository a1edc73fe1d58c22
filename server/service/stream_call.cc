#include "server/service/stream_call.h"

#include <algorithm>
#include <utility>

#include "core/base/violations.h"
#include "server/service/status.h"

namespace terrane::server {
namespace {

// How long a stream that finds the line full should wait: about what a stream
// of a few hundred tiles takes.
constexpr std::chrono::milliseconds kRetryDelay{1000};
// What a stream that has taken longer than expected is thought to lack.
constexpr double kLeastSeconds = 1e-3;

double Seconds(std::chrono::nanoseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamCall::Start(
    const ServiceParts& parts, const char* method,
    grpc::CallbackServerContext* context,
    std::unique_ptr<StreamSource> source) {
  std::shared_ptr<StreamCall> stream(
      new StreamCall(parts, method, context, std::move(source)));
  stream->self_ = stream;
  stream->EnterGate();
  return stream.get();
}

StreamCall::StreamCall(const ServiceParts& parts, const char* method,
                       grpc::CallbackServerContext* context,
                       std::unique_ptr<StreamSource> source)
    : parts_(parts),
      context_(context),
      deadline_(DeadlineOf(*context)),
      call_ticket_(parts.workers->NextTicket()),
      source_(std::move(source)),
      record_(BeginCall(parts, method, context)) {}

void StreamCall::EnterGate() {
  if (!record_.status.ok()) {
    std::unique_lock lock(mutex_);
    EndWith(record_.status);
    return Advance(std::move(lock));
  }
  if (parts_.memory->Tight()) {
    return Refuse(Refusal::kMemory, ShortOfMemoryError());
  }
  const Work arriving = Arriving();
  const auto admitted = parts_.admission->Admit(arriving, TimeLeft(deadline_));
  if (!admitted.ok()) return Refuse(Refusal::kDeadline, admitted.status());
  parts_.workers->SetBacklog(arriving);
  const absl::Status full =
      RetryLaterError("too many streams are waiting; try again", kRetryDelay);
  // Once it has its ticket the stream can end at any time.
  const std::shared_ptr<StreamCall> keep = self_;
  {
    // Locked, so that the task cannot end the stream before the ticket is kept.
    std::lock_guard lock(mutex_);
    queued_since_ = Clock::now();
    ticket_ = parts_.gate->Enter(
        {record_.client, [stream = keep] { Submit(stream); },
         [stream = keep, full] { stream->Refuse(Refusal::kStreams, full); }});
  }
  if (!ticket_.has_value()) return Refuse(Refusal::kStreams, full);
  parts_.watch->Add(keep);
}

void StreamCall::Refuse(Refusal reason, const absl::Status& refusal) {
  std::unique_lock lock(mutex_);
  queued_since_.reset();
  if (!end_.has_value()) {
    record_.refusal = reason;
    AddPushback(refusal, context_);
    EndWith(refusal);
  }
  Advance(std::move(lock));
}

Work StreamCall::Arriving() const {
  Work work;
  work.client = record_.client;
  work.ticket = work.call = call_ticket_;
  work.seconds = Admission::Credible(
      parts_.admission->prices().Typical(record_.method), TimeLeft(deadline_));
  return work;
}

Work StreamCall::NextWork() const {
  Work work;
  work.client = record_.client;
  work.ticket = call_ticket_;
  if (!opened_) {
    work.work_class = WorkClass::kOpening;
    return work;
  }
  work.call = call_ticket_;
  work.goes_on = true;
  work.work_class = Admission::ClassOf(record_.estimated_seconds);
  // Batch streams of a client take turns, interactive ones come one by one.
  if (work.work_class == WorkClass::kBatch) {
    work.ticket = parts_.workers->NextTicket();
  }
  work.seconds =
      std::max(record_.estimated_seconds - SpentSeconds(), kLeastSeconds);
  return work;
}

void StreamCall::Submit(std::shared_ptr<StreamCall> stream) {
  WorkerPool* const workers = stream->parts_.workers;
  Work work = stream->NextWork();
  workers->Submit(std::move(work),
                  [stream = std::move(stream)](core::TileScratch* scratch) {
                    stream->RunTask(scratch);
                  });
}

double StreamCall::SpentSeconds() const {
  return Seconds(record_.generated - opening_time_);
}

absl::Status StreamCall::Price() {
  raw_seconds_ = source_->EstimatedSeconds();
  record_.estimated_seconds =
      parts_.admission->prices().Price(record_.method, raw_seconds_);
  if (Admission::ClassOf(record_.estimated_seconds) == WorkClass::kBatch) {
    record_.call_class = CallClass::kBatch;
  }
  opening_time_ = record_.generated;
  opened_ = true;
  const Work work = NextWork();
  parts_.workers->SetBacklog(work);
  waited_before_ = record_.queued + record_.generated;
  const auto admitted = parts_.admission->Admit(work, TimeLeft(deadline_));
  expected_ = admitted.value_or(Expectation());
  return admitted.status();
}

void StreamCall::RunTask(core::TileScratch* scratch) {
  const Clock::time_point start = Clock::now();
  {
    std::lock_guard lock(mutex_);
    const bool cancelled = end_.has_value();  // while in the queue
    if (!cancelled) record_.queued += start - *queued_since_;
    queued_since_.reset();
    if (cancelled) {
      parts_.workers->Leave(call_ticket_);
      return;
    }
    running_ = true;
  }
  // Only this task touches the source and the record while it runs.
  auto made = opened_ ? source_->Next(stop_.get_token(), scratch, &record_)
                      : source_->Open(stop_.get_token(), &record_);
  std::unique_lock lock(mutex_);
  running_ = false;
  record_.generated += Clock::now() - start;
  const absl::Status refusal =
      made.ok() && !opened_ ? Price() : absl::OkStatus();
  if (!refusal.ok()) {
    if (!end_.has_value()) {
      record_.refusal = Refusal::kDeadline;
      AddPushback(refusal, context_);
    }
    EndWith(refusal);
  } else if (made.ok()) {
    ahead_ = *std::move(made);
    all_made_ = source_->AllMade();
  } else {
    // The core knows that it was stopped, the call knows why.
    EndWith(absl::IsCancelled(made.status()) ? CancelStatus(deadline_)
                                             : made.status());
  }
  Advance(std::move(lock));
}

void StreamCall::Learn() {
  if (end_->ok()) {
    parts_.admission->prices().Learn(record_.method, raw_seconds_,
                                     SpentSeconds());
  }
  const bool cut_short = absl::IsDeadlineExceeded(*end_);
  if (end_->ok() || cut_short) {
    parts_.admission->Learn(
        expected_, Seconds(record_.queued + record_.generated - waited_before_),
        cut_short);
  }
}

void StreamCall::EndWith(const absl::Status& status) {
  if (!end_.has_value()) end_ = status;
}

bool StreamCall::MayGenerate() const {
  return !queued_since_.has_value() && !running_ && !ahead_.has_value() &&
         !all_made_ && !end_.has_value();
}

void StreamCall::Advance(std::unique_lock<std::mutex> lock) {
  if (finished_) return;
  const bool write = !writing_ && ahead_.has_value() && !end_.has_value();
  if (write) {
    outgoing_ = *std::move(ahead_);
    ahead_.reset();
    writing_ = true;
    write_began_ = Clock::now();
  }
  const bool generate = MayGenerate() && opened_;
  if (generate) queued_since_ = Clock::now();
  if (all_made_ && !ahead_.has_value() && !writing_) EndWith(absl::OkStatus());
  finished_ = end_.has_value() && !writing_ && !running_ && !cancelling_;
  const bool finish = finished_;
  if (finish) {
    record_.status = *end_;
    record_.sending = sending_;
    Learn();
  }
  // Once unlocked the stream can end at any time, and then lets go of itself.
  const std::shared_ptr<StreamCall> keep = self_;
  lock.unlock();
  if (generate) Submit(keep);
  if (write) StartWrite(&outgoing_);
  if (finish) {
    parts_.linger->Then(context_->peer(), [keep] {
      keep->Finish(
          ToGrpcStatus(keep->record_.status, keep->record_.request_id));
    });
  }
}

void StreamCall::OnWriteDone(bool ok) {
  std::unique_lock lock(mutex_);
  writing_ = false;
  sending_ += Clock::now() - write_began_;
  if (!ok) EndWith(CancelStatus(deadline_));
  Advance(std::move(lock));
}

void StreamCall::OnCancel() {
  stop_.request_stop();
  std::unique_lock lock(mutex_);
  if (queued_since_.has_value() && !end_.has_value()) {
    record_.queued += Clock::now() - *queued_since_;
  }
  EndWith(CancelStatus(deadline_));
  Advance(std::move(lock));
}

void StreamCall::EndIfOverdue(const Overdue& overdue) {
  {
    std::lock_guard lock(mutex_);
    if (finished_) return;
    const bool stalled = writing_ && write_began_ <= overdue.waiting_since;
    if (!stalled && deadline_ > overdue.deadline) return;
    if (stalled) {
      EndWith(absl::AbortedError("the reader takes no message any more"));
    }
    cancelling_ = true;
  }
  context_->TryCancel();  // the write fails; reactions may run in here
  std::unique_lock lock(mutex_);
  cancelling_ = false;
  Advance(std::move(lock));
}

void StreamCall::OnDone() {
  parts_.workers->Leave(call_ticket_);
  if (ticket_.has_value()) parts_.gate->Leave(*ticket_);
  parts_.calls->Close(&record_);
  self_.reset();
}

}  // namespace terrane::server
