// FlowerGenerator: the instances of a flower or a bed, in blocks.
//
// A row is a pure function of the flower and its index, so a generator keeps
// nothing but its place: memory is one block whatever the bed, and resuming
// costs nothing. Prototypes are not streamed here: Flower::prototypes().
//
// Threads: a generator belongs to one thread; the Flower is shared. Errors: see
// Next. Determinism: see core/flower/flower.h.
#ifndef TERRANE_CORE_FLOWER_FLOWER_GENERATOR_H_
#define TERRANE_CORE_FLOWER_FLOWER_GENERATOR_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "absl/status/status.h"
#include "core/flower/flower.h"
#include "core/flower/instance_block.h"

namespace terrane::core {

class FlowerGenerator {
 public:
  // The largest block stays under 1 MiB in bytes.
  static constexpr std::size_t kBlockRows = 16'384;

  // Gives rows [from_row, rows()), `block_rows` (at least 1) at a time.
  explicit FlowerGenerator(std::shared_ptr<const Flower> flower,
                           std::int64_t from_row = 0,
                           std::size_t block_rows = kBlockRows);

  // Whether all rows have been given.
  bool Done() const { return row_ >= flower_->rows(); }

  // Replaces `block` by the next rows. Errors: CANCELLED when `stop` was asked
  // to, polled at least every millisecond; the block then holds the rows up to
  // there, and another call goes on behind them. INVALID_ARGUMENT naming
  // "from_row" when there are fewer rows.
  absl::Status Next(std::stop_token stop, InstanceBlock* block);

 private:
  std::shared_ptr<const Flower> flower_;
  const std::int64_t block_rows_;
  std::int64_t row_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_FLOWER_GENERATOR_H_
