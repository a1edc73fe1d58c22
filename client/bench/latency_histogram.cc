#include "client/bench/latency_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace terrane::client {
namespace {

// Buckets of an octave: a value keeps its leading bits.
constexpr int kOctaveBits = 8;
constexpr std::uint64_t kOctave = std::uint64_t{1} << kOctaveBits;

// The first two octaves of buckets are single nanoseconds; each further one
// drops one more of the trailing bits.
std::size_t BucketOf(std::uint64_t value) {
  const int shift =
      std::max(static_cast<int>(std::bit_width(value)) - kOctaveBits - 1, 0);
  return (static_cast<std::uint64_t>(shift) << kOctaveBits) + (value >> shift);
}

double MiddleOf(std::size_t bucket) {
  if (bucket < 2 * kOctave) return static_cast<double>(bucket);
  const int shift = static_cast<int>(bucket >> kOctaveBits) - 1;
  const std::uint64_t leading = (bucket & (kOctave - 1)) + kOctave;
  const double low = std::ldexp(static_cast<double>(leading), shift);
  return low + (std::ldexp(1.0, shift) - 1) / 2;
}

}  // namespace

void LatencyHistogram::Record(Nanoseconds latency) {
  const std::int64_t value = std::max<std::int64_t>(latency.count(), 0);
  const std::size_t bucket = BucketOf(static_cast<std::uint64_t>(value));
  if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
  ++buckets_[bucket];
  ++count_;
  largest_ = std::max(largest_, value);
  sum_ += static_cast<double>(value);
}

void LatencyHistogram::Merge(const LatencyHistogram& other) {
  if (other.buckets_.size() > buckets_.size()) {
    buckets_.resize(other.buckets_.size());
  }
  std::transform(other.buckets_.begin(), other.buckets_.end(), buckets_.begin(),
                 buckets_.begin(), std::plus<>());
  count_ += other.count_;
  largest_ = std::max(largest_, other.largest_);
  sum_ += other.sum_;
}

double LatencyHistogram::mean_ns() const {
  return count_ > 0 ? sum_ / static_cast<double>(count_) : 0;
}

double LatencyHistogram::ValueAt(double quantile) const {
  if (count_ == 0) return 0;
  const auto rank = std::max<std::int64_t>(
      static_cast<std::int64_t>(
          std::ceil(quantile * static_cast<double>(count_))),
      1);
  std::int64_t seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    seen += buckets_[i];
    if (seen >= rank) {
      return std::min(MiddleOf(i), static_cast<double>(largest_));
    }
  }
  return static_cast<double>(largest_);
}

double LatencyHistogram::ShareUpTo(Nanoseconds latency) const {
  if (count_ == 0 || latency.count() < 0) return 0;
  const std::size_t end =
      std::min(BucketOf(static_cast<std::uint64_t>(latency.count())) + 1,
               buckets_.size());
  const std::int64_t below = std::accumulate(
      buckets_.begin(), buckets_.begin() + static_cast<std::ptrdiff_t>(end),
      std::int64_t{0});
  return static_cast<double>(below) / static_cast<double>(count_);
}

}  // namespace terrane::client
