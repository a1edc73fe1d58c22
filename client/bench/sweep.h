// The runs of a sweep, and its knee: the rate up to which a server does 95 % of
// what it is asked. Pure functions.
#ifndef TERRANE_CLIENT_BENCH_SWEEP_H_
#define TERRANE_CLIENT_BENCH_SWEEP_H_

#include <optional>
#include <vector>

#include "client/bench_report.pb.h"

namespace terrane::client {

// The report's open loops that ran to their end, from the lowest rate. They
// point into the report.
std::vector<const BenchRun*> RungsOf(const BenchReport& report);

// The rate that says most about where the knee is: the geometric mean of the
// last rate up to which all were served and of the next one. Nothing when all
// rates were served, or not even the lowest.
std::optional<double> RateToTry(const BenchReport& report);

// Of a report's runs; a closed loop among them has measured the capacity.
BenchSweep SummarizeSweep(const BenchReport& report);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_SWEEP_H_
