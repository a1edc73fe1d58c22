// MemoryBudget: bytes that many may hold, but not all at once.
//
// Counts, allocates nothing. Threads: any.
#ifndef TERRANE_SERVER_ACTOR_MEMORY_BUDGET_H_
#define TERRANE_SERVER_ACTOR_MEMORY_BUDGET_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace terrane::server {

class MemoryBudget {
 public:
  explicit MemoryBudget(std::int64_t bytes) : bytes_(bytes) {}

  // A share of the budget, until it is destroyed.
  class Share {
   public:
    Share(std::shared_ptr<MemoryBudget> budget, std::int64_t bytes)
        : budget_(std::move(budget)), bytes_(bytes) {}
    ~Share() { budget_->used_ -= bytes_; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

   private:
    const std::shared_ptr<MemoryBudget> budget_;
    const std::int64_t bytes_;
  };

  // Errors: RESOURCE_EXHAUSTED when others hold too much, or nobody needs to.
  static absl::StatusOr<std::unique_ptr<Share>> Take(
      const std::shared_ptr<MemoryBudget>& budget, std::int64_t bytes) {
    if (bytes > budget->bytes_) {
      return absl::ResourceExhaustedError(
          "the picture takes up to " + std::to_string(bytes) +
          " bytes; the server gives " + std::to_string(budget->bytes_));
    }
    if (budget->used_.fetch_add(bytes) + bytes > budget->bytes_) {
      budget->used_ -= bytes;
      return absl::ResourceExhaustedError(
          "other pictures hold the server's memory for them; try again");
    }
    return std::make_unique<Share>(budget, bytes);
  }

 private:
  const std::int64_t bytes_;
  std::atomic<std::int64_t> used_ = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_MEMORY_BUDGET_H_
