// LruStore: things by their id, bounded in bytes, the least recently used out
// first.
//
// What was handed out by shared_ptr lives on after it has gone from here; the
// bound counts what can be found by id. Threads: the owner's lock.
#ifndef TERRANE_SERVER_ACTOR_LRU_STORE_H_
#define TERRANE_SERVER_ACTOR_LRU_STORE_H_

#include <cstdint>
#include <list>
#include <string>
#include <unordered_map>
#include <utility>

namespace terrane::server {

template <typename Content>
class LruStore {
 public:
  explicit LruStore(std::int64_t capacity_bytes)
      : capacity_bytes_(capacity_bytes) {}

  // What is kept under an id, which counts as a use; null when nothing is.
  Content* Find(const std::string& id) {
    const auto kept = by_id_.find(id);
    if (kept == by_id_.end()) return nullptr;
    use_order_.splice(use_order_.begin(), use_order_, kept->second);
    return &kept->second->content;
  }

  // Keeps content in place of what was kept under the id. Larger than the
  // store, it is not kept.
  void Insert(const std::string& id, Content content, std::int64_t bytes) {
    if (const auto kept = by_id_.find(id); kept != by_id_.end()) {
      use_order_.splice(use_order_.end(), use_order_, kept->second);
      DropLast();
    }
    if (bytes > capacity_bytes_) return;
    while (kept_bytes_ + bytes > capacity_bytes_) DropLast();
    kept_bytes_ += bytes;
    use_order_.push_front({id, std::move(content), bytes});
    by_id_[id] = use_order_.begin();
  }

  std::int64_t capacity_bytes() const { return capacity_bytes_; }
  std::int64_t kept_bytes() const { return kept_bytes_; }

 private:
  struct Kept {
    std::string id;
    Content content;
    std::int64_t bytes;
  };

  void DropLast() {
    kept_bytes_ -= use_order_.back().bytes;
    by_id_.erase(use_order_.back().id);
    use_order_.pop_back();
  }

  const std::int64_t capacity_bytes_;
  std::int64_t kept_bytes_ = 0;
  std::list<Kept> use_order_;  // latest used first
  std::unordered_map<std::string, typename std::list<Kept>::iterator> by_id_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_LRU_STORE_H_
