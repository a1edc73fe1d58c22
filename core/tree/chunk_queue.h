// ChunkQueue: a first-in, first-out queue of runs of a fixed number of
// elements, in chunks that are given back as they are emptied.
//
// Its memory is that of what waits in it, rounded up to whole chunks; one empty
// chunk is kept for the next use. Belongs to one thread. Elements are moved by
// assignment only and need a default constructor.
#ifndef TERRANE_CORE_TREE_CHUNK_QUEUE_H_
#define TERRANE_CORE_TREE_CHUNK_QUEUE_H_

#include <cstddef>
#include <deque>
#include <memory>
#include <utility>

namespace terrane::core {

template <typename Element>
class ChunkQueue {
 public:
  static constexpr std::size_t kRunsOfChunk = 512;

  explicit ChunkQueue(std::size_t elements_of_run)
      : elements_of_run_(elements_of_run) {}

  // Runs that wait.
  std::size_t size() const { return size_; }
  // Bytes of all chunks.
  std::size_t bytes() const {
    const std::size_t chunks = chunks_.size() + (spare_ != nullptr ? 1 : 0);
    return chunks * kRunsOfChunk * elements_of_run_ * sizeof(Element);
  }

  // Space for a new last run, for the caller to fill.
  Element* Push() {
    if (back_ == kRunsOfChunk || chunks_.empty()) {
      chunks_.push_back(
          spare_ != nullptr
              ? std::move(spare_)
              : std::make_unique<Element[]>(kRunsOfChunk * elements_of_run_));
      back_ = 0;
    }
    ++size_;
    return &chunks_.back()[back_++ * elements_of_run_];
  }

  // The first run; there must be one.
  const Element* Front() const {
    return &chunks_.front()[front_ * elements_of_run_];
  }

  void Pop() {
    --size_;
    if (++front_ < kRunsOfChunk) return;
    spare_ = std::move(chunks_.front());
    chunks_.pop_front();
    front_ = 0;
  }

 private:
  std::size_t elements_of_run_;
  std::deque<std::unique_ptr<Element[]>> chunks_;
  std::unique_ptr<Element[]> spare_;
  std::size_t front_ = 0;  // run of the first chunk
  std::size_t back_ = 0;   // one past the last run of the last chunk
  std::size_t size_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_CHUNK_QUEUE_H_
