#include "server/service/fair_queue.h"

#include <algorithm>

namespace terrane::server {
namespace {

// Shares of the workers while every class has something to do. Opening costs
// next to nothing unless a recipe is made ready; batch work gets a tenth of
// what is left.
constexpr std::array<double, kWorkClasses> kWeights = {0.5, 0.45, 0.05};

constexpr double WeightOf(WorkClass work_class) {
  return kWeights[static_cast<std::size_t>(work_class)];
}

}  // namespace

void FairQueue::Push(Work work, Task task) {
  Class& all = Of(work.work_class);
  // Who was away has no credit for it.
  if (all.waiting == 0) all.virtual_time = std::max(all.virtual_time, now_);
  Lane& lane = all.lanes[work.client];
  if (lane.waiting.empty()) {
    lane.virtual_time = std::max(lane.virtual_time, all.now);
  }
  lane.waiting.emplace(std::pair(work.ticket, pushed_++),
                       Waiting{work.seconds, std::move(task)});
  lane.backlog += work.seconds;
  ++all.waiting;
  ++waiting_;
}

FairQueue::Taken FairQueue::Pop() {
  std::size_t chosen = kWorkClasses;
  for (std::size_t k = 0; k < kWorkClasses; ++k) {
    if (classes_[k].waiting > 0 &&
        (chosen == kWorkClasses ||
         classes_[k].virtual_time < classes_[chosen].virtual_time)) {
      chosen = k;
    }
  }
  Class& all = classes_[chosen];
  now_ = all.virtual_time;
  auto next = all.lanes.end();
  for (auto lane = all.lanes.begin(); lane != all.lanes.end(); ++lane) {
    if (!lane->second.waiting.empty() &&
        (next == all.lanes.end() ||
         lane->second.virtual_time < next->second.virtual_time)) {
      next = lane;
    }
  }
  Lane& lane = next->second;
  all.now = lane.virtual_time;
  auto entry = lane.waiting.extract(lane.waiting.begin());
  ++lane.running;
  --all.waiting;
  --waiting_;
  return {{static_cast<WorkClass>(chosen), next->first, entry.key().first,
           entry.mapped().seconds},
          std::move(entry.mapped().task)};
}

void FairQueue::Finish(const Work& work, double spent_seconds) {
  Class& all = Of(work.work_class);
  all.virtual_time += spent_seconds / WeightOf(work.work_class);
  const auto found = all.lanes.find(work.client);
  Lane& lane = found->second;
  lane.virtual_time += spent_seconds;
  --lane.running;
  lane.backlog -= work.seconds;
  if (lane.running > 0 || !lane.waiting.empty()) return;
  lane.backlog = 0;  // without what rounding left
  // A lane that the others have caught up with would start anew just there.
  std::erase_if(all.lanes, [&all](const auto& item) {
    const Lane& idle = item.second;
    return idle.running == 0 && idle.waiting.empty() &&
           idle.virtual_time <= all.now;
  });
}

double FairQueue::OwnSeconds(const Work& work) const {
  const Class& all = Of(work.work_class);
  const auto mine = all.lanes.find(work.client);
  if (mine == all.lanes.end()) return work.seconds;
  const Lane& lane = mine->second;
  if (work.work_class != WorkClass::kBatch) return work.seconds + lane.backlog;
  double own = work.seconds;
  double running = lane.backlog;
  for (const auto& [place, waiting] : lane.waiting) {
    own += std::min(waiting.seconds, work.seconds);
    running -= waiting.seconds;
  }
  return own + std::min(running, lane.running * work.seconds);
}

double FairQueue::ExpectedSeconds(const Work& work, int workers) const {
  const Class& all = Of(work.work_class);
  const double own = OwnSeconds(work);
  double ahead = own;
  for (const auto& [client, lane] : all.lanes) {
    if (client != work.client) ahead += std::min(lane.backlog, own);
  }
  // The other of the two classes takes what its weight gives it, but no more
  // than it has.
  const bool batch = work.work_class == WorkClass::kBatch;
  const WorkClass other = batch ? WorkClass::kInteractive : WorkClass::kBatch;
  const double theirs = ahead * WeightOf(other) / WeightOf(work.work_class);
  ahead += std::min(theirs, BacklogSeconds(other));
  return ahead / workers;
}

double FairQueue::BacklogSeconds(WorkClass work_class) const {
  double seconds = 0;
  for (const auto& [client, lane] : Of(work_class).lanes) {
    seconds += lane.backlog;
  }
  return seconds;
}

}  // namespace terrane::server
