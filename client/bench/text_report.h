// A report of `terrane bench` as text: for the terminal, and as a table in
// Markdown for documents. Pure functions.
#ifndef TERRANE_CLIENT_BENCH_TEXT_REPORT_H_
#define TERRANE_CLIENT_BENCH_TEXT_REPORT_H_

#include <string>

#include "client/bench/load.h"
#include "client/bench_report.pb.h"

namespace terrane::client {

// "closed loop, 16 callers", "open loop, 120 requests/s".
std::string LoopText(const LoadOptions& load);
std::string LoopText(const BenchRun& run);

// One run, in some twenty lines.
std::string RunText(const BenchRun& run);

// A sweep: one row for each rate, and what follows from them.
std::string SweepMarkdown(const BenchReport& report);

// "1.23 ms", "812 us", "2.50 s".
std::string MillisecondsText(double ms);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_TEXT_REPORT_H_
