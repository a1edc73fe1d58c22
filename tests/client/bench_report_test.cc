// Reports of `terrane bench`: the knee, the outcome, two of them compared, the
// page.
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>

#include "client/bench/comparison.h"
#include "client/bench/html_report.h"
#include "client/bench/outcome.h"
#include "client/bench/server_usage.h"
#include "client/bench/summary.h"
#include "client/bench/svg_plot.h"
#include "client/bench/sweep.h"
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

BenchRun ClosedRun(double good_per_second) {
  BenchRun run;
  run.set_loop("closed");
  run.set_concurrency(16);
  run.set_goodput_per_second(good_per_second);
  return run;
}

BenchReport ReportOf(const std::vector<BenchRun>& runs) {
  BenchReport report;
  for (const BenchRun& run : runs) *report.add_runs() = run;
  return report;
}

TEST(Sweep, KneeIsTheLastRateThatIsServed) {
  const BenchSweep sweep = SummarizeSweep(
      ReportOf({ClosedRun(100), OpenRun(50, 50), OpenRun(100, 96),
                OpenRun(200, 110), OpenRun(400, 99)}));
  EXPECT_EQ(sweep.capacity(), 100);
  EXPECT_EQ(sweep.knee(), 100);
  EXPECT_EQ(sweep.beyond_knee(), 200);
  EXPECT_EQ(sweep.peak_goodput(), 110);
  EXPECT_EQ(sweep.last_goodput(), 99);
}

TEST(Sweep, NoKneeWhenTheLowestRateIsTooMuch) {
  const BenchReport report = ReportOf({OpenRun(50, 40), OpenRun(60, 60)});
  EXPECT_EQ(SummarizeSweep(report).knee(), 0);
  EXPECT_EQ(SummarizeSweep(report).beyond_knee(), 50);
  EXPECT_FALSE(RateToTry(report).has_value());
}

TEST(Sweep, NoKneeWhenEveryRateIsServed) {
  const BenchReport report = ReportOf({OpenRun(50, 50), OpenRun(60, 60)});
  EXPECT_EQ(SummarizeSweep(report).knee(), 60);
  EXPECT_EQ(SummarizeSweep(report).beyond_knee(), 0);
  EXPECT_FALSE(RateToTry(report).has_value());
}

TEST(Sweep, TwoTriesFindTheKneeToAFifth) {
  // A server that bears 130 a second and loses the rest.
  const auto run_at = [](double rate) {
    return OpenRun(rate, std::min(rate, 130.0));
  };
  BenchReport report =
      ReportOf({run_at(50), run_at(100), run_at(200), run_at(400)});
  for (int i = 0; i < 2; ++i) {
    const std::optional<double> rate = RateToTry(report);
    ASSERT_TRUE(rate.has_value());
    *report.add_runs() = run_at(*rate);
  }
  EXPECT_NEAR(report.runs(4).rate(), 141.4, 0.1);
  EXPECT_NEAR(report.runs(5).rate(), 118.9, 0.1);
  const BenchSweep sweep = SummarizeSweep(report);
  EXPECT_NEAR(sweep.knee(), 118.9, 0.1);
  EXPECT_NEAR(sweep.beyond_knee(), 141.4, 0.1);
  EXPECT_LT(sweep.beyond_knee(), 1.2 * sweep.knee());
  EXPECT_EQ(sweep.last_goodput(), 130);
}

TEST(Sweep, RunThatWasInterruptedDoesNotCount) {
  BenchReport report = ReportOf({OpenRun(50, 50), OpenRun(100, 3)});
  report.mutable_runs(1)->set_interrupted(true);
  const BenchSweep sweep = SummarizeSweep(report);
  EXPECT_EQ(sweep.knee(), 50);
  EXPECT_EQ(sweep.beyond_knee(), 0);
  EXPECT_EQ(sweep.last_goodput(), 50);
  *report.mutable_sweep() = sweep;
  EXPECT_THAT(SweepMarkdown(report), Not(HasSubstr("| 100.0 |")));
}

TEST(Sweep, TableHasARowForEachRateFromTheLowest) {
  BenchReport report =
      ReportOf({ClosedRun(100), OpenRun(50, 50), OpenRun(200, 110)});
  *report.add_runs() = OpenRun(100, 98);  // tried last
  *report.mutable_sweep() = SummarizeSweep(report);
  const std::string table = SweepMarkdown(report);
  const std::size_t low = table.find("| 50.0 | 0.5 | 50.0 | 100.0 % |");
  const std::size_t middle = table.find("| 100.0 | 1 | 98.0 | 98.0 % |");
  const std::size_t high = table.find("| 200.0 | 2 | 110.0 | 55.0 % |");
  EXPECT_LT(low, middle);
  EXPECT_LT(middle, high);
  EXPECT_NE(high, std::string::npos);
  EXPECT_THAT(table, HasSubstr("Knee at 100.0/s offered; 200.0/s is too much"));
}

BenchRun RunOfCodes(const std::map<std::string, double>& counts) {
  BenchRun run;
  for (const auto& [code, count] : counts) {
    CodeCount* codes = run.add_codes();
    codes->set_code(code);
    codes->set_count(count);
    if (code != "OK") codes->set_example("why " + code);
    run.set_offered(run.offered() + count);
  }
  return run;
}

TEST(Outcome, IsWellWhenSomethingEndedWell) {
  EXPECT_TRUE(OutcomeOf(ReportOf({RunOfCodes({{"OK", 9}})})).ok());
  EXPECT_TRUE(OutcomeOf(ReportOf({RunOfCodes({{"UNAVAILABLE", 9}}),
                                  RunOfCodes({{"OK", 1}})}))
                  .ok());
  EXPECT_TRUE(OutcomeOf(ReportOf({BenchRun()})).ok());  // nothing was due
}

TEST(Outcome, AnyDamageIsDataLoss) {
  BenchReport report = ReportOf({RunOfCodes({{"OK", 999}, {"DATA_LOSS", 1}})});
  report.mutable_runs(0)->set_damaged(1);
  EXPECT_EQ(OutcomeOf(report).code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(OutcomeOf(report).message()),
              HasSubstr("why DATA_LOSS"));
  report.set_interrupted(true);
  EXPECT_EQ(OutcomeOf(report).code(), absl::StatusCode::kDataLoss);
}

TEST(Outcome, NothingButUnavailableIsUnavailable) {
  const BenchReport gone = ReportOf({RunOfCodes({{"UNAVAILABLE", 9}})});
  EXPECT_EQ(OutcomeOf(gone).code(), absl::StatusCode::kUnavailable);
  const BenchReport both =
      ReportOf({RunOfCodes({{"UNAVAILABLE", 9}, {"DEADLINE_EXCEEDED", 1}})});
  EXPECT_EQ(OutcomeOf(both).code(), absl::StatusCode::kUnknown);
}

TEST(Outcome, NothingThatEndedWellIsAnError) {
  EXPECT_EQ(OutcomeOf(ReportOf({RunOfCodes({{"INTERNAL", 9}})})).code(),
            absl::StatusCode::kUnknown);
  BenchRun hangs;
  hangs.set_offered(5);
  hangs.set_unfinished(5);
  EXPECT_EQ(OutcomeOf(ReportOf({hangs})).code(), absl::StatusCode::kUnknown);
}

TEST(Outcome, InterruptedIsCancelled) {
  BenchReport report = ReportOf({RunOfCodes({{"UNAVAILABLE", 9}})});
  report.set_interrupted(true);
  EXPECT_EQ(OutcomeOf(report).code(), absl::StatusCode::kCancelled);
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

TEST(Comparison, MoreThatIsLostIsWorse) {
  BenchRun before = OpenRun(100, 100);
  before.mutable_latency_with_lost()->set_p99_ms(20);
  BenchRun after = before;
  after.mutable_latency_with_lost()->set_p99_ms(5'000);
  const std::vector<ComparedFigure> figures = Compare(before, after, 0.1);
  EXPECT_EQ(std::count_if(figures.begin(), figures.end(),
                          [](const auto& figure) { return figure.is_worse; }),
            1);
}

TEST(Comparison, OfAnotherLoadIsRefusedByName) {
  const LoadSettings settings = {{"rate", "100"}, {"mix", "tiles=1"}};
  BenchReport report;
  EXPECT_THAT(std::string(CheckSameLoad(report, settings).message()),
              HasSubstr("does not say"));
  for (const auto& [name, value] : settings) {
    (*report.mutable_settings())[name] = value;
  }
  EXPECT_TRUE(CheckSameLoad(report, settings).ok());

  const LoadSettings other = {{"rate", "200"}, {"mix", "trees=1"}};
  const absl::Status status = CheckSameLoad(report, other);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("mix tiles=1 against trees=1, rate 100 against 200"));
  // A setting that only one of the versions knows.
  LoadSettings more = settings;
  more["haste"] = "1";
  EXPECT_THAT(std::string(CheckSameLoad(report, more).message()),
              HasSubstr("haste nothing against 1"));
  more = {{"rate", "100"}};
  EXPECT_THAT(std::string(CheckSameLoad(report, more).message()),
              HasSubstr("mix tiles=1 against nothing"));

  report.set_interrupted(true);
  EXPECT_THAT(std::string(CheckSameLoad(report, settings).message()),
              HasSubstr("interrupted"));
}

TEST(Comparison, PairsTheRunsThatWereAskedFor) {
  BenchReport before =
      ReportOf({ClosedRun(100), OpenRun(50, 50), OpenRun(200, 90)});
  BenchReport after = before;
  // What the search of one tried, the other did not.
  *before.add_runs() = OpenRun(100, 100);
  before.mutable_runs(3)->set_searched(true);
  EXPECT_FALSE(CompareReports(before, after, 0.1).is_worse);
  after.mutable_runs(2)->set_goodput_per_second(50);
  EXPECT_TRUE(CompareReports(before, after, 0.1).is_worse);
  // A server that does nothing any more gets no rates.
  EXPECT_TRUE(CompareReports(before, ReportOf({ClosedRun(0)}), 0.1).is_worse);
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

TEST(Usage, IsTheMeanFromTheFirstReadingToTheLastThatCame) {
  absl::StatusOr<Usage> reading = absl::NotFoundError("not yet");
  UsageWatch watch([&] { return reading; });
  const UsageWatch::TimePoint start;
  watch.Look(start);
  EXPECT_FALSE(watch.has_begun());
  EXPECT_FALSE(watch.cpus().has_value());
  reading = Usage{.cpu_seconds = 10, .memory_bytes = 5e6};
  watch.Look(start + std::chrono::seconds(1));
  EXPECT_TRUE(watch.has_begun());
  EXPECT_FALSE(watch.cpus().has_value());  // no time has gone by
  reading = Usage{.cpu_seconds = 11, .memory_bytes = 9e6};
  watch.Look(start + std::chrono::seconds(2));
  reading = Usage{.cpu_seconds = 12, .memory_bytes = 7e6};
  watch.Look(start + std::chrono::seconds(5));
  EXPECT_DOUBLE_EQ(watch.cpus().value(), 0.5);
  // What fails last takes nothing away.
  reading = absl::NotFoundError("gone");
  watch.Look(start + std::chrono::seconds(9));
  EXPECT_DOUBLE_EQ(watch.cpus().value(), 0.5);
  EXPECT_EQ(watch.memory_bytes(), 7e6);
  EXPECT_EQ(watch.memory_peak_bytes(), 9e6);
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
  (*report.mutable_settings())["mix"] = "tiles=4,trees=1";
  (*report.mutable_settings())["arrivals"] = "even";
  *report.add_runs() = OpenRun(50, 50);
  *report.mutable_sweep() = SummarizeSweep(report);
  const std::string html = HtmlReport(report);
  for (const char* part : {"<script", "http", "url(", "src=", "@import"}) {
    EXPECT_THAT(html, Not(HasSubstr(part)));
  }
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, HasSubstr("arrivals even · mix tiles=4,trees=1"));
}

TEST(Text, LatencyWithWhatWasLostIsShownWhenAnythingWas) {
  BenchRun run = OpenRun(50, 50);
  run.mutable_latency()->set_count(100);
  run.mutable_latency_with_lost()->set_count(100);
  EXPECT_THAT(RunText(run), Not(HasSubstr("with lost")));
  run.mutable_latency_with_lost()->set_count(101);
  run.mutable_latency_with_lost()->set_p99_ms(5'000);
  EXPECT_THAT(RunText(run), HasSubstr("with lost"));
  EXPECT_THAT(RunText(run), HasSubstr("p99 5.00 s"));
  EXPECT_THAT(HtmlReport(ReportOf({run})), HasSubstr("p99 with what was lost"));
}

TEST(Text, FairnessOfNothingIsNoNumber) {
  BenchRun run = OpenRun(50, 0);
  run.mutable_fairness()->add_clients();
  EXPECT_THAT(RunText(run), HasSubstr("none of 1 clients was served"));
  EXPECT_THAT(HtmlReport(ReportOf({run})), Not(HasSubstr("Jain")));
  run.mutable_fairness()->set_jain(0.5);
  EXPECT_THAT(RunText(run), HasSubstr("Jain index 0.5000"));
}

TEST(Text, TimesHaveThreeDigitsAndAUnit) {
  EXPECT_EQ(MillisecondsText(0.812), "812 us");
  EXPECT_EQ(MillisecondsText(1.234), "1.23 ms");
  EXPECT_EQ(MillisecondsText(456.7), "457 ms");
  EXPECT_EQ(MillisecondsText(2500), "2.50 s");
}

}  // namespace
}  // namespace terrane::client
