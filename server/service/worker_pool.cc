#include "server/service/worker_pool.h"

#include <chrono>
#include <utility>

namespace terrane::server {

WorkerPool::WorkerPool(int threads) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this] { Run(); });
  }
}

WorkerPool::~WorkerPool() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::Submit(Work work, Task task) {
  {
    std::lock_guard lock(mutex_);
    queue_.Push(std::move(work), std::move(task));
  }
  wake_.notify_one();
}

double WorkerPool::ExpectedSeconds(const Work& work) const {
  std::lock_guard lock(mutex_);
  return queue_.ExpectedSeconds(work, static_cast<int>(threads_.size()));
}

WorkerPool::Load WorkerPool::load() const {
  std::lock_guard lock(mutex_);
  return {static_cast<int>(threads_.size()), busy_,
          queue_.BacklogSeconds(WorkClass::kInteractive),
          queue_.BacklogSeconds(WorkClass::kBatch)};
}

void WorkerPool::Run() {
  using Clock = std::chrono::steady_clock;
  core::TileScratch scratch;
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (queue_.empty()) return;
    FairQueue::Taken taken = queue_.Pop();
    ++busy_;
    lock.unlock();
    const Clock::time_point start = Clock::now();
    taken.task(&scratch);
    taken.task = nullptr;  // what the task held goes without the lock
    const std::chrono::duration<double> spent = Clock::now() - start;
    lock.lock();
    --busy_;
    queue_.Finish(taken.work, spent.count());
  }
}

}  // namespace terrane::server
