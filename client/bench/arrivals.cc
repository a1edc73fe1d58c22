#include "client/bench/arrivals.h"

#include <cmath>

#include "client/bench/random_number.h"

namespace terrane::client {

Arrivals::Arrivals(double rate, ArrivalKind kind, std::uint64_t seed)
    : rate_(rate), kind_(kind), seed_(seed), next_(Gap()) {}

double Arrivals::Take() {
  const double taken = next_;
  ++taken_;
  // A metronome counts, so that its error does not grow.
  next_ = kind_ == ArrivalKind::kEven ? static_cast<double>(taken_ + 1) / rate_
                                      : next_ + Gap();
  return taken;
}

double Arrivals::Gap() const {
  if (kind_ == ArrivalKind::kEven) return 1 / rate_;
  return -std::log1p(-RandomShare(seed_, RandomStream::kArrival, taken_)) /
         rate_;
}

DueRequests TakeDue(double now, int free_slots, Arrivals* arrivals) {
  DueRequests due;
  while (arrivals->next() <= now) {
    const double at = arrivals->Take();
    const bool fits = static_cast<int>(due.start.size()) < free_slots;
    (fits ? due.start : due.not_started).push_back(at);
  }
  return due;
}

}  // namespace terrane::client
