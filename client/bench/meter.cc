#include "client/bench/meter.h"

#include <algorithm>
#include <utility>

namespace terrane::client {
namespace {

// Points of the time line, about; each at least as long as progress is shown.
constexpr int kSlices = 60;
constexpr std::chrono::milliseconds kShortestSlice{100};

}  // namespace

LoadMeter::LoadMeter(const LoadTimes& times, int clients) : times_(times) {
  figures_.clients.resize(static_cast<std::size_t>(clients));
  figures_.slice = std::max<LoadClock::duration>(
      (times.warm_up + times.duration) / kSlices, kShortestSlice);
}

void LoadMeter::Started(const PlannedRequest& plan, LoadClock::time_point due) {
  if (!IsMeasured(due)) return;
  const absl::MutexLock lock(&mutex_);
  CountOffer(plan);
  ++figures_.started;
  ++open_;
}

void LoadMeter::NotStarted(const PlannedRequest& plan,
                           LoadClock::time_point due) {
  const absl::MutexLock lock(&mutex_);
  ++SliceAt(due)->not_started;
  if (!IsMeasured(due)) return;
  CountOffer(plan);
  ++figures_.not_started;
  figures_.latency_with_lost.Record(times_.deadline);
}

void LoadMeter::Retried(LoadClock::time_point due) {
  if (!IsMeasured(due)) return;
  const absl::MutexLock lock(&mutex_);
  ++figures_.retries;
}

void LoadMeter::Ended(const PlannedRequest& plan, LoadClock::time_point due,
                      LoadClock::time_point sent, const CallResult& result) {
  const bool ok = result.code == grpc::StatusCode::OK;
  const LoadClock::duration latency = result.end - due;
  const absl::MutexLock lock(&mutex_);
  RollSecond(result.end);
  for (LoadSlice* slice : {SliceAt(result.end), &this_second_}) {
    ++slice->codes[result.code];
    if (ok) slice->latency.Record(latency);
  }
  if (result.code == grpc::StatusCode::DATA_LOSS) ++figures_.damaged;
  if (!IsMeasured(due)) return;
  --open_;
  ++figures_.codes[result.code];
  if (ok) {
    CountGood(plan, latency, result, due);
    return;
  }
  if (result.code == grpc::StatusCode::RESOURCE_EXHAUSTED) {
    figures_.refusal.Record(result.end - sent);
  } else if (result.code == grpc::StatusCode::DEADLINE_EXCEEDED) {
    figures_.latency_with_lost.Record(std::max(latency, times_.deadline));
  }
  figures_.examples.emplace(result.code, result.message);
}

void LoadMeter::Unfinished(LoadClock::time_point due) {
  if (!IsMeasured(due)) return;
  const absl::MutexLock lock(&mutex_);
  ++figures_.unfinished;
  figures_.latency_with_lost.Record(LoadClock::now() - due);
  --open_;
}

std::int64_t LoadMeter::open() const {
  const absl::MutexLock lock(&mutex_);
  return open_;
}

LoadFigures LoadMeter::figures() const {
  const absl::MutexLock lock(&mutex_);
  return figures_;
}

LoadMeter::Recent LoadMeter::recent() {
  const absl::MutexLock lock(&mutex_);
  RollSecond(LoadClock::now());
  Recent recent;
  for (const auto& [code, count] : last_second_.codes) {
    (code == grpc::StatusCode::OK ? recent.good_per_second
                                  : recent.others_per_second) +=
        static_cast<double>(count);
  }
  recent.p50_ns = last_second_.latency.ValueAt(0.5);
  recent.p99_ns = last_second_.latency.ValueAt(0.99);
  return recent;
}

void LoadMeter::RollSecond(LoadClock::time_point now) {
  const std::int64_t second = (now - times_.start) / std::chrono::seconds(1);
  if (second <= second_) return;
  last_second_ = second == second_ + 1 ? std::move(this_second_) : LoadSlice();
  this_second_ = LoadSlice();
  second_ = second;
}

LoadSlice* LoadMeter::SliceAt(LoadClock::time_point time) {
  const auto index = static_cast<std::size_t>(
      std::max<LoadClock::duration>(time - times_.start, {}) / figures_.slice);
  if (index >= figures_.time_line.size()) figures_.time_line.resize(index + 1);
  return &figures_.time_line[index];
}

void LoadMeter::CountOffer(const PlannedRequest& plan) {
  ++figures_.offered;
  ++figures_.kinds[static_cast<std::size_t>(plan.kind)].offered;
  ++figures_.clients[static_cast<std::size_t>(plan.client)].offered;
}

void LoadMeter::CountGood(const PlannedRequest& plan,
                          LoadClock::duration latency, const CallResult& result,
                          LoadClock::time_point due) {
  figures_.latency.Record(latency);
  figures_.latency_with_lost.Record(latency);
  if (result.first_data.has_value()) {
    figures_.first_data.Record(*result.first_data - due);
  }
  figures_.tiles += result.tiles;
  figures_.samples += result.samples;
  figures_.bytes += result.bytes;
  for (ShareFigures* share :
       {&figures_.kinds[static_cast<std::size_t>(plan.kind)],
        &figures_.clients[static_cast<std::size_t>(plan.client)]}) {
    share->latency.Record(latency);
    if (latency <= times_.deadline) ++share->good;
  }
  if (latency <= times_.deadline) ++figures_.good;
}

std::optional<double> JainIndex(const std::vector<double>& shares) {
  double sum = 0;
  double squares = 0;
  for (const double share : shares) {
    sum += share;
    squares += share * share;
  }
  if (squares <= 0) return std::nullopt;
  return sum * sum / (static_cast<double>(shares.size()) * squares);
}

}  // namespace terrane::client
