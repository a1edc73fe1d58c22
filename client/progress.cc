#include "client/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace terrane::client {
namespace {

constexpr int kBarWidth = 32;
constexpr std::chrono::milliseconds kBarInterval{100};
constexpr std::chrono::milliseconds kJsonInterval{1000};

void Print(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

Progress::Progress(ProgressMode mode, std::int64_t total_samples)
    : form_(mode == ProgressMode::kJson ? Form::kJson
            : mode == ProgressMode::kAuto && isatty(STDERR_FILENO) != 0
                ? Form::kBar
                : Form::kNothing),
      total_(std::max<std::int64_t>(total_samples, 1)) {}

Progress::~Progress() {
  if (form_ == Form::kBar) Print("\r\033[K");
}

void Progress::Advance(std::int64_t samples) {
  done_ += samples;
  if (form_ == Form::kNothing) return;
  const Clock::time_point now = Clock::now();
  const auto interval = form_ == Form::kBar ? kBarInterval : kJsonInterval;
  if (done_ < total_ && now - shown_ < interval) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (form_ == Form::kBar) {
    DrawBar(seconds);
  } else {
    PrintJson(seconds);
  }
}

void Progress::DrawBar(double seconds) const {
  const double share =
      std::min(static_cast<double>(done_) / static_cast<double>(total_), 1.0);
  const auto full = static_cast<std::size_t>(share * kBarWidth);
  const double rate = seconds > 0 ? static_cast<double>(done_) / seconds : 0;
  const double left = rate > 0 ? static_cast<double>(total_ - done_) / rate : 0;
  Print(fmt::format("\r\033[K[{}{}] {:3.0f} %  {}samples/s  {} left",
                    std::string(full, '='), std::string(kBarWidth - full, ' '),
                    share * 100, ShortNumber(rate), ClockText(left)));
}

void Progress::PrintJson(double seconds) const {
  Print(fmt::format("{{\"samples\":{},\"total\":{},\"seconds\":{:.3f}}}\n",
                    done_, total_, seconds));
}

std::string ShortNumber(double value) {
  constexpr std::array<const char*, 5> kUnits = {"", "k", "M", "G", "T"};
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < kUnits.size()) {
    value /= 1000;
    ++unit;
  }
  const int digits = unit == 0 || value >= 99.95 ? 0 : 1;
  return fmt::format("{:.{}f} {}", value, digits, kUnits[unit]);
}

std::string ClockText(double seconds) {
  const auto whole = static_cast<std::int64_t>(seconds + 0.5);
  if (whole >= 3600) {
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60,
                       whole % 60);
  }
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace terrane::client
