#include "core/terrain/spot_pins.h"

#include <cmath>
#include <limits>

namespace terrane::core {
namespace {

std::vector<Box> BoxesOf(std::span<const Spot> spots) {
  std::vector<Box> boxes;
  for (const Spot& spot : spots) {
    if (spot.standard_error == 0) {
      boxes.push_back({spot.u, spot.v, spot.u, spot.v});
    }
  }
  return boxes;
}

}  // namespace

SpotPins::SpotPins(std::span<const Spot> spots) : index_(BoxesOf(spots)) {
  for (const Spot& spot : spots) {
    if (spot.standard_error == 0) {
      pins_.push_back({spot.u, spot.v, static_cast<float>(spot.height)});
    }
  }
}

std::int64_t SpotPins::MemoryBytes() const {
  // The index takes about as much again as its boxes.
  return static_cast<std::int64_t>(pins_.size() *
                                   (sizeof(Pin) + 2 * sizeof(Box)));
}

void SpotPins::Find(int level, std::int64_t x, std::int64_t y,
                    std::int64_t spacing, std::int64_t columns,
                    std::int64_t rows, std::vector<Found>* found) const {
  found->clear();
  if (pins_.empty()) return;
  const auto place = [&](std::int64_t index) {
    return std::ldexp(static_cast<double>(index), -level);
  };
  std::vector<std::uint32_t> ids;
  index_.Query({place(x), place(y), place(x + spacing * (columns - 1)),
                place(y + spacing * (rows - 1))},
               std::numeric_limits<std::size_t>::max(), &ids);
  for (const std::uint32_t id : ids) {
    const double column =
        std::ldexp(pins_[id].u, level) - static_cast<double>(x);
    const double row = std::ldexp(pins_[id].v, level) - static_cast<double>(y);
    const double i = column / static_cast<double>(spacing);
    const double j = row / static_cast<double>(spacing);
    if (i != std::floor(i) || j != std::floor(j)) continue;
    found->push_back({static_cast<std::int64_t>(i),
                      static_cast<std::int64_t>(j), pins_[id].height});
  }
}

}  // namespace terrane::core
