// What is counted of a call, and how it is written.
#include "server/service/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <vector>

#include "terrane/v1/raster.pb.h"
#include "tests/server/exposition.h"
#include "tests/server/fake_actor.h"

namespace terrane::server {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr const char* kServices[] = {"terrane.v1.RasterService"};

CallRecord Call(const char* method, milliseconds total) {
  CallRecord record;
  record.method = method;
  record.total = total;
  return record;
}

class MetricsTest : public ::testing::Test {
 protected:
  // Naming the message has the linker keep its file, and so the service.
  MetricsTest() { v1::GetRasterRequest::descriptor(); }

  Exposition Read() const { return Exposition(metrics_.Text()); }

  Metrics metrics_{kServices, ServerGauges()};
};

TEST_F(MetricsTest, SeriesExistBeforeTheFirstCall) {
  const Exposition text = Read();
  EXPECT_EQ(text["terrane_rpc_total{code=\"OK\",method=\"GetRaster\"}"], 0);
  EXPECT_EQ(text["terrane_rpc_begun_total{method=\"GetRaster\"}"], 0);
  EXPECT_EQ(text["terrane_rpc_seconds_count{method=\"UploadRaster\"}"], 0);
  EXPECT_EQ(text["terrane_bytes_total{method=\"UploadRaster\"}"], 0);
  EXPECT_EQ(text["terrane_refusals_total{reason=\"streams\"}"], 0);
  EXPECT_EQ(text["terrane_queue_wait_seconds_count{class=\"batch\"}"], 0);
}

TEST_F(MetricsTest, CallsCountByMethodAndCode) {
  metrics_.Record(Call("GetRaster", milliseconds(3)));
  metrics_.Record(Call("GetRaster", milliseconds(40)));
  CallRecord failed = Call("GetRaster", milliseconds(1));
  failed.status = absl::NotFoundError("no such raster");
  metrics_.Record(failed);
  // Clients see these as other codes, so they count as those.
  failed.status = absl::OutOfRangeError("");
  metrics_.Record(failed);
  failed.status = absl::UnknownError("");
  metrics_.Record(failed);
  const Exposition text = Read();
  const auto count = [&text](const std::string& code) {
    return text["terrane_rpc_total{code=\"" + code +
                "\",method=\"GetRaster\"}"];
  };
  EXPECT_EQ(count("OK"), 2);
  EXPECT_EQ(count("NOT_FOUND"), 1);
  EXPECT_EQ(count("INVALID_ARGUMENT"), 1);
  EXPECT_EQ(count("INTERNAL"), 1);
  EXPECT_EQ(text["terrane_rpc_total{code=\"OK\",method=\"UploadRaster\"}"], 0);
}

TEST_F(MetricsTest, TimesFallIntoBuckets) {
  for (const int ms : {5, 5, 7, 400'000}) {
    metrics_.Record(Call("GetRaster", milliseconds(ms)));
  }
  const Exposition text = Read();
  const auto bucket = [&text](const std::string& bound) {
    return text["terrane_rpc_seconds_bucket{method=\"GetRaster\",le=\"" +
                bound + "\"}"];
  };
  EXPECT_EQ(bucket("0.0025"), 0);
  EXPECT_EQ(bucket("0.005"), 2);  // a bound belongs to its bucket
  EXPECT_EQ(bucket("0.01"), 3);
  EXPECT_EQ(bucket("300"), 3);
  EXPECT_EQ(bucket("+Inf"), 4);
  EXPECT_EQ(text["terrane_rpc_seconds_count{method=\"GetRaster\"}"], 4);
  EXPECT_DOUBLE_EQ(text["terrane_rpc_seconds_sum{method=\"GetRaster\"}"],
                   400.017);
}

TEST_F(MetricsTest, WorkOfACallIsAddedUp) {
  CallRecord record = Call("UploadRaster", milliseconds(100));
  record.tiles = 3;
  record.samples = 3000;
  record.bytes = 12'000;
  record.generated = milliseconds(50);
  record.queued = milliseconds(20);
  metrics_.Record(record);
  record.call_class = CallClass::kBatch;
  metrics_.Record(record);
  const Exposition text = Read();
  EXPECT_EQ(text["terrane_messages_total{method=\"UploadRaster\"}"], 6);
  EXPECT_EQ(text["terrane_samples_total{method=\"UploadRaster\"}"], 6000);
  EXPECT_EQ(text["terrane_bytes_total{method=\"UploadRaster\"}"], 24'000);
  EXPECT_DOUBLE_EQ(text["terrane_work_seconds_total{method=\"UploadRaster\"}"],
                   0.1);
  for (const std::string name : {"interactive", "batch"}) {
    EXPECT_EQ(text["terrane_queue_wait_seconds_count{class=\"" + name + "\"}"],
              1);
    EXPECT_DOUBLE_EQ(
        text["terrane_queue_wait_seconds_sum{class=\"" + name + "\"}"], 0.02);
  }
}

TEST_F(MetricsTest, EstimatesAreHeldAgainstWhatCallsTook) {
  CallRecord record = Call("GetRaster", milliseconds(100));
  record.generated = milliseconds(50);
  metrics_.Record(record);  // was not estimated
  EXPECT_FALSE(Read().Has("terrane_cost_ratio"));
  record.estimated_seconds = 0.1;
  metrics_.Record(record);
  record.status = absl::CancelledError("");
  metrics_.Record(record);  // did only a part of it
  const Exposition text = Read();
  EXPECT_EQ(text["terrane_cost_ratio_count{method=\"GetRaster\"}"], 1);
  EXPECT_DOUBLE_EQ(text["terrane_cost_ratio_sum{method=\"GetRaster\"}"], 2);
}

TEST_F(MetricsTest, RefusedCallsDoNotCountAsWaits) {
  CallRecord record = Call("GetRaster", milliseconds(1));
  record.status = absl::ResourceExhaustedError("");
  record.refusal = Refusal::kDeadline;
  metrics_.Record(record);
  metrics_.CountRefusal(Refusal::kConnections);
  const Exposition text = Read();
  EXPECT_EQ(text["terrane_refusals_total{reason=\"deadline\"}"], 1);
  EXPECT_EQ(text["terrane_refusals_total{reason=\"connections\"}"], 1);
  EXPECT_EQ(text["terrane_refusals_total{reason=\"memory\"}"], 0);
  EXPECT_EQ(text["terrane_queue_wait_seconds_count{class=\"interactive\"}"], 0);
  EXPECT_EQ(text["terrane_rpc_total{code=\"RESOURCE_EXHAUSTED\",method="
                 "\"GetRaster\"}"],
            1);
}

// Every series that there is, whatever happened.
TEST_F(MetricsTest, LabelsAreOfFixedSets) {
  CallRecord record = Call("GetRaster", milliseconds(1));
  record.client = "ipv4:10.0.0.7";
  record.recipe_hash = "sha256:0";
  record.request_id = "request-17";
  record.status = absl::NotFoundError("no raster sha256:0");
  metrics_.Record(record);
  const Exposition text = Read();
  const auto methods =
      Pair("method", UnorderedElementsAre("GetRaster", "UploadRaster"));
  EXPECT_THAT(text.Labels("terrane_rpc_total"),
              ElementsAre(Pair("code", UnorderedElementsAre("OK", "NOT_FOUND")),
                          methods));
  for (const std::string name :
       {"terrane_messages_total", "terrane_samples_total",
        "terrane_bytes_total", "terrane_work_seconds_total"}) {
    EXPECT_THAT(text.Labels(name), ElementsAre(methods)) << name;
  }
  EXPECT_THAT(text.Labels("terrane_refusals_total"),
              ElementsAre(Pair("reason", UnorderedElementsAre(
                                             "streams", "deadline", "memory",
                                             "client_limit", "connections"))));
  EXPECT_THAT(
      text.Labels("terrane_queue_wait_seconds"),
      ElementsAre(Pair("class", UnorderedElementsAre("interactive", "batch")),
                  Pair("le", ::testing::SizeIs(::testing::Gt(10U)))));
}

TEST(ServerGaugesTest, AreReadWhenAskedFor) {
  double busy = 1;
  ServerGauges gauges;
  gauges.workers_busy = [&busy] { return busy; };
  gauges.backlog_seconds[CallClass::kBatch] = [] { return 2.5; };
  const Metrics metrics({}, gauges);
  EXPECT_EQ(Exposition(metrics.Text())["terrane_workers_busy"], 1);
  busy = 2;
  const Exposition text(metrics.Text());
  EXPECT_EQ(text["terrane_workers_busy"], 2);
  EXPECT_EQ(text["terrane_backlog_seconds{class=\"batch\"}"], 2.5);
  EXPECT_EQ(text["terrane_backlog_seconds{class=\"interactive\"}"], -1);
  // Nobody connected these.
  EXPECT_FALSE(text.Has("terrane_workers"));
  EXPECT_FALSE(text.Has("terrane_connections"));
  EXPECT_FALSE(text.Has("terrane_memory_limit_bytes"));
}

TEST_F(MetricsTest, ProcessIsMeasured) {
  const Exposition before = Read();
  EXPECT_EQ(before.types().at("process_cpu_seconds_total"), "counter");
  const double threads = before["process_threads"];
  EXPECT_GE(threads, 1);
  const double files = before["process_open_fds"];
  EXPECT_GE(files, 1);
  {
    const std::ifstream one_more("/proc/self/statm");
    std::thread thread([&] {
      const Exposition now = Read();
      EXPECT_EQ(now["process_threads"], threads + 1);
      EXPECT_EQ(now["process_open_fds"], files + 1);
    });
    thread.join();
  }
  EXPECT_EQ(Read()["process_open_fds"], files);
  // Each reading takes some.
  EXPECT_TRUE(Eventually([&] {
    return Read()["process_cpu_seconds_total"] >
           before["process_cpu_seconds_total"];
  }));
}

TEST_F(MetricsTest, ThreadsCountTogether) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([this] {
      for (int k = 0; k < 500; ++k) {
        metrics_.Record(Call("GetRaster", milliseconds(1)));
        if (k % 100 == 0) Read();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(Read()["terrane_rpc_total{code=\"OK\",method=\"GetRaster\"}"],
            2000);
}

}  // namespace
}  // namespace terrane::server
