// WorkerPool: the threads that generate.
//
// gRPC's threads only hand work over; everything that costs more than a few
// microseconds runs here, on as many threads as the machine gives. Tasks run
// first in, first out. A task is one tile (or one unary call), after which its
// stream queues again: streams take turns tile by tile.
//
// Each thread owns a TileScratch, so working memory is that of `threads` tiles.
// Threads: Submit from any thread. The destructor runs what is queued and
// joins.
#ifndef TERRANE_SERVER_SERVICE_WORKER_POOL_H_
#define TERRANE_SERVER_SERVICE_WORKER_POOL_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "core/terrain/terrain.h"

namespace terrane::server {

class WorkerPool {
 public:
  using Task = std::function<void(core::TileScratch*)>;

  struct Load {
    int workers = 0;
    int busy = 0;  // workers at a task
  };

  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  void Submit(Task task);
  Load load() const;

 private:
  void Run();

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> tasks_;
  int busy_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_WORKER_POOL_H_
