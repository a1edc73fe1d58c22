#include "server/service/backlog.h"

#include <algorithm>
#include <string_view>

namespace terrane::server {
namespace {

// A message is on its way for less than that, unless its reader is slow.
constexpr std::chrono::milliseconds kMoment{250};

}  // namespace

void Backlog::Set(const Work& work) {
  Call& call = calls_[work.call];
  call.work_class = work.work_class;
  call.client = work.client;
  call.seconds = work.seconds;
  call.paused.reset();
}

void Backlog::AddTask(const Work& work) {
  Set(work);
  ++calls_[work.call].tasks;
}

void Backlog::EndTask(const Work& work, double spent_seconds, Time now) {
  if (!work.goes_on) return Remove(work.call);
  const auto found = calls_.find(work.call);
  if (found == calls_.end()) return;  // it was removed meanwhile
  Call& call = found->second;
  if (--call.tasks > 0) return;
  call.seconds = std::max(call.seconds - spent_seconds, 0.0);
  call.paused = now;
}

void Backlog::Remove(std::uint64_t call) { calls_.erase(call); }

bool Backlog::Counts(const Call& call, Time now) {
  return !call.paused.has_value() || now - *call.paused < kMoment;
}

Expectation Backlog::Expect(const Work& work, int workers, Time now) const {
  // The other of the two classes.
  const bool batch = work.work_class == WorkClass::kBatch;
  const WorkClass other = batch ? WorkClass::kInteractive : WorkClass::kBatch;
  double own = work.seconds;
  double of_other_class = 0;
  std::map<std::string_view, double> others;
  for (const auto& [id, call] : calls_) {
    if (id == work.call || !Counts(call, now)) continue;
    if (call.work_class == other) {
      of_other_class += call.seconds;
    } else if (call.client != work.client) {
      others[call.client] += call.seconds;
    } else if (batch) {
      own += std::min(call.seconds, work.seconds);
    } else if (work.call == 0 || id < work.call) {
      own += call.seconds;
    }
  }
  double ahead = own;
  for (const auto& [client, seconds] : others) ahead += std::min(seconds, own);
  // The other class takes what its weight gives it, but no more than it has.
  ahead += std::min(ahead * WeightOf(other) / WeightOf(work.work_class),
                    of_other_class);
  return {work.seconds, (ahead - work.seconds) / workers};
}

double Backlog::Seconds(WorkClass work_class, Time now) const {
  double seconds = 0;
  for (const auto& [id, call] : calls_) {
    if (call.work_class == work_class && Counts(call, now)) {
      seconds += call.seconds;
    }
  }
  return seconds;
}

}  // namespace terrane::server
