// When the requests of an open loop are due.
//
// In an open loop the rate is given and the server's slowness does not slow it
// down: latency is measured from the moment a request was due, so that a stall
// shows in every request that it held up (no coordinated omission).
//
// Pure functions of the options; times are seconds since the start of the load.
#ifndef TERRANE_CLIENT_BENCH_ARRIVALS_H_
#define TERRANE_CLIENT_BENCH_ARRIVALS_H_

#include <cstdint>
#include <vector>

namespace terrane::client {

// kPoisson: independent callers, in bursts as those come. kEven: a metronome.
enum class ArrivalKind { kPoisson, kEven };

class Arrivals {
 public:
  // `rate` a second, above 0.
  Arrivals(double rate, ArrivalKind kind, std::uint64_t seed);

  // The first that was not taken yet.
  double next() const { return next_; }
  // Takes the next one.
  double Take();

 private:
  double Gap() const;

  double rate_;
  ArrivalKind kind_;
  std::uint64_t seed_;
  std::int64_t taken_ = 0;
  double next_;
};

// What of an open loop is to be started now, and what can not be any more.
struct DueRequests {
  std::vector<double> start;        // when each was due
  std::vector<double> not_started;  // likewise
};

// Takes all that are due by `now`. At most `free_slots` start, the earliest
// first; the others are lost, and are to be counted as such.
DueRequests TakeDue(double now, int free_slots, Arrivals* arrivals);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_ARRIVALS_H_
