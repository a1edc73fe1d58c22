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

ProgressLine::ProgressLine(ProgressMode mode)
    : form_(mode == ProgressMode::kJson ? Form::kJson
            : mode == ProgressMode::kAuto && isatty(STDERR_FILENO) != 0
                ? Form::kBar
                : Form::kNothing) {}

ProgressLine::~ProgressLine() {
  if (form_ == Form::kBar) Print("\r\033[K");
}

bool ProgressLine::IsDue(bool last) {
  if (form_ == Form::kNothing) return false;
  const Clock::time_point now = Clock::now();
  const auto interval = form_ == Form::kBar ? kBarInterval : kJsonInterval;
  if (!last && now - shown_ < interval) return false;
  shown_ = now;
  return true;
}

double ProgressLine::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void ProgressLine::DrawBar(double share, const std::string& what) const {
  share = std::clamp(share, 0.0, 1.0);
  const auto full = static_cast<std::size_t>(share * kBarWidth);
  Print(fmt::format("\r\033[K[{}{}] {:3.0f} %  {}", std::string(full, '='),
                    std::string(kBarWidth - full, ' '), share * 100, what));
}

void ProgressLine::PrintJson(const std::string& object) const {
  Print(object + '\n');
}

Progress::Progress(ProgressMode mode, std::int64_t total, std::string unit)
    : ProgressLine(mode),
      unit_(std::move(unit)),
      total_(std::max<std::int64_t>(total, 1)) {}

void Progress::Advance(std::int64_t units) {
  done_ += units;
  if (!IsDue(done_ >= total_)) return;
  if (form() == Form::kJson) {
    PrintJson(fmt::format("{{\"{}\":{},\"total\":{},\"seconds\":{:.3f}}}",
                          unit_, done_, total_, seconds()));
    return;
  }
  const double rate =
      seconds() > 0 ? static_cast<double>(done_) / seconds() : 0;
  const double left = rate > 0 ? static_cast<double>(total_ - done_) / rate : 0;
  DrawBar(static_cast<double>(done_) / static_cast<double>(total_),
          fmt::format("{}{}/s  {} left", ShortNumber(rate), unit_,
                      ClockText(left)));
}

void ShareProgress::Show(double fraction) {
  if (!IsDue(fraction >= 1)) return;
  if (form() == Form::kJson) {
    PrintJson(fmt::format("{{\"{}\":{:.3f},\"seconds\":{:.3f}}}", key_,
                          fraction, seconds()));
    return;
  }
  const double left = fraction > 0 ? seconds() * (1 - fraction) / fraction : 0;
  DrawBar(fraction, fmt::format("{}  {} left", what_, ClockText(left)));
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
