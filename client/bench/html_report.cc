#include "client/bench/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "client/bench/svg_plot.h"
#include "client/bench/sweep.h"
#include "client/bench/text_report.h"
#include "client/progress.h"

namespace terrane::client {
namespace {

constexpr double kMib = 1 << 20;

constexpr char kStyle[] = R"(
:root{color-scheme:light dark;--page:#f6f7f4;--card:#fff;--ink:#1d2521;--soft:#66716b;
--line:#e0e4de;--s0:#1f7a5a;--s1:#d08a1d;--s2:#c2452d;--s3:#3d6fb4;--s4:#7d57a8;--s5:#8a938d}
@media(prefers-color-scheme:dark){:root{--page:#141816;--card:#1d2320;--ink:#e7ebe8;
--soft:#97a39c;--line:#303834;--s0:#4cc399;--s1:#e8b04f;--s2:#ee7b62;--s3:#7fabe6;
--s4:#b695e0;--s5:#87918b}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);
font:15px/1.5 system-ui,"DejaVu Sans",sans-serif}
main{max-width:1360px;margin:0 auto;padding:28px 24px 48px}
h1{font-size:24px;margin:0 0 4px}h2{font-size:17px;margin:32px 0 10px}
.about{color:var(--soft);margin:0 0 20px}
code{font:13px/1.5 "DejaVu Sans Mono",monospace;overflow-wrap:anywhere}
.numbers{display:grid;grid-template-columns:repeat(auto-fit,minmax(168px,1fr));gap:12px}
.number,figure,.table{background:var(--card);border:1px solid var(--line);border-radius:10px}
.number{padding:12px 16px}.number b{display:block;font-size:21px;line-height:1.3;white-space:nowrap;
font-variant-numeric:tabular-nums}.number span{color:var(--soft);font-size:13px}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(520px,100%),1fr));gap:16px;margin-top:16px}
figure{margin:0;padding:14px 16px 8px}
figcaption{display:flex;flex-wrap:wrap;justify-content:space-between;gap:2px 16px;margin-bottom:6px}
.legend{display:flex;flex-wrap:wrap;gap:2px 14px;color:var(--soft);font-size:13px}
.legend i{display:inline-block;width:16px;border-top:3px solid;margin-right:6px;vertical-align:middle}
.legend i.dashed{border-top-style:dashed;border-top-width:2px}
svg{display:block;width:100%;height:auto}
.grid{stroke:var(--line)}.axis{stroke:var(--soft)}
.tick,.label{fill:var(--soft);font-size:12px;font-family:inherit}
.line{fill:none;stroke:currentColor;stroke-width:2;stroke-linejoin:round}
.line.dashed{stroke-dasharray:5 4;stroke-width:1.5}.fill{fill:currentColor;opacity:.16}
.dot{fill:currentColor}
.s0{color:var(--s0)}.s1{color:var(--s1)}.s2{color:var(--s2)}.s3{color:var(--s3)}
.s4{color:var(--s4)}.s5{color:var(--s5)}
.table{overflow-x:auto;padding:4px 8px}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:6px 10px;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}
tr:last-child td{border-bottom:0}th{color:var(--soft);font-weight:600;font-size:13px}
th:first-child,td:first-child,td.text{text-align:left}td.text{white-space:normal;color:var(--soft)}
)";

// The colour of a code's line: green for what went well, ochre for refusals,
// red for calls that were late, blue for a server that is not there, violet for
// damage, grey for the others.
PlotColor ColorOf(const std::string& code) {
  static const std::map<std::string, PlotColor> colours = {
      {"OK", PlotColor::kGreen},
      {"RESOURCE_EXHAUSTED", PlotColor::kOchre},
      {"DEADLINE_EXCEEDED", PlotColor::kRed},
      {"UNAVAILABLE", PlotColor::kBlue},
      {"DATA_LOSS", PlotColor::kViolet}};
  const auto found = colours.find(code);
  return found == colours.end() ? PlotColor::kGrey : found->second;
}

// Of an axis: powers of ten and round numbers.
std::string TickText(double ms) {
  if (ms >= 1000) return fmt::format("{:.4g} s", ms / 1000);
  if (ms >= 1) return fmt::format("{:.4g} ms", ms);
  return fmt::format("{:.4g} us", ms * 1000);
}

// The time line of a run, to its end.
PlotAxis TimeAxis(const TimeLine& line) {
  PlotAxis axis{.label = "seconds since the start of the load"};
  if (line.points_size() > 0) {
    axis.range = {0.0, line.points_size() * line.seconds()};
  }
  return axis;
}

std::string NumberHtml(const std::string& value, const std::string& what) {
  return fmt::format("<div class=\"number\"><b>{}</b><span>{}</span></div>",
                     EscapeHtml(value), EscapeHtml(what));
}

// Whether time ran out for some requests.
bool HasLost(const BenchRun& run) {
  return run.latency_with_lost().count() > run.latency().count();
}

std::string NumbersHtml(const BenchRun& run) {
  std::string html = "<div class=\"numbers\">";
  html +=
      NumberHtml(fmt::format("{:.4g}/s", run.goodput_per_second()), "goodput");
  html +=
      NumberHtml(fmt::format("{:.4g}/s", run.offered_per_second()), "offered");
  if (run.has_latency()) {
    html += NumberHtml(MillisecondsText(run.latency().p50_ms()), "p50 latency");
    html += NumberHtml(MillisecondsText(run.latency().p99_ms()), "p99 latency");
  }
  if (HasLost(run)) {
    html += NumberHtml(MillisecondsText(run.latency_with_lost().p99_ms()),
                       "p99 with what was lost");
  }
  if (run.has_first_data()) {
    html += NumberHtml(MillisecondsText(run.first_data().p50_ms()),
                       "p50 to first data");
  }
  if (run.has_refusal()) {
    html +=
        NumberHtml(MillisecondsText(run.refusal().p50_ms()), "p50 of refusals");
  }
  html += NumberHtml(ShortNumber(run.samples_per_second()) + "/s", "samples");
  html += NumberHtml(fmt::format("{:.1f} MiB/s", run.bytes_per_second() / kMib),
                     "data");
  if (run.fairness().has_jain()) {
    html += NumberHtml(fmt::format("{:.3f}", run.fairness().jain()),
                       "Jain's index of fairness");
  }
  for (const auto& [has, usage, name] :
       {std::tuple(run.has_server(), &run.server(), "server"),
        std::tuple(run.has_client(), &run.client(), "load tester")}) {
    if (!has) continue;
    html += NumberHtml(
        fmt::format("{:.2f} CPUs", usage->cpus()),
        fmt::format("{}, {:.0f} MiB", name, usage->memory_peak_bytes() / kMib));
  }
  return html + "</div>\n";
}

// Latency over the share of requests, each nine as wide as the one before.
Plot LatencyCurve(const BenchRun& run) {
  Plot plot{.title = "Latency by share of requests"};
  plot.x = {.label = "share of requests that took no longer",
            .logarithmic = true};
  plot.y = {.label = "latency", .logarithmic = true, .text = TickText};
  double most = 1;
  const auto add = [&](const char* name, PlotColor color,
                       const LatencySummary& latency) {
    PlotSeries series{.name = name, .color = color};
    for (const CurvePoint& point : latency.curve()) {
      if (point.share() >= 1) continue;  // lies infinitely far to the right
      const double nines = 1 / (1 - point.share());
      most = std::max(most, nines);
      series.points.emplace_back(nines, point.ms());
    }
    plot.series.push_back(series);
  };
  if (run.has_refusal()) add("refusals", PlotColor::kOchre, run.refusal());
  if (run.has_first_data()) {
    add("first data", PlotColor::kBlue, run.first_data());
  }
  if (HasLost(run)) {
    add("whole answer, with lost", PlotColor::kRed, run.latency_with_lost());
  }
  if (run.has_latency()) add("whole answer", PlotColor::kGreen, run.latency());
  plot.x.range = {1.0, std::max(most, 10.0)};
  for (const auto& [nines, text] :
       {std::pair(1.0, "0"), std::pair(2.0, "50 %"), std::pair(10.0, "90 %"),
        std::pair(100.0, "99 %"), std::pair(1000.0, "99.9 %"),
        std::pair(10000.0, "99.99 %"), std::pair(100000.0, "99.999 %")}) {
    if (nines <= plot.x.range->second * 1.001) {
      plot.x.ticks.emplace_back(nines, text);
    }
  }
  return plot;
}

Plot CodesOverTime(const BenchRun& run) {
  Plot plot{.title = "Requests by outcome"};
  plot.x = TimeAxis(run.time_line());
  plot.y = {.label = "requests/s"};
  const TimeLine& line = run.time_line();
  std::map<std::string, PlotSeries> by_code;
  PlotSeries not_started{
      .name = "not started", .color = PlotColor::kGrey, .dashed = true};
  double lost = 0;
  for (int i = 0; i < line.points_size(); ++i) {
    for (const CodeCount& code : line.points(i).codes()) {
      PlotSeries& series = by_code[code.code()];
      series.name = code.code();
      series.color = ColorOf(code.code());
      series.filled = code.code() == "OK";
    }
    not_started.points.emplace_back((i + 0.5) * line.seconds(),
                                    line.points(i).not_started());
    lost += line.points(i).not_started();
  }
  for (auto& [name, series] : by_code) {
    for (int i = 0; i < line.points_size(); ++i) {
      double rate = 0;
      for (const CodeCount& code : line.points(i).codes()) {
        if (code.code() == name) rate = code.count();
      }
      series.points.emplace_back((i + 0.5) * line.seconds(), rate);
    }
    plot.series.push_back(series);
  }
  if (lost > 0) plot.series.push_back(not_started);
  return plot;
}

Plot LatencyOverTime(const BenchRun& run) {
  Plot plot{.title = "Latency over time"};
  plot.x = TimeAxis(run.time_line());
  plot.y = {.label = "latency", .logarithmic = true, .text = TickText};
  PlotSeries p50{.name = "p50", .color = PlotColor::kGreen};
  PlotSeries p99{.name = "p99", .color = PlotColor::kOchre};
  const TimeLine& line = run.time_line();
  for (int i = 0; i < line.points_size(); ++i) {
    const double seconds = (i + 0.5) * line.seconds();
    p50.points.emplace_back(seconds, line.points(i).p50_ms());
    p99.points.emplace_back(seconds, line.points(i).p99_ms());
  }
  plot.series = {p99, p50};
  return plot;
}

std::string CodesTable(const BenchRun& run) {
  std::string html =
      "<div class=\"table\"><table><tr><th>outcome</th><th>requests</th>"
      "<th>share</th><th></th></tr>";
  const auto row = [&](const std::string& name, double count,
                       const std::string& example) {
    html += fmt::format(
        "<tr><td>{}</td><td>{:.0f}</td><td>{:.2f} %</td>"
        "<td class=\"text\">{}</td></tr>",
        EscapeHtml(name), count,
        run.offered() > 0 ? 100 * count / run.offered() : 0,
        EscapeHtml(example));
  };
  for (const CodeCount& code : run.codes()) {
    row(code.code(), code.count(), code.example());
  }
  if (run.not_started() > 0) {
    row("not started", run.not_started(), "too many were in flight");
  }
  if (run.unfinished() > 0) {
    row("unfinished", run.unfinished(), "cut at the end of the test");
  }
  return html + "</table></div>\n";
}

std::string KindsTable(const BenchRun& run) {
  if (run.kinds_size() < 2) return "";
  std::string html =
      "<div class=\"table\" style=\"margin-top:12px\"><table><tr><th>kind</th>"
      "<th>offered</th><th>good</th><th>p50</th><th>p99</th></tr>";
  for (const KindSummary& kind : run.kinds()) {
    html += fmt::format(
        "<tr><td>{}</td><td>{:.0f}</td><td>{:.0f}</td><td>{}</td><td>{}</td>"
        "</tr>",
        EscapeHtml(kind.kind()), kind.offered(), kind.good(),
        MillisecondsText(kind.p50_ms()), MillisecondsText(kind.p99_ms()));
  }
  return html + "</table></div>\n";
}

std::string RunHtml(const BenchRun& run) {
  std::string html =
      fmt::format("<h2>{}, {:.0f} connections, {:.3g} s</h2>\n",
                  EscapeHtml(LoopText(run)), run.connections(), run.seconds());
  html += NumbersHtml(run) + "<div class=\"plots\">";
  html += PlotHtml(CodesOverTime(run)) + PlotHtml(LatencyOverTime(run)) +
          PlotHtml(LatencyCurve(run)) + "<div>" + CodesTable(run) +
          KindsTable(run);
  return html + "</div></div>\n";
}

std::string SweepPlots(const BenchReport& report) {
  Plot goodput{.title = "Goodput by offered load"};
  goodput.x = {.label = "offered requests/s"};
  goodput.y = {.label = "requests/s"};
  Plot latency{.title = "Latency by offered load"};
  latency.x = {.label = "offered requests/s"};
  latency.y = {.label = "latency", .logarithmic = true, .text = TickText};
  PlotSeries good{.name = "goodput",
                  .color = PlotColor::kGreen,
                  .filled = true,
                  .has_dots = true};
  PlotSeries ideal{
      .name = "all that is offered", .color = PlotColor::kGrey, .dashed = true};
  PlotSeries p50{.name = "p50", .color = PlotColor::kGreen, .has_dots = true};
  PlotSeries p99{.name = "p99", .color = PlotColor::kOchre, .has_dots = true};
  PlotSeries refusal{
      .name = "p50 of refusals", .color = PlotColor::kBlue, .has_dots = true};
  const double peak = report.sweep().peak_goodput();
  ideal.points = {{0, 0}, {1.15 * peak, 1.15 * peak}};
  for (const BenchRun* rung : RungsOf(report)) {
    const BenchRun& run = *rung;
    const double x = run.offered_per_second();
    good.points.emplace_back(x, run.goodput_per_second());
    p50.points.emplace_back(x, run.latency().p50_ms());
    p99.points.emplace_back(x, run.latency().p99_ms());
    refusal.points.emplace_back(x, run.refusal().p50_ms());
  }
  goodput.series = {ideal, good};
  latency.series = {refusal, p99, p50};
  return "<div class=\"plots\">" + PlotHtml(goodput) + PlotHtml(latency) +
         "</div>\n";
}

std::string SweepHtml(const BenchReport& report) {
  const BenchSweep& sweep = report.sweep();
  std::string html = "<h2>Sweep</h2><div class=\"numbers\">";
  if (sweep.capacity() > 0) {
    html += NumberHtml(fmt::format("{:.4g}/s", sweep.capacity()),
                       "capacity in a closed loop");
  }
  html += NumberHtml(sweep.knee() > 0 ? fmt::format("{:.4g}/s", sweep.knee())
                                      : "below the sweep",
                     "knee: 95 % of what is offered is good");
  if (sweep.beyond_knee() > 0) {
    html += NumberHtml(fmt::format("{:.4g}/s", sweep.beyond_knee()),
                       "beyond the knee");
  }
  html +=
      NumberHtml(fmt::format("{:.4g}/s", sweep.peak_goodput()), "peak goodput");
  html += NumberHtml(fmt::format("{:.0f} %", sweep.peak_goodput() > 0
                                                 ? 100 * sweep.last_goodput() /
                                                       sweep.peak_goodput()
                                                 : 0),
                     "of the peak at the highest rate");
  return html + "</div>\n" + SweepPlots(report);
}

// All that shapes the load, in the order of the names.
std::string SettingsText(const BenchReport& report) {
  const std::map<std::string, std::string> settings(report.settings().begin(),
                                                    report.settings().end());
  std::string text;
  for (const auto& [name, value] : settings) {
    if (!text.empty()) text += " · ";
    text += fmt::format("{} {}", name, value);
  }
  return text;
}

}  // namespace

std::string HtmlReport(const BenchReport& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">"
      "<title>terrane bench {0}</title><style>{1}</style></head><body><main>\n"
      "<h1>terrane bench</h1><p class=\"about\">{2} · {0} · terrane {3}{4}<br>"
      "<code>{5}</code></p>\n",
      EscapeHtml(report.started()), kStyle, EscapeHtml(report.server()),
      EscapeHtml(report.version()),
      report.interrupted() ? " · stopped before its end" : "",
      EscapeHtml(SettingsText(report)));
  if (report.has_sweep()) html += SweepHtml(report);
  for (const BenchRun& run : report.runs()) html += RunHtml(run);
  return html + "</main></body></html>\n";
}

}  // namespace terrane::client
