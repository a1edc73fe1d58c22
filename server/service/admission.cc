#include "server/service/admission.h"

#include <algorithm>
#include <cstdio>

#include "server/service/status.h"

namespace terrane::server {
namespace {

using Seconds = std::chrono::duration<double>;

// Calls that cost more than this are batch work.
constexpr double kMostInteractiveSeconds = 1;
// Of the time left, what the work may fill: the rest is for the way back, and
// for clients that come later and take their share.
constexpr double kFill = 0.8;
// Bounds of what a refused call is told to wait.
constexpr Seconds kLeastWait{0.1};
constexpr Seconds kMostWait{30};

absl::Status Refusal(Seconds expected, Seconds allowed) {
  char text[128];
  std::snprintf(text, sizeof text,
                "the server is busy: expected to take %.2f s, allowed are "
                "%.2f s; try again later",
                expected.count(), std::max(allowed.count(), 0.0));
  const Seconds wait = std::clamp(expected - allowed, kLeastWait, kMostWait);
  return RetryLaterError(
      text, std::chrono::duration_cast<std::chrono::milliseconds>(wait));
}

}  // namespace

WorkClass Admission::ClassOf(double seconds) {
  return seconds > kMostInteractiveSeconds ? WorkClass::kBatch
                                           : WorkClass::kInteractive;
}

absl::Status Admission::Admit(const Work& work, TimeLeft left) const {
  if (left.has_value()) {
    const Seconds expected(workers_->ExpectedSeconds(work));
    const Seconds allowed = *left * kFill;
    return expected <= allowed ? absl::OkStatus() : Refusal(expected, allowed);
  }
  Work first = work;
  first.seconds = 0;
  const Seconds expected(workers_->ExpectedSeconds(first));
  return expected <= patience_ ? absl::OkStatus()
                               : Refusal(expected, patience_);
}

}  // namespace terrane::server
