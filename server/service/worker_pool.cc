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

void WorkerPool::Submit(Task task) {
  {
    std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  wake_.notify_one();
}

WorkerPool::Load WorkerPool::load() const {
  std::lock_guard lock(mutex_);
  return {static_cast<int>(threads_.size()), busy_};
}

void WorkerPool::Run() {
  core::TileScratch scratch;
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    {
      const Task task = std::move(tasks_.front());
      tasks_.pop_front();
      ++busy_;
      lock.unlock();
      task(&scratch);
    }  // what the task held goes without the lock
    lock.lock();
    --busy_;
  }
}

}  // namespace terrane::server
