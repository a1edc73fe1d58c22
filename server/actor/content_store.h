// ContentStore: what clients uploaded, in memory, named by its content.
//
// Bounded in bytes, least recently used out first. Content that a terrain in
// use holds lives on until that terrain goes. Uploads on their way in are
// bounded by the same number, on their own.
//
// Content is a struct with a `description`: what equal contents may differ in,
// and no height depends on.
//
// Threads: every method from any thread. Errors: RESOURCE_EXHAUSTED when an
// upload is larger than what is free for uploads.
#ifndef TERRANE_SERVER_ACTOR_CONTENT_STORE_H_
#define TERRANE_SERVER_ACTOR_CONTENT_STORE_H_

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/actor/lru_store.h"

namespace terrane::server {

// Room for an upload, given back when the token goes.
using Reservation = std::shared_ptr<const void>;

template <typename Content>
class ContentStore {
 public:
  explicit ContentStore(std::int64_t capacity_bytes) : kept_(capacity_bytes) {}
  ContentStore(const ContentStore&) = delete;
  ContentStore& operator=(const ContentStore&) = delete;

  // `what` is the content's name in an error: "the raster".
  absl::StatusOr<Reservation> Reserve(const std::string& what,
                                      std::int64_t bytes) {
    std::lock_guard lock(mutex_);
    const std::int64_t free = kept_.capacity_bytes() - reserved_bytes_;
    if (bytes > free) {
      return absl::ResourceExhaustedError(
          what + " takes " + std::to_string(bytes) +
          " bytes; free for uploads are " + std::to_string(free) + " of " +
          std::to_string(kept_.capacity_bytes()));
    }
    reserved_bytes_ += bytes;
    // The token itself has no content: only its deleter counts.
    return Reservation(this, [bytes](ContentStore* store) {
      std::lock_guard release(store->mutex_);
      store->reserved_bytes_ -= bytes;
    });
  }

  // Keeps content under its id, and answers whether it was kept already. Of
  // equal contents the newer description stays.
  bool Insert(const std::string& id, Content content, std::int64_t bytes) {
    std::lock_guard lock(mutex_);
    if (Content* kept = kept_.Find(id)) {
      kept->description = std::move(content.description);
      return true;
    }
    kept_.Insert(id, std::move(content), bytes);
    return false;
  }

  // What is kept under an id, which counts as a use.
  std::optional<Content> Get(const std::string& id) {
    std::lock_guard lock(mutex_);
    const Content* kept = kept_.Find(id);
    return kept == nullptr ? std::nullopt : std::optional(*kept);
  }

  std::int64_t kept_bytes() const {
    std::lock_guard lock(mutex_);
    return kept_.kept_bytes();
  }

 private:
  mutable std::mutex mutex_;
  LruStore<Content> kept_;
  std::int64_t reserved_bytes_ = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_CONTENT_STORE_H_
