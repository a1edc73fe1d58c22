#include "server/service/call_watch.h"

#include <algorithm>
#include <utility>

namespace terrane::server {
namespace {

using Clock = std::chrono::steady_clock;

// Looks in the time of the limit: a stall is seen within a quarter more.
constexpr int kLooks = 4;
constexpr std::chrono::seconds kLongestWait{1};

}  // namespace

CallWatch::CallWatch(std::chrono::milliseconds grace,
                     std::chrono::milliseconds stall_limit)
    : grace_(grace),
      stall_limit_(stall_limit),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

void CallWatch::Add(std::weak_ptr<WatchedCall> call) {
  std::lock_guard lock(mutex_);
  watched_.push_back(std::move(call));
}

void CallWatch::Run(const std::stop_token& stop) {
  const auto wait =
      std::min<std::chrono::milliseconds>(stall_limit_ / kLooks, kLongestWait);
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, wait, [] { return false; });
    }
    if (stop.stop_requested()) return;
    // Without the lock: what ends may go, and others may be added.
    for (const std::shared_ptr<WatchedCall>& call : Living()) {
      const Clock::time_point now = Clock::now();
      call->EndIfOverdue(
          {.deadline = now - grace_, .waiting_since = now - stall_limit_});
    }
  }
}

std::vector<std::shared_ptr<WatchedCall>> CallWatch::Living() {
  std::vector<std::shared_ptr<WatchedCall>> living;
  std::lock_guard lock(mutex_);
  std::erase_if(watched_, [&living](const std::weak_ptr<WatchedCall>& call) {
    std::shared_ptr<WatchedCall> locked = call.lock();
    if (locked == nullptr) return true;
    living.push_back(std::move(locked));
    return false;
  });
  return living;
}

}  // namespace terrane::server
