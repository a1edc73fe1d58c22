#include "server/service/metrics.h"

#include <google/protobuf/descriptor.h>
#include <prometheus/text_serializer.h>

#include <utility>
#include <vector>

#include "server/service/process_stats.h"
#include "server/service/status.h"

namespace terrane::server {
namespace {

using Buckets = prometheus::Histogram::BucketBoundaries;

// Upper bounds. An estimate takes a fraction of a millisecond, a large stream
// minutes.
const Buckets& CallSeconds() {
  static const Buckets buckets{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                               0.1,   0.25,   0.5,   1,    2.5,   5,
                               10,    30,     60,    300};
  return buckets;
}

const Buckets& WaitSeconds() {
  static const Buckets buckets{0.0001, 0.001, 0.0025, 0.005, 0.01,
                               0.025,  0.05,  0.1,    0.25,  0.5,
                               1,      2.5,   5,      10,    30};
  return buckets;
}

// Closest where a good estimate falls.
const Buckets& CostRatios() {
  static const Buckets buckets{0.1, 0.25, 0.5, 0.67, 0.8, 0.9, 1,
                               1.1, 1.25, 1.5, 2,    4,   10};
  return buckets;
}

prometheus::Family<prometheus::Counter>& CounterFamily(
    prometheus::Registry* registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(*registry);
}

prometheus::Family<prometheus::Histogram>& HistogramFamily(
    prometheus::Registry* registry, const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(*registry);
}

std::map<CallClass, prometheus::Histogram*> QueueWaits(
    prometheus::Registry* registry) {
  auto& family = HistogramFamily(
      registry, "terrane_queue_wait_seconds",
      "Time that a call waited for workers, over all its messages.");
  std::map<CallClass, prometheus::Histogram*> waits;
  for (const CallClass call_class : kCallClasses) {
    waits[call_class] =
        &family.Add({{"class", NameOf(call_class)}}, WaitSeconds());
  }
  return waits;
}

double Seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

prometheus::ClientMetric GaugeOf(double value) {
  prometheus::ClientMetric metric;
  metric.gauge.value = value;
  return metric;
}

void AddGauge(const char* name, const char* help, double value,
              std::vector<prometheus::MetricFamily>* families) {
  families->push_back(
      {name, help, prometheus::MetricType::Gauge, {GaugeOf(value)}});
}

void AddGauge(const char* name, const char* help,
              const ServerGauges::Read& read,
              std::vector<prometheus::MetricFamily>* families) {
  if (read) AddGauge(name, help, read(), families);
}

// Under the names that every Prometheus client gives them.
void AddProcess(std::vector<prometheus::MetricFamily>* families) {
  prometheus::ClientMetric cpu;
  cpu.counter.value = CpuSeconds();
  families->push_back({"process_cpu_seconds_total",
                       "Time of the process on CPUs.",
                       prometheus::MetricType::Counter,
                       {cpu}});
  AddGauge("process_open_fds", "Open file descriptors.", OpenFiles(), families);
  AddGauge("process_threads", "Threads of the process.", ThreadCount(),
           families);
}

void AddGauges(const ServerGauges& gauges,
               std::vector<prometheus::MetricFamily>* families) {
  AddGauge("terrane_workers", "Generating threads.", gauges.workers, families);
  AddGauge("terrane_workers_busy", "Generating threads at work.",
           gauges.workers_busy, families);
  AddGauge("terrane_connections", "Open connections.", gauges.connections,
           families);
  AddGauge("terrane_memory_bytes", "Resident set of the process.",
           gauges.memory_bytes, families);
  AddGauge("terrane_memory_limit_bytes",
           "Memory that the process may take; new streams are refused above "
           "nine tenths of it.",
           gauges.memory_limit_bytes, families);
  prometheus::MetricFamily backlog{
      "terrane_backlog_seconds",
      "Estimated work that is waiting, in seconds of one worker.",
      prometheus::MetricType::Gauge,
      {}};
  for (const auto& [call_class, read] : gauges.backlog_seconds) {
    backlog.metric.push_back(GaugeOf(read()));
    backlog.metric.back().label = {{"class", NameOf(call_class)}};
  }
  if (!backlog.metric.empty()) families->push_back(std::move(backlog));
}

}  // namespace

Metrics::Metrics(std::span<const char* const> services, ServerGauges gauges)
    : gauges_(std::move(gauges)),
      begun_(CounterFamily(&registry_, "terrane_rpc_begun_total",
                           "Calls that have begun; those that are not in "
                           "terrane_rpc_total are open.")),
      calls_(CounterFamily(&registry_, "terrane_rpc_total",
                           "Calls that are over, by gRPC code.")),
      seconds_(HistogramFamily(&registry_, "terrane_rpc_seconds",
                               "Time of a call from its beginning to its "
                               "end.")),
      messages_(CounterFamily(&registry_, "terrane_messages_total",
                              "Messages with content that streams made, such "
                              "as tiles.")),
      samples_(CounterFamily(&registry_, "terrane_samples_total",
                             "Samples in them: heights, vertices, rows, "
                             "pixels.")),
      bytes_(CounterFamily(&registry_, "terrane_bytes_total",
                           "Bytes of content made, or taken in by uploads.")),
      work_seconds_(CounterFamily(&registry_, "terrane_work_seconds_total",
                                  "Time that workers spent on calls.")),
      cost_ratio_(HistogramFamily(&registry_, "terrane_cost_ratio",
                                  "Estimated over actual work of a call that "
                                  "ended well.")),
      refusals_(CounterFamily(&registry_, "terrane_refusals_total",
                              "What was turned away to keep the rest going, "
                              "by reason.")),
      queue_wait_(QueueWaits(&registry_)) {
  for (const char* name : services) {
    const google::protobuf::ServiceDescriptor* const service =
        google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(
            name);
    for (int i = 0; i < service->method_count(); ++i) {
      const char* const method = service->method(i)->name().c_str();
      Of(method);
      calls_.Add({{"method", method}, {"code", CodeNameOf(absl::OkStatus())}});
    }
  }
  for (const Refusal refusal : kRefusals) {
    refusals_.Add({{"reason", NameOf(refusal)}});
  }
}

const Metrics::MethodSeries& Metrics::Of(const char* method) {
  std::lock_guard lock(mutex_);
  const auto known = methods_.find(method);
  if (known != methods_.end()) return known->second;
  const prometheus::Labels labels{{"method", method}};
  return methods_
      .emplace(method, MethodSeries{&begun_.Add(labels), &messages_.Add(labels),
                                    &samples_.Add(labels), &bytes_.Add(labels),
                                    &work_seconds_.Add(labels),
                                    &seconds_.Add(labels, CallSeconds())})
      .first->second;
}

void Metrics::CountBegun(const CallRecord& record) {
  Of(record.method).begun->Increment();
}

void Metrics::Record(const CallRecord& record) {
  const MethodSeries& series = Of(record.method);
  calls_.Add({{"method", record.method}, {"code", CodeNameOf(record.status)}})
      .Increment();
  series.seconds->Observe(Seconds(record.total));
  series.messages->Increment(static_cast<double>(record.tiles));
  series.samples->Increment(static_cast<double>(record.samples));
  series.bytes->Increment(static_cast<double>(record.bytes));
  series.work_seconds->Increment(Seconds(record.generated));
  if (record.refusal.has_value()) {
    // It never waited, and would make the waits look short.
    CountRefusal(*record.refusal);
    return;
  }
  queue_wait_.at(record.call_class)->Observe(Seconds(record.queued));
  // What was broken off did not do what was estimated.
  if (record.status.ok() && record.estimated_seconds > 0 &&
      record.generated.count() > 0) {
    cost_ratio_.Add({{"method", record.method}}, CostRatios())
        .Observe(record.estimated_seconds / Seconds(record.generated));
  }
}

void Metrics::CountRefusal(Refusal refusal) {
  refusals_.Add({{"reason", NameOf(refusal)}}).Increment();
}

std::string Metrics::Text() const {
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  AddGauges(gauges_, &families);
  AddProcess(&families);
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace terrane::server
