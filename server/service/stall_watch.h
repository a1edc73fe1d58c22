// StallWatch: ends streams whose client takes, or sends, nothing any more.
//
// Such a stream costs no worker, but two messages and a place among the open
// streams, or the room of an upload, for as long as its client likes. A thread
// looks at every stream a few times within the limit.
//
// Threads: any. The destructor joins.
#ifndef TERRANE_SERVER_SERVICE_STALL_WATCH_H_
#define TERRANE_SERVER_SERVICE_STALL_WATCH_H_

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace terrane::server {

class Stallable {
 public:
  virtual ~Stallable() = default;
  // Ends what has waited for its client since then or longer.
  virtual void EndIfStalledSince(
      std::chrono::steady_clock::time_point moment) = 0;
};

class StallWatch {
 public:
  explicit StallWatch(std::chrono::milliseconds limit);

  // Watches until the object is gone.
  void Add(std::weak_ptr<Stallable> stallable);

 private:
  void Run(const std::stop_token& stop);
  std::vector<std::shared_ptr<Stallable>> Living();

  const std::chrono::milliseconds limit_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<std::weak_ptr<Stallable>> watched_;
  // Last, so that it ends first.
  std::jthread thread_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STALL_WATCH_H_
