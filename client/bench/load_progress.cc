#include "client/bench/load_progress.h"

#include <fmt/format.h>

#include "client/bench/text_report.h"

namespace terrane::client {
namespace {

constexpr double kNsOfMs = 1e6;

}  // namespace

void LoadProgress::Show(int in_flight, LoadMeter* meter) {
  if (!IsDue(false)) return;
  const LoadTimes& times = meter->times();
  const LoadMeter::Recent recent = meter->recent();
  const std::chrono::duration<double> done = LoadClock::now() - times.start;
  const std::chrono::duration<double> all = times.warm_up + times.duration;
  if (form() == Form::kJson) {
    PrintJson(fmt::format(
        R"({{"seconds":{:.1f},"of":{:.1f},"ok_per_second":{:.1f},)"
        R"("others_per_second":{:.1f},"p50_ms":{:.3f},"p99_ms":{:.3f},)"
        R"("in_flight":{}}})",
        done.count(), all.count(), recent.good_per_second,
        recent.others_per_second, recent.p50_ns / kNsOfMs,
        recent.p99_ns / kNsOfMs, in_flight));
    return;
  }
  DrawBar(done.count() / all.count(),
          fmt::format("{}: {:.0f}/s ok, {:.0f}/s others, p50 {}, p99 {}, {} in "
                      "flight",
                      what_, recent.good_per_second, recent.others_per_second,
                      MillisecondsText(recent.p50_ns / kNsOfMs),
                      MillisecondsText(recent.p99_ns / kNsOfMs), in_flight));
}

}  // namespace terrane::client
