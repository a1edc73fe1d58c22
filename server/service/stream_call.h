// StreamCall: one server-streaming rpc, whose messages a StreamSource makes.
//
// At most two messages are in hand: one being written, and one ahead of it,
// made or being made. A slow reader therefore costs two messages, whatever it
// asked for, and one outstanding write is all the back-pressure there is. Each
// message is one task of the worker pool, so streams take turns.
//
// What happens next is decided under the mutex and done outside it (gRPC may
// run a reaction inside a call into it); whoever decided to write or to finish
// is the only one to do so. Finish comes exactly once, when nothing is being
// written and no worker is at it: at the end, after a failure, or after
// OnCancel, which stops the generation within a millisecond.
//
// Lifetime: owns itself until OnDone; a queued task shares it.
#ifndef TERRANE_SERVER_SERVICE_STREAM_CALL_H_
#define TERRANE_SERVER_SERVICE_STREAM_CALL_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>

#include "server/service/call_context.h"
#include "server/service/stream_source.h"

namespace terrane::server {

class StreamCall final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                         public WatchedCall {
 public:
  static grpc::ServerWriteReactor<grpc::ByteBuffer>* Start(
      const ServiceParts& parts, const char* method,
      grpc::CallbackServerContext* context,
      std::unique_ptr<StreamSource> source);

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;
  void EndIfOverdue(const Overdue& overdue) override;

 private:
  using Clock = CallRecord::Clock;

  StreamCall(const ServiceParts& parts, const char* method,
             grpc::CallbackServerContext* context,
             std::unique_ptr<StreamSource> source);

  void EnterGate();
  // Refuses the stream, unless it has ended.
  void Refuse(Refusal reason, const absl::Status& refusal);
  // Queues the next task: opening the source first, then a message each. The
  // stream may end at any time from here on, so the task brings its own share
  // of it.
  static void Submit(std::shared_ptr<StreamCall> stream);
  // The stream before its request is read: what such streams usually are.
  Work Arriving() const;
  // What the next task is a part of. Under the mutex, or before the first one.
  Work NextWork() const;
  // On workers, for the messages behind the first one.
  double SpentSeconds() const;
  // Prices the stream, whose source is open; OK when it can end in time.
  absl::Status Price();
  void RunTask(core::TileScratch* scratch);
  // From an end, for the streams to come. Under the mutex.
  void Learn();
  // Ends the stream with a status, unless it has one.
  void EndWith(const absl::Status& status);
  // Does what can be done now: write, generate, finish. Takes the lock over.
  void Advance(std::unique_lock<std::mutex> lock);
  bool MayGenerate() const;

  const ServiceParts& parts_;
  grpc::CallbackServerContext* const context_;
  const Clock::time_point deadline_;
  std::stop_source stop_;
  std::shared_ptr<StreamCall> self_;

  // Its place among its client's calls.
  const std::uint64_t call_ticket_;

  // Of the task at work, one at a time.
  const std::unique_ptr<StreamSource> source_;

  // Of the write under way.
  grpc::ByteBuffer outgoing_;

  std::mutex mutex_;
  CallRecord record_;
  std::optional<StreamGate::Ticket> ticket_;
  std::optional<grpc::ByteBuffer> ahead_;  // made, not yet written
  // Since when it stands in line or a task of it waits for a worker; nothing
  // when neither does.
  std::optional<Clock::time_point> queued_since_;
  bool running_ = false;  // a worker is at it
  bool writing_ = false;
  Clock::time_point write_began_;
  std::chrono::nanoseconds sending_{0};  // over all writes
  bool cancelling_ = false;  // the watch ends it, and needs the context
  bool opened_ = false;
  std::chrono::nanoseconds opening_time_{0};   // on a worker
  double raw_seconds_ = 0;                     // what the source estimates
  Expectation expected_;                       // of its end, once admitted
  std::chrono::nanoseconds waited_before_{0};  // and on workers, until then
  bool all_made_ = false;
  std::optional<absl::Status> end_;  // set early by a failure or OnCancel
  bool finished_ = false;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STREAM_CALL_H_
