#include "core/flower/flower_generator.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/violations.h"

namespace terrane::core {
namespace {

// Rows made between two looks at the stop token: some 100 microseconds.
constexpr std::int64_t kRowsOfPoll = 128;

}  // namespace

FlowerGenerator::FlowerGenerator(std::shared_ptr<const Flower> flower,
                                 std::int64_t from_row, std::size_t block_rows)
    : flower_(std::move(flower)),
      block_rows_(static_cast<std::int64_t>(block_rows)),
      row_(from_row) {}

absl::Status FlowerGenerator::Next(std::stop_token stop, InstanceBlock* block) {
  block->Clear();
  block->first_row = row_;
  if (row_ < 0 || row_ > flower_->rows()) {
    return ViolationError("from_row", "must be in [0, " +
                                          std::to_string(flower_->rows()) +
                                          "], got " + std::to_string(row_));
  }
  const Placement& placement = flower_->placement();
  const std::int64_t of_plant = placement.rows_of_plant();
  const std::int64_t end = row_ + std::min(block_rows_, flower_->rows() - row_);
  Plant plant;
  for (std::int64_t made = 0; row_ < end; ++row_, ++made) {
    if (made % kRowsOfPoll == 0 && stop.stop_requested()) {
      return absl::CancelledError("generation stopped");
    }
    const std::int64_t in_plant = row_ % of_plant;
    if (made == 0 || in_plant == 0) {
      plant = placement.PlantAt(static_cast<std::uint32_t>(row_ / of_plant));
    }
    block->Add(placement.RowOf(plant, in_plant));
  }
  return absl::OkStatus();
}

}  // namespace terrane::core
