// WorkerPool: the threads that generate.
//
// gRPC's threads only hand work over; everything that costs more than a few
// microseconds runs here, on as many threads as the machine gives. A task is
// one message of a stream (or one unary call), after which its stream queues
// again; whose turn it is says FairQueue, and how long it would take Backlog.
//
// Each thread owns a TileScratch, so working memory is that of `threads` tiles.
// Threads: any. The destructor runs what is queued and joins.
#ifndef TERRANE_SERVER_SERVICE_WORKER_POOL_H_
#define TERRANE_SERVER_SERVICE_WORKER_POOL_H_

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "core/terrain/terrain.h"
#include "server/service/backlog.h"
#include "server/service/fair_queue.h"

namespace terrane::server {

class WorkerPool {
 public:
  using Task = FairQueue::Task;

  // What there is to do.
  struct Load {
    int workers = 0;
    int busy = 0;
    double interactive_seconds = 0;
    double batch_seconds = 0;
  };

  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // The place of a new call in the order of calls.
  std::uint64_t NextTicket() { return ++last_ticket_; }
  void Submit(Work work, Task task);
  // Counts what a call has left to do before it has a task, or anew.
  void SetBacklog(const Work& work);
  // The call is over: a task of it that waits is dropped.
  void Leave(std::uint64_t call);
  Expectation Expect(const Work& work) const;
  Load load() const;

 private:
  using Clock = std::chrono::steady_clock;

  void Run();

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  FairQueue queue_;
  mutable Backlog backlog_;  // asking settles it
  int busy_ = 0;
  bool stopping_ = false;
  std::atomic<std::uint64_t> last_ticket_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_WORKER_POOL_H_
