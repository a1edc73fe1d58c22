#include "server/service/worker_pool.h"

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
    if (work.call != 0) backlog_.AddTask(work);
    queue_.Push(std::move(work), std::move(task));
  }
  wake_.notify_one();
}

void WorkerPool::SetBacklog(const Work& work) {
  std::lock_guard lock(mutex_);
  backlog_.Set(work);
}

void WorkerPool::Leave(std::uint64_t call) {
  Task dropped;  // what it held goes without the lock
  std::lock_guard lock(mutex_);
  backlog_.Remove(call);
  dropped = queue_.Drop(call);
}

Expectation WorkerPool::Expect(const Work& work) const {
  const Clock::time_point now = Clock::now();
  std::lock_guard lock(mutex_);
  return backlog_.Expect(work, static_cast<int>(threads_.size()), now);
}

WorkerPool::Load WorkerPool::load() const {
  const Clock::time_point now = Clock::now();
  std::lock_guard lock(mutex_);
  return {static_cast<int>(threads_.size()), busy_,
          backlog_.Seconds(WorkClass::kInteractive, now),
          backlog_.Seconds(WorkClass::kBatch, now)};
}

void WorkerPool::Run() {
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
    const Clock::time_point end = Clock::now();
    const std::chrono::duration<double> spent = end - start;
    lock.lock();
    --busy_;
    queue_.Finish(taken.work, spent.count());
    backlog_.EndTask(taken.work, spent.count(), end);
  }
}

}  // namespace terrane::server
