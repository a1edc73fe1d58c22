// The figures of a load test as the messages of client/bench_report.proto. Pure
// functions.
#ifndef TERRANE_CLIENT_BENCH_SUMMARY_H_
#define TERRANE_CLIENT_BENCH_SUMMARY_H_

#include <string>

#include "client/bench/load.h"
#include "client/bench/meter.h"
#include "client/bench/server_usage.h"
#include "client/bench_report.pb.h"

namespace terrane::client {

// "RESOURCE_EXHAUSTED".
std::string CodeName(grpc::StatusCode code);

// `measured` is how long requests were measured: shorter than planned when the
// test was stopped.
BenchRun Summarize(const LoadOptions& options, const LoadTimes& times,
                   const MixOptions& mix, const LoadFigures& figures,
                   LoadClock::duration measured);

// 0 stands for what the source did not say.
UsageSummary Summarize(const UsageWatch& watch);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_SUMMARY_H_
