#include "server/service/stall_watch.h"

#include <algorithm>
#include <utility>

namespace terrane::server {
namespace {

// Looks in the time of the limit: a stall is seen within a quarter more.
constexpr int kLooks = 4;
// What has gone is forgotten as often, however long the limit.
constexpr std::chrono::seconds kLongestWait{5};

}  // namespace

StallWatch::StallWatch(std::chrono::milliseconds limit)
    : limit_(limit),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

void StallWatch::Add(std::weak_ptr<Stallable> stallable) {
  std::lock_guard lock(mutex_);
  watched_.push_back(std::move(stallable));
}

void StallWatch::Run(const std::stop_token& stop) {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(
          lock, stop,
          std::min<std::chrono::milliseconds>(limit_ / kLooks, kLongestWait),
          [] { return false; });
    }
    if (stop.stop_requested()) return;
    // Without the lock: what ends may go, and others may be added.
    for (const std::shared_ptr<Stallable>& one : Living()) {
      one->EndIfStalledSince(std::chrono::steady_clock::now() - limit_);
    }
  }
}

std::vector<std::shared_ptr<Stallable>> StallWatch::Living() {
  std::vector<std::shared_ptr<Stallable>> living;
  std::lock_guard lock(mutex_);
  std::erase_if(watched_, [&living](const std::weak_ptr<Stallable>& one) {
    std::shared_ptr<Stallable> locked = one.lock();
    if (locked == nullptr) return true;
    living.push_back(std::move(locked));
    return false;
  });
  return living;
}

}  // namespace terrane::server
