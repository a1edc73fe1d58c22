// LatencyHistogram: how often each latency came, in some fifty kilobytes, with
// every percentile to 0.2 %.
//
// Log-linear: each octave of nanoseconds has 256 buckets of equal width, so a
// bucket is at most 1/256 of its values wide, and its middle at most 1/512 off.
// Values below 512 ns are exact. Counts, mean and largest value are exact at
// any size. Histograms of parts merge into that of the whole, in any order.
//
// Threads: one writes, or many read.
#ifndef TERRANE_CLIENT_BENCH_LATENCY_HISTOGRAM_H_
#define TERRANE_CLIENT_BENCH_LATENCY_HISTOGRAM_H_

#include <chrono>
#include <cstdint>
#include <vector>

namespace terrane::client {

class LatencyHistogram {
 public:
  using Nanoseconds = std::chrono::nanoseconds;

  // A negative latency, which no steady clock gives, counts as 0.
  void Record(Nanoseconds latency);
  void Merge(const LatencyHistogram& other);

  std::int64_t count() const { return count_; }
  Nanoseconds largest() const { return Nanoseconds(largest_); }
  // 0 without values.
  double mean_ns() const;
  // The value of rank ceil(quantile * count), the first being the smallest;
  // quantile in [0, 1]. 0 without values.
  double ValueAt(double quantile) const;
  // Share of the values that are at most `latency`, up to the width of a
  // bucket.
  double ShareUpTo(Nanoseconds latency) const;

 private:
  std::vector<std::int64_t> buckets_;  // as many as the largest value needs
  std::int64_t count_ = 0;
  std::int64_t largest_ = 0;
  double sum_ = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_LATENCY_HISTOGRAM_H_
