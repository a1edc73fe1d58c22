// Making a terrain ready: how it is watched, what it found, what it takes.
#ifndef TERRANE_CORE_TERRAIN_PREPARATION_H_
#define TERRANE_CORE_TERRAIN_PREPARATION_H_

#include <cstdint>
#include <functional>
#include <stop_token>

namespace terrane::core {

// How a preparation is watched and ended.
struct Preparation {
  // Polled at least every few milliseconds; Create answers CANCELLED.
  std::stop_token stop;
  // Called with the share of the work that is done, 0 to 1, never falling, from
  // the thread that prepares. May be empty.
  std::function<void(double)> progress;
};

// What became of the spot heights.
struct SpotReport {
  std::int64_t spots = 0;   // lattice points that are conditioned
  int level = 0;            // that they snapped to
  double largest_move = 0;  // by snapping, in world units
  std::int64_t merged = 0;  // rows at the lattice point of another row
};

// What making a spec ready takes, at most.
struct PreparationCost {
  std::int64_t spots = 0;
  double cpu_seconds = 0;
  std::int64_t memory_bytes = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_PREPARATION_H_
