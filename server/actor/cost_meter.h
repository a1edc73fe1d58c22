// CostMeter: what a generated point, a lattice's or a row of a tree, costs on
// this machine, as a running average of what was measured. Threads: any; a lost
// update costs one sample of an average. Not part of any result's bytes.
#ifndef TERRANE_SERVER_ACTOR_COST_METER_H_
#define TERRANE_SERVER_ACTOR_COST_METER_H_

#include <atomic>
#include <chrono>
#include <cstdint>

namespace terrane::server {

class CostMeter {
 public:
  // `first_ns` holds until something was measured; the default is a lattice
  // point's on a slow machine.
  explicit CostMeter(double first_ns = 5) : ns_per_point_(first_ns) {}

  double ns_per_point() const {
    return ns_per_point_.load(std::memory_order_relaxed);
  }

  // Of so many points.
  double Seconds(std::int64_t points) const {
    return static_cast<double>(points) * ns_per_point() * 1e-9;
  }

  void Add(std::chrono::nanoseconds spent, std::int64_t points) {
    if (points <= 0) return;
    const double measured =
        static_cast<double>(spent.count()) / static_cast<double>(points);
    const double average = ns_per_point();
    ns_per_point_.store(average + kWeight * (measured - average),
                        std::memory_order_relaxed);
  }

 private:
  static constexpr double kWeight = 1.0 / 16;
  std::atomic<double> ns_per_point_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_COST_METER_H_
