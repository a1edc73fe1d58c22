#include "client/bench/load.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "client/bench/random_number.h"
#include "client/patience.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;
using TimePoint = LoadClock::time_point;

constexpr milliseconds kTick{100};
// What is still open so long after its deadline is cut.
constexpr std::chrono::seconds kGrace{1};
// No request has more tries.
constexpr std::int64_t kMostTries = 128;
// Of a caller that found no server, before it asks again.
constexpr milliseconds kPause{100};

bool WorthAnotherTry(const CallResult& result) {
  return result.code == grpc::StatusCode::UNAVAILABLE ||
         (result.code == grpc::StatusCode::RESOURCE_EXHAUSTED &&
          result.retry_delay.has_value());
}

// A request from the moment it is due until its last try has ended.
struct OpenRequest {
  PlannedRequest plan;
  TimePoint due;
  TimePoint sent;
  int tries = 0;
  std::shared_ptr<LoadCall> call;  // of the last try; null before the first
};

// One load. The thread of Run starts what is due by the clock; in a closed loop
// the threads in which calls end start the next ones. Those threads share it,
// so that it lives until the last one has left it. No call is started or
// cancelled under the lock: its result might come at once.
class Load : public std::enable_shared_from_this<Load> {
 public:
  Load(const LoadOptions& options, const RequestMix& mix, CallMaker* calls,
       LoadMeter* meter)
      : options_(options),
        mix_(mix),
        calls_(calls),
        meter_(meter),
        arrivals_(options.rate > 0 ? options.rate : 1, options.arrivals,
                  mix.options().seed) {}

  LoadEnd Run(const OnTick& on_tick, std::stop_token stop);

 private:
  bool is_open_loop() const { return options_.rate > 0; }
  int in_flight() const;
  TimePoint At(double seconds) const;
  TimePoint RetryAt(const OpenRequest& request, const CallResult& result) const;
  // Whether the load is to go on after a tick.
  bool GoesOn(const std::stop_token& stop) const;
  TimePoint NextEvent(TimePoint tick) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::int64_t TakeNumber();

  void StartArrivals();
  void StartRetries();
  // Callers of a closed loop whose pause is over ask again.
  void StartPaused();
  void StartNew(TimePoint due);
  // Sends a request's next try.
  void Send(std::int64_t number);
  void OnResult(std::int64_t number, const CallResult& result);
  // Puts the request among those that wait, if another try is worth it.
  bool WaitForRetry(std::int64_t number, const CallResult& result)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CutWhatIsOpen();

  const LoadOptions options_;
  const RequestMix mix_;
  CallMaker* const calls_;
  LoadMeter* const meter_;
  Arrivals arrivals_;  // of the thread of Run

  mutable absl::Mutex mutex_;
  absl::CondVar changed_;  // something waits, or the last call is gone
  std::int64_t next_number_ ABSL_GUARDED_BY(mutex_) = 0;
  std::map<std::int64_t, OpenRequest> open_ ABSL_GUARDED_BY(mutex_);
  std::multimap<TimePoint, std::int64_t> retries_ ABSL_GUARDED_BY(mutex_);
  // When callers that found no server ask again.
  std::multiset<TimePoint> pauses_ ABSL_GUARDED_BY(mutex_);
  bool ending_ ABSL_GUARDED_BY(mutex_) = false;
};

LoadEnd Load::Run(const OnTick& on_tick, std::stop_token stop) {
  if (!is_open_loop()) {
    for (int i = 0; i < options_.concurrency; ++i) StartNew(LoadClock::now());
  }
  TimePoint tick = LoadClock::now() + kTick;
  while (GoesOn(stop)) {
    if (is_open_loop()) StartArrivals();
    StartRetries();
    StartPaused();
    if (LoadClock::now() >= tick) {
      on_tick(in_flight());
      tick = LoadClock::now() + kTick;
    }
    // What comes to wait before the lock is seen in NextEvent, what comes after
    // it signals.
    const absl::MutexLock lock(&mutex_);
    changed_.WaitWithTimeout(
        &mutex_, absl::FromChrono(NextEvent(tick) - LoadClock::now()));
  }
  const bool stopped = stop.stop_requested();
  CutWhatIsOpen();
  on_tick(0);
  return stopped ? LoadEnd::kStopped : LoadEnd::kComplete;
}

int Load::in_flight() const {
  const absl::MutexLock lock(&mutex_);
  return static_cast<int>(open_.size());
}

TimePoint Load::At(double seconds) const {
  return meter_->times().start +
         std::chrono::duration_cast<LoadClock::duration>(
             std::chrono::duration<double>(seconds));
}

bool Load::GoesOn(const std::stop_token& stop) const {
  if (stop.stop_requested()) return false;
  const LoadTimes& times = meter_->times();
  const TimePoint now = LoadClock::now();
  if (now < times.measured_to()) return true;
  return meter_->open() > 0 &&
         now < times.measured_to() + times.deadline + kGrace;
}

TimePoint Load::NextEvent(TimePoint tick) const {
  TimePoint next = tick;
  if (is_open_loop()) next = std::min(next, At(arrivals_.next()));
  if (!retries_.empty()) next = std::min(next, retries_.begin()->first);
  if (!pauses_.empty()) next = std::min(next, *pauses_.begin());
  return next;
}

std::int64_t Load::TakeNumber() {
  const absl::MutexLock lock(&mutex_);
  return next_number_++;
}

void Load::StartArrivals() {
  const std::chrono::duration<double> now =
      LoadClock::now() - meter_->times().start;
  const DueRequests due =
      TakeDue(now.count(), options_.max_in_flight - in_flight(), &arrivals_);
  for (const double seconds : due.start) StartNew(At(seconds));
  for (const double seconds : due.not_started) {
    meter_->NotStarted(mix_.At(TakeNumber()), At(seconds));
  }
}

void Load::StartRetries() {
  std::vector<std::int64_t> due;
  {
    const absl::MutexLock lock(&mutex_);
    const auto end = retries_.upper_bound(LoadClock::now());
    for (auto retry = retries_.begin(); retry != end; ++retry) {
      due.push_back(retry->second);
    }
    retries_.erase(retries_.begin(), end);
  }
  for (const std::int64_t number : due) Send(number);
}

void Load::StartPaused() {
  std::vector<TimePoint> due;
  {
    const absl::MutexLock lock(&mutex_);
    const auto end = pauses_.upper_bound(LoadClock::now());
    due.assign(pauses_.begin(), end);
    pauses_.erase(pauses_.begin(), end);
  }
  for (const TimePoint at : due) StartNew(at);
}

void Load::StartNew(TimePoint due) {
  const std::int64_t number = TakeNumber();
  OpenRequest request;
  request.plan = mix_.At(number);
  request.due = due;
  {
    const absl::MutexLock lock(&mutex_);
    if (ending_) return;
    meter_->Started(request.plan, due);
    open_.emplace(number, std::move(request));
  }
  Send(number);
}

void Load::Send(std::int64_t number) {
  std::shared_ptr<LoadCall> call;
  {
    const absl::MutexLock lock(&mutex_);
    const auto found = open_.find(number);
    if (found == open_.end()) return;  // the end of the test took it
    OpenRequest& request = found->second;
    if (ending_) {
      meter_->Unfinished(request.due);
      open_.erase(found);
      changed_.Signal();
      return;
    }
    call = calls_->Make(
        request.plan, request.due + meter_->times().deadline,
        [self = shared_from_this(), number](const CallResult& result) {
          self->OnResult(number, result);
        });
    ++request.tries;
    request.call = call;
    request.sent = LoadClock::now();
  }
  call->Start();
}

void Load::OnResult(std::int64_t number, const CallResult& result) {
  OpenRequest request;  // goes, and the call with it, after the lock
  {
    const absl::MutexLock lock(&mutex_);
    if (WaitForRetry(number, result)) return;
    request = std::move(open_.extract(number).mapped());
    if (ending_) {
      meter_->Unfinished(request.due);
      changed_.Signal();
      return;
    }
    meter_->Ended(request.plan, request.due, request.sent, result);
    if (!is_open_loop() && result.code == grpc::StatusCode::UNAVAILABLE) {
      pauses_.insert(LoadClock::now() + kPause);
      changed_.Signal();
      return;
    }
  }
  if (!is_open_loop()) StartNew(LoadClock::now());
}

TimePoint Load::RetryAt(const OpenRequest& request,
                        const CallResult& result) const {
  const std::int64_t position =
      request.plan.number * kMostTries + request.tries;
  return LoadClock::now() +
         WaitBeforeNextTry(
             request.tries, result.retry_delay,
             RandomShare(mix_.options().seed, RandomStream::kRetry, position));
}

bool Load::WaitForRetry(std::int64_t number, const CallResult& result) {
  const OpenRequest& request = open_.at(number);
  if (ending_ || request.tries > options_.retries || !WorthAnotherTry(result)) {
    return false;
  }
  const TimePoint at = RetryAt(request, result);
  if (at >= request.due + meter_->times().deadline) return false;
  meter_->Retried(request.due);
  retries_.emplace(at, number);
  changed_.Signal();
  return true;
}

void Load::CutWhatIsOpen() {
  std::vector<std::shared_ptr<LoadCall>> calls;
  {
    const absl::MutexLock lock(&mutex_);
    ending_ = true;
    for (const auto& [at, number] : retries_) {
      meter_->Unfinished(open_.at(number).due);
      open_.erase(number);
    }
    retries_.clear();
    for (const auto& [number, request] : open_) {
      if (request.call != nullptr) calls.push_back(request.call);
    }
  }
  // One that is about to start ends at once then.
  for (const auto& call : calls) call->Cancel();
  const absl::MutexLock lock(&mutex_);
  while (!open_.empty()) changed_.Wait(&mutex_);
}

}  // namespace

LoadEnd RunLoad(const LoadOptions& options, const RequestMix& mix,
                CallMaker* calls, LoadMeter* meter, const OnTick& on_tick,
                std::stop_token stop) {
  return std::make_shared<Load>(options, mix, calls, meter)
      ->Run(on_tick, std::move(stop));
}

}  // namespace terrane::client
