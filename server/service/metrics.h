// Metrics: what the server counts, in Prometheus' text format.
// docs/operations.md lists every metric.
//
// Labels take their values from fixed sets (methods of the API, gRPC codes,
// classes of work, reasons of refusal), never from what a client sends, so the
// number of series is bounded. Series of the API's methods exist from the
// start, at zero.
//
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_METRICS_H_
#define TERRANE_SERVER_SERVICE_METRICS_H_

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "server/service/call_record.h"

namespace terrane::server {

// The type of Metrics::Text.
inline constexpr char kMetricsContentType[] =
    "text/plain; version=0.0.4; charset=utf-8";

// What is read from the running server whenever metrics are asked for. Called
// from any thread; must be quick. Those that are empty are not exported.
struct ServerGauges {
  using Read = std::function<double()>;

  Read workers;
  Read workers_busy;
  Read connections;
  Read memory_bytes;
  Read memory_limit_bytes;
  std::map<CallClass, Read> backlog_seconds;
};

class Metrics {
 public:
  // `services` are the full names of the API's services, such as
  // "terrane.v1.TerrainService".
  Metrics(std::span<const char* const> services, ServerGauges gauges);
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  // Counts a call that has begun.
  void CountBegun(const CallRecord& record);
  // Counts a call that is over, and its refusal if it was refused.
  void Record(const CallRecord& record);
  // Counts what was refused before it was a call, such as a connection.
  void CountRefusal(Refusal refusal);

  // Everything, in the text format.
  std::string Text() const;

 private:
  using Counters = prometheus::Family<prometheus::Counter>;
  using Histograms = prometheus::Family<prometheus::Histogram>;

  struct MethodSeries {
    prometheus::Counter* begun;
    prometheus::Counter* messages;
    prometheus::Counter* samples;
    prometheus::Counter* bytes;
    prometheus::Counter* work_seconds;
    prometheus::Histogram* seconds;
  };

  // The series of a method, made when it is first named.
  const MethodSeries& Of(const char* method);

  const ServerGauges gauges_;
  prometheus::Registry registry_;
  Counters& begun_;
  Counters& calls_;
  Histograms& seconds_;
  Counters& messages_;
  Counters& samples_;
  Counters& bytes_;
  Counters& work_seconds_;
  Histograms& cost_ratio_;
  Counters& refusals_;
  const std::map<CallClass, prometheus::Histogram*> queue_wait_;

  std::mutex mutex_;
  std::map<std::string_view, MethodSeries> methods_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_METRICS_H_
