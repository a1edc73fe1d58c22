#include "server/service/admission.h"

#include <algorithm>
#include <cstdio>

#include "server/service/status.h"

namespace terrane::server {
namespace {

using Seconds = Admission::Seconds;

// Of the time left, what the work may fill: the rest is for the way back, and
// for clients that come later and take their share.
constexpr double kFill = 0.8;
// By how much a price may be too high.
constexpr double kDoubt = 4;
// Waits of less say nothing about the next one.
constexpr double kLeastWaitSeconds = 0.02;
// Weight of the newest stream in the slip. More of one that took longer: what
// comes too late was work for nothing, what is refused may ask again.
constexpr double kSlowerWeight = 1.0 / 16;
constexpr double kFasterWeight = 1.0 / 128;
// Bounds of the slip.
constexpr double kLeastSlip = 0.5;
constexpr double kMostSlip = 4;
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

Admission::Seconds Admission::Corrected(const Expectation& expected) const {
  std::lock_guard lock(mutex_);
  return Seconds(expected.work + expected.wait * slip_);
}

void Admission::Learn(const Expectation& expected, double actual_seconds,
                      bool cut_short) {
  if (expected.wait < kLeastWaitSeconds) return;
  const double slip = std::clamp(
      (actual_seconds - expected.work) / expected.wait, kLeastSlip, kMostSlip);
  std::lock_guard lock(mutex_);
  if (cut_short && slip < slip_) return;
  slip_ += (slip > slip_ ? kSlowerWeight : kFasterWeight) * (slip - slip_);
}

absl::StatusOr<Expectation> Admission::Admit(const Work& work,
                                             TimeLeft left) const {
  const Expectation expected = workers_->Expect(work);
  if (!left.has_value()) {
    Work first = work;
    first.seconds = 0;  // until its first message
    const Seconds wait = Corrected(workers_->Expect(first));
    if (wait <= patience_) return expected;
    return Refusal(wait, patience_);
  }
  const Seconds end = Corrected(expected);
  const Seconds allowed = *left * kFill;
  const double doubt = expected.wait == 0 ? kDoubt : 1;
  if (end <= allowed * doubt) return expected;
  return Refusal(end, allowed);
}

}  // namespace terrane::server
