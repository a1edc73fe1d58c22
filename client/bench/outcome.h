// How a load test ended, whatever the figures: did the server answer, and was
// what it answered whole? A pure function.
#ifndef TERRANE_CLIENT_BENCH_OUTCOME_H_
#define TERRANE_CLIENT_BENCH_OUTCOME_H_

#include "absl/status/status.h"
#include "client/bench_report.pb.h"

namespace terrane::client {

// The first of these that is true of any run or of all together. DATA_LOSS: an
// answer was damaged. CANCELLED: the test was stopped. UNAVAILABLE: nothing but
// that came. UNKNOWN: requests were due, and none ended well.
absl::Status OutcomeOf(const BenchReport& report);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_OUTCOME_H_
