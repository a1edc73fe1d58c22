// PrepareCall: one PrepareTerrain rpc.
//
// The preparation is one task of the worker pool; it only notes how far it is.
// Admitted at the average price of its kind: what one takes is known when its
// recipe has been read.
// A timer sends that twice a second, also while the task is queued, unless a
// slow reader still has the message before. The result is the last message.
//
// What happens next is decided under the mutex and done outside it (gRPC may
// run a reaction inside a call into it). Finish comes exactly once, when
// nothing is being written and no worker is at it. Cancelled before a worker
// took it, the call ends at once; after that the work's stop token is set.
//
// Lifetime: owns itself until OnDone; a queued task and the timer share it.
#ifndef TERRANE_SERVER_SERVICE_PREPARE_CALL_H_
#define TERRANE_SERVER_SERVICE_PREPARE_CALL_H_

#include <grpcpp/alarm.h>
#include <grpcpp/support/server_callback.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>

#include "server/service/call_context.h"

namespace terrane::server {

class PrepareCall final
    : public grpc::ServerWriteReactor<v1::PrepareTerrainResponse>,
      public WatchedCall {
 public:
  // `request` is gRPC's and lives until OnDone.
  static grpc::ServerWriteReactor<v1::PrepareTerrainResponse>* Start(
      const ServiceParts& parts, grpc::CallbackServerContext* context,
      const v1::PrepareTerrainRequest* request);

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;
  void EndIfOverdue(const Overdue& overdue) override;

 private:
  using Clock = CallRecord::Clock;

  PrepareCall(const ServiceParts& parts, grpc::CallbackServerContext* context,
              const v1::PrepareTerrainRequest* request)
      : parts_(parts),
        context_(context),
        deadline_(DeadlineOf(*context)),
        request_(request),
        ticket_(parts.workers->NextTicket()),
        record_(BeginCall(parts, "PrepareTerrain", context)) {}

  // OK when the call may wait for a worker, as `share`.
  absl::Status Admit(Work* share);
  void Run();
  // Sets the timer for the next progress message. Under the mutex.
  void SetTimer();
  void OnTimer();
  // Ends the call if nothing stands against it. Takes the lock over.
  void EndIfReady(std::unique_lock<std::mutex> lock);

  const ServiceParts& parts_;
  grpc::CallbackServerContext* const context_;
  const Clock::time_point deadline_;
  const v1::PrepareTerrainRequest* const request_;
  const std::uint64_t ticket_;  // its place among its client's calls
  std::stop_source stop_;
  std::shared_ptr<PrepareCall> self_;

  std::mutex mutex_;
  CallRecord record_;
  std::optional<grpc::Alarm> timer_;
  double fraction_ = 0;
  bool running_ = false;  // a worker is at it
  bool writing_ = false;
  Clock::time_point write_began_;
  bool cancelling_ = false;  // the watch ends it, and needs the context
  v1::PrepareTerrainResponse message_;  // of the write under way
  std::optional<absl::StatusOr<v1::PreparedTerrain>> outcome_;
  bool finished_ = false;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_PREPARE_CALL_H_
