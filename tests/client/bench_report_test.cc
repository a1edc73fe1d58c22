// Reports of `terrane bench`: the knee, two of them compared, the page.
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "client/bench/comparison.h"
#include "client/bench/html_report.h"
#include "client/bench/server_usage.h"
#include "client/bench/summary.h"
#include "client/bench/svg_plot.h"
#include "client/bench/text_report.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;
using testing::Not;

// Measured over ten seconds.
BenchRun OpenRun(double rate, double good_per_second) {
  BenchRun run;
  run.set_loop("open");
  run.set_rate(rate);
  run.set_seconds(10);
  run.set_offered(10 * rate);
  run.set_good(10 * good_per_second);
  run.set_offered_per_second(rate);
  run.set_goodput_per_second(good_per_second);
  run.mutable_latency()->set_p99_ms(20);
  return run;
}

TEST(Sweep, KneeIsTheLastRateThatIsServed) {
  const BenchSweep sweep = SummarizeSweep(
      100,
      {OpenRun(50, 50), OpenRun(100, 96), OpenRun(200, 110), OpenRun(400, 99)});
  EXPECT_EQ(sweep.capacity(), 100);
  EXPECT_EQ(sweep.knee(), 100);
  EXPECT_EQ(sweep.peak_goodput(), 110);
  EXPECT_EQ(sweep.last_goodput(), 99);
}

TEST(Sweep, NoKneeWhenTheLowestRateIsTooMuch) {
  EXPECT_EQ(SummarizeSweep(0, {OpenRun(50, 40), OpenRun(60, 60)}).knee(), 0);
}

TEST(Sweep, TableHasARowForEachRate) {
  BenchReport report;
  *report.add_runs() = OpenRun(50, 50);
  *report.add_runs() = OpenRun(200, 110);
  *report.mutable_sweep() = SummarizeSweep(100, {OpenRun(50, 50)});
  const std::string table = SweepMarkdown(report);
  EXPECT_THAT(table, HasSubstr("| 50.0 | 0.5 | 50.0 | 100.0 % |"));
  EXPECT_THAT(table, HasSubstr("| 200.0 | 2 | 110.0 | 55.0 % |"));
}

TEST(Comparison, WithinTheToleranceIsNotWorse) {
  const BenchRun before = OpenRun(100, 100);
  BenchRun after = OpenRun(100, 91);
  after.mutable_latency()->set_p99_ms(21.9);
  for (const ComparedFigure& figure : Compare(before, after, 0.1)) {
    EXPECT_FALSE(figure.is_worse) << figure.name;
  }
}

TEST(Comparison, LessGoodputOrMoreLatencyIsWorse) {
  const auto worse = [](const BenchRun& after) {
    std::vector<std::string> names;
    for (const ComparedFigure& figure :
         Compare(OpenRun(100, 100), after, 0.1)) {
      if (figure.is_worse) names.push_back(figure.name);
    }
    return names;
  };
  EXPECT_THAT(worse(OpenRun(100, 89)), testing::ElementsAre("goodput/s"));
  BenchRun slow = OpenRun(100, 120);
  slow.mutable_latency()->set_p99_ms(22.1);
  EXPECT_THAT(worse(slow), testing::ElementsAre("p99 ms"));
}

TEST(Comparison, OfDifferentLoadsIsRefused) {
  BenchReport open;
  *open.add_runs() = OpenRun(100, 100);
  BenchReport closed = open;
  closed.mutable_runs(0)->set_loop("closed");
  EXPECT_EQ(CompareReports(open, closed, 0.1).status().code(),
            absl::StatusCode::kInvalidArgument);
  *closed.add_runs() = OpenRun(1, 1);
  EXPECT_EQ(CompareReports(open, closed, 0.1).status().code(),
            absl::StatusCode::kInvalidArgument);
}

class ReportFileTest : public testing::Test {
 protected:
  std::string Write(const std::string& text) {
    const std::string path = folder_.File("report.json");
    std::ofstream(path) << text;
    return path;
  }

  TemporaryFolder folder_;
};

TEST_F(ReportFileTest, ComesBackAsItWasWritten) {
  BenchReport report;
  report.set_format(1);
  *report.add_runs() = OpenRun(123.25, 99.5);
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(report, &json).ok());
  const absl::StatusOr<BenchReport> read = ReadReport(Write(json));
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->SerializeAsString(), report.SerializeAsString());
}

TEST_F(ReportFileTest, WhatIsNoReportIsRefused) {
  for (const char* text :
       {"", "{}", "[1]", "{\"format\":1}", "{\"format\":2,\"runs\":[{}]}"}) {
    EXPECT_EQ(ReadReport(Write(text)).status().code(),
              absl::StatusCode::kInvalidArgument)
        << text;
  }
  EXPECT_EQ(ReadReport("no-such-file").status().code(),
            absl::StatusCode::kNotFound);
}

TEST(Usage, IsReadOutOfMetrics) {
  const Usage usage = UsageOfMetricsText(
      "# HELP terrane_memory_bytes Resident memory.\n"
      "# TYPE terrane_memory_bytes gauge\n"
      "terrane_memory_bytes 1.5e+07\n"
      "terrane_memory_limit_bytes 3e+09\n"
      "process_cpu_seconds_total{mode=\"user time\"} 12.5\n"
      "process_cpu_seconds_total{mode=\"system\"} 2.5 1700000000\n");
  EXPECT_EQ(usage.memory_bytes, 1.5e7);
  EXPECT_EQ(usage.cpu_seconds, 15);
  EXPECT_FALSE(UsageOfMetricsText("other 1\n").cpu_seconds.has_value());
}

TEST(Usage, OfThisProcessGrowsAndOfNoneIsAnError) {
  const absl::StatusOr<Usage> usage = UsageOfProcess(getpid());
  ASSERT_TRUE(usage.ok()) << usage.status();
  EXPECT_GT(usage->memory_bytes, 1e6);
  EXPECT_EQ(UsageOfProcess(0x7fffffff).status().code(),
            absl::StatusCode::kNotFound);
}

TEST(Plot, LinesBreakWhereThereIsNoValue) {
  Plot plot{.title = "a < b"};
  plot.y.logarithmic = true;
  plot.series = {
      {.name = "s", .points = {{0, 1}, {1, 10}, {2, 0}, {3, 5}, {4, 5}}}};
  const std::string html = PlotHtml(plot);
  EXPECT_THAT(html, HasSubstr("a &lt; b"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  EXPECT_THAT(html, Not(HasSubstr("inf")));
  std::size_t paths = 0;
  for (std::size_t at = html.find("<path"); at != std::string::npos;
       at = html.find("<path", at + 1)) {
    ++paths;
  }
  EXPECT_EQ(paths, 2U);
}

TEST(Plot, WithoutPointsIsStillAPlot) {
  Plot plot;
  plot.series = {{.name = "none"}};
  EXPECT_THAT(PlotHtml(plot), HasSubstr("</svg>"));
}

TEST(HtmlReport, StandsAlone) {
  BenchReport report;
  report.set_server("<script>");
  *report.add_runs() = OpenRun(50, 50);
  *report.mutable_sweep() = SummarizeSweep(100, {OpenRun(50, 50)});
  const std::string html = HtmlReport(report);
  for (const char* part : {"<script", "http", "url(", "src=", "@import"}) {
    EXPECT_THAT(html, Not(HasSubstr(part)));
  }
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
}

TEST(Text, TimesHaveThreeDigitsAndAUnit) {
  EXPECT_EQ(MillisecondsText(0.812), "812 us");
  EXPECT_EQ(MillisecondsText(1.234), "1.23 ms");
  EXPECT_EQ(MillisecondsText(456.7), "457 ms");
  EXPECT_EQ(MillisecondsText(2500), "2.50 s");
}

}  // namespace
}  // namespace terrane::client
