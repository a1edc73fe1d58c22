// StallWatch: calls for an end when a wait takes too long.
//
// A thread of its own looks, seldom: a wait that is over in time costs two
// locks and wakes nobody. Only the time of waits counts, not what the caller
// does between them.
//
// Threads: one waits; stalled() any. The destructor joins.
#ifndef TERRANE_CLIENT_STALL_WATCH_H_
#define TERRANE_CLIENT_STALL_WATCH_H_

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace terrane::client {

class StallWatch {
 public:
  // Calls `on_stall`, once, in the wait that takes as long as `limit`; never
  // when that is 0. It must have that wait end, and not call back here.
  StallWatch(std::chrono::milliseconds limit, std::function<void()> on_stall);

  // Does what may take too long, and answers what that answers.
  template <typename Wait>
  auto During(const Wait& wait) {
    const Turn turn(this);
    return wait();
  }

  bool stalled() const;

 private:
  using Clock = std::chrono::steady_clock;

  class Turn {
   public:
    explicit Turn(StallWatch* watch) : watch_(watch) {
      watch_->SetWaitingSince(Clock::now());
    }
    ~Turn() { watch_->SetWaitingSince(std::nullopt); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    StallWatch* const watch_;
  };

  void SetWaitingSince(std::optional<Clock::time_point> moment);
  void Run(const std::stop_token& stop);

  const std::chrono::milliseconds limit_;
  const std::function<void()> on_stall_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<Clock::time_point> waiting_since_;
  bool stalled_ = false;
  std::jthread thread_;  // last: ends before what it uses goes
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_STALL_WATCH_H_
