// BufferPool: the bytes of tiles, used again and again.
//
// Fresh memory costs more than the terrain in it (the kernel clears each page),
// so the buffer of a tile that went out comes back here. A buffer keeps its
// size and its old content: whoever takes one writes all of it.
//
// Threads: any. Bounded: what does not fit is freed.
#ifndef TERRANE_SERVER_SERVICE_BUFFER_POOL_H_
#define TERRANE_SERVER_SERVICE_BUFFER_POOL_H_

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace terrane::server {

class BufferPool {
 public:
  explicit BufferPool(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // A buffer of any size, perhaps empty; the latest given back.
  std::unique_ptr<std::string> Take() {
    std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<std::string>();
    std::unique_ptr<std::string> buffer = std::move(free_.back());
    free_.pop_back();
    bytes_ -= buffer->capacity();
    return buffer;
  }

  void Give(std::unique_ptr<std::string> buffer) {
    std::lock_guard lock(mutex_);
    if (bytes_ + buffer->capacity() > max_bytes_) return;
    bytes_ += buffer->capacity();
    free_.push_back(std::move(buffer));
  }

 private:
  const std::size_t max_bytes_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<std::string>> free_;
  std::size_t bytes_ = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_BUFFER_POOL_H_
