#include "client/stall_watch.h"

#include <utility>

namespace terrane::client {

StallWatch::StallWatch(std::chrono::milliseconds limit,
                       std::function<void()> on_stall)
    : limit_(limit), on_stall_(std::move(on_stall)) {
  if (limit_.count() > 0) {
    thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  }
}

bool StallWatch::stalled() const {
  const std::lock_guard lock(mutex_);
  return stalled_;
}

void StallWatch::SetWaitingSince(std::optional<Clock::time_point> moment) {
  const std::lock_guard lock(mutex_);
  waiting_since_ = moment;
}

void StallWatch::Run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    // A wait that begins later is not due before then.
    const Clock::time_point now = Clock::now();
    const Clock::time_point due = waiting_since_.value_or(now) + limit_;
    if (due <= now) {
      stalled_ = true;
      on_stall_();  // under the lock, so that it hits no later wait
      return;
    }
    wake_.wait_until(lock, stop, due, [] { return false; });
  }
}

}  // namespace terrane::client
