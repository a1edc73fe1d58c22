// CostMeter: what a generated point, a lattice's or a row of a tree, costs on
// this machine, out of running averages of what messages took and of how many
// points they had. Averages of both and not of their ratio: the tile of a
// single sample at the corner of a window takes a thousand times what its
// sample does, and a worker may have been held up over it.
//
// Threads: any. Not part of any result's bytes.
#ifndef TERRANE_SERVER_ACTOR_COST_METER_H_
#define TERRANE_SERVER_ACTOR_COST_METER_H_

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace terrane::server {

class CostMeter {
 public:
  // `first_ns` a point holds until something was measured; the default is a
  // lattice point's on a slow machine.
  explicit CostMeter(double first_ns = 5)
      : points_(kFirstPoints), ns_(first_ns * kFirstPoints) {}

  // Of so many points.
  double Seconds(std::int64_t points) const {
    std::lock_guard lock(mutex_);
    return static_cast<double>(points) * ns_ / points_ * 1e-9;
  }

  // A message of so many points took `spent`.
  void Add(std::chrono::nanoseconds spent, std::int64_t points) {
    if (points <= 0) return;
    const double count = static_cast<double>(points);
    std::lock_guard lock(mutex_);
    const double most = kMostRatio * count * ns_ / points_;
    ns_ += kWeight * (std::min(static_cast<double>(spent.count()), most) - ns_);
    points_ += kWeight * (count - points_);
  }

 private:
  // Weight of the newest message in the averages.
  static constexpr double kWeight = 1.0 / 16;
  // One message seems so many times dearer than the last ones, at most: a
  // machine that stood still for a minute must not price calls for hours.
  static constexpr double kMostRatio = 16;
  // What the first price counts for: points of a small message.
  static constexpr double kFirstPoints = 4096;

  mutable std::mutex mutex_;
  double points_;  // of a message
  double ns_;      // of the same
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_COST_METER_H_
