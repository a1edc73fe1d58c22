// CallWatch: ends calls whose deadline has passed, and streams whose client
// takes, or sends, nothing any more.
//
// gRPC ends calls at their deadlines by itself, unless the wall clock was set
// back: its timers are of the steady clock, but the thread that they wake
// sleeps by the wall clock (Abseil's waits are futexes of it), and then for too
// long. The watch sleeps by the steady clock and lets gRPC go first.
//
// A stream that stalls costs no worker, but two messages and a place among the
// open streams, or the room of an upload, for as long as its client likes.
//
// Threads: any. The destructor joins.
#ifndef TERRANE_SERVER_SERVICE_CALL_WATCH_H_
#define TERRANE_SERVER_SERVICE_CALL_WATCH_H_

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace terrane::server {

// What is overdue: a call whose deadline was then or before, and one that has
// waited for its client since then or longer.
struct Overdue {
  std::chrono::steady_clock::time_point deadline;
  std::chrono::steady_clock::time_point waiting_since;
};

class WatchedCall {
 public:
  virtual ~WatchedCall() = default;
  virtual void EndIfOverdue(const Overdue& overdue) = 0;
};

class CallWatch {
 public:
  // Ends a call `grace` after its deadline, and a stream that has waited for
  // its client for `stall_limit`.
  CallWatch(std::chrono::milliseconds grace,
            std::chrono::milliseconds stall_limit);

  // Watches until the call is gone.
  void Add(std::weak_ptr<WatchedCall> call);

 private:
  void Run(const std::stop_token& stop);
  std::vector<std::shared_ptr<WatchedCall>> Living();

  const std::chrono::milliseconds grace_;
  const std::chrono::milliseconds stall_limit_;
  std::mutex mutex_;
  std::condition_variable_any wake_;  // by the stop alone
  std::vector<std::weak_ptr<WatchedCall>> watched_;
  // Last, so that it ends first.
  std::jthread thread_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CALL_WATCH_H_
