// LoadMeter: what happens during a load test, counted as it happens.
//
// A request is measured when it was due within the measured time, after the
// warm-up. Every figure but the time line is of those: each is offered once,
// and ends in exactly one of: a code, not started, unfinished. Latency runs
// from the moment a request was due, of calls that ended well; a refusal's own
// latency from the moment it was sent. What time ran out for is in a second
// histogram with them, so that a stall longer than the deadline shows, too.
//
// Threads: any.
#ifndef TERRANE_CLIENT_BENCH_METER_H_
#define TERRANE_CLIENT_BENCH_METER_H_

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "client/bench/latency_histogram.h"
#include "client/bench/load_call.h"
#include "client/bench/request_mix.h"

namespace terrane::client {

// When a load test begins and what of it is measured.
struct LoadTimes {
  LoadClock::time_point start;
  LoadClock::duration warm_up;
  LoadClock::duration duration;
  LoadClock::duration deadline;  // of each call

  LoadClock::time_point measured_from() const { return start + warm_up; }
  LoadClock::time_point measured_to() const {
    return measured_from() + duration;
  }
};

using CodeCounts = std::map<grpc::StatusCode, std::int64_t>;

// Of the calls of one kind or of one client.
struct ShareFigures {
  std::int64_t offered = 0;
  std::int64_t good = 0;
  LatencyHistogram latency;
};

// A stretch of the time line: what ended in it, measured or not.
struct LoadSlice {
  CodeCounts codes;
  std::int64_t not_started = 0;
  LatencyHistogram latency;
};

struct LoadFigures {
  std::int64_t offered = 0;
  std::int64_t started = 0;
  std::int64_t not_started = 0;  // no free slot when they were due
  std::int64_t unfinished = 0;   // cut at the end of the test
  std::int64_t retries = 0;
  std::int64_t good = 0;     // ended well, verified, within the deadline
  std::int64_t damaged = 0;  // DATA_LOSS, measured or not
  CodeCounts codes;
  std::int64_t tiles = 0;
  std::int64_t samples = 0;
  std::int64_t bytes = 0;
  LatencyHistogram latency;
  // And of those that expired, were not started or are unfinished.
  LatencyHistogram latency_with_lost;
  LatencyHistogram first_data;  // from due to the first data, of the same calls
  LatencyHistogram refusal;     // of RESOURCE_EXHAUSTED
  std::array<ShareFigures, kRequestKinds> kinds;
  std::vector<ShareFigures> clients;
  // The first message of each code that is not OK.
  std::map<grpc::StatusCode, std::string> examples;
  LoadClock::duration slice;
  std::vector<LoadSlice> time_line;  // from the start of the load
};

class LoadMeter {
 public:
  LoadMeter(const LoadTimes& times, int clients);

  const LoadTimes& times() const { return times_; }
  bool IsMeasured(LoadClock::time_point due) const {
    return due >= times_.measured_from() && due < times_.measured_to();
  }

  void Started(const PlannedRequest& plan, LoadClock::time_point due);
  void NotStarted(const PlannedRequest& plan, LoadClock::time_point due);
  void Retried(LoadClock::time_point due);
  // `sent` is when the call, or its last try, began.
  void Ended(const PlannedRequest& plan, LoadClock::time_point due,
             LoadClock::time_point sent, const CallResult& result);
  void Unfinished(LoadClock::time_point due);

  // Measured requests that have begun and not ended.
  std::int64_t open() const;
  LoadFigures figures() const;

  // What the line of progress shows: the last whole second.
  struct Recent {
    double good_per_second = 0;
    double others_per_second = 0;
    double p50_ns = 0;
    double p99_ns = 0;
  };
  Recent recent();

 private:
  LoadSlice* SliceAt(LoadClock::time_point time)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Begins a new second, if `now` lies in one.
  void RollSecond(LoadClock::time_point now)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CountOffer(const PlannedRequest& plan)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CountGood(const PlannedRequest& plan, LoadClock::duration latency,
                 const CallResult& result, LoadClock::time_point due)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const LoadTimes times_;
  mutable absl::Mutex mutex_;
  LoadFigures figures_ ABSL_GUARDED_BY(mutex_);
  std::int64_t open_ ABSL_GUARDED_BY(mutex_) = 0;
  std::int64_t second_ ABSL_GUARDED_BY(mutex_) = 0;  // since the start
  LoadSlice this_second_ ABSL_GUARDED_BY(mutex_);
  LoadSlice last_second_ ABSL_GUARDED_BY(mutex_);
};

// Jain's index of fairness: 1 when all have the same, 1/n when one has all;
// nothing when none has any.
std::optional<double> JainIndex(const std::vector<double>& shares);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_METER_H_
