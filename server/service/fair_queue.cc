#include "server/service/fair_queue.h"

#include <algorithm>

namespace terrane::server {

void FairQueue::Push(Work work, Task task) {
  Class& all = Of(work.work_class);
  // Who was away has no credit for it.
  if (all.waiting == 0) all.virtual_time = std::max(all.virtual_time, now_);
  Lane& lane = all.lanes[work.client];
  if (lane.waiting.empty()) {
    lane.virtual_time = std::max(lane.virtual_time, all.now);
  }
  if (!lane.active()) ++all.active;
  const Place place(work.ticket, pushed_++);
  if (work.call != 0) {
    queued_.insert_or_assign(work.call,
                             Queued{work.work_class, work.client, place});
  }
  lane.waiting.emplace(place, Taken{std::move(work), std::move(task)});
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
  ++lane.running;
  return Take(&all, &lane, lane.waiting.begin()->first);
}

FairQueue::Taken FairQueue::Take(Class* all, Lane* lane, Place place) {
  auto entry = lane->waiting.extract(place);
  --all->waiting;
  --waiting_;
  const auto queued = queued_.find(entry.mapped().work.call);
  if (queued != queued_.end() && queued->second.place == place) {
    queued_.erase(queued);
  }
  return std::move(entry.mapped());
}

void FairQueue::Finish(const Work& work, double spent_seconds) {
  Class& all = Of(work.work_class);
  all.virtual_time += spent_seconds / WeightOf(work.work_class);
  all.now += spent_seconds / static_cast<double>(all.active);
  Lane& lane = all.lanes.find(work.client)->second;
  lane.virtual_time += spent_seconds;
  --lane.running;
  if (lane.active()) return;
  --all.active;
  Forget(&all);
}

FairQueue::Task FairQueue::Drop(std::uint64_t call) {
  const auto found = queued_.find(call);
  if (found == queued_.end()) return nullptr;
  const Queued queued = found->second;
  Class& all = Of(queued.work_class);
  Lane& lane = all.lanes.find(queued.client)->second;
  Task task = Take(&all, &lane, queued.place).task;
  if (!lane.active()) {
    --all.active;
    Forget(&all);
  }
  return task;
}

std::size_t FairQueue::clients() const {
  std::size_t count = 0;
  for (const Class& all : classes_) count += all.lanes.size();
  return count;
}

void FairQueue::Forget(Class* all) {
  // Among nobody there is no debt; among others a lane that they have caught up
  // with would start anew just there.
  std::erase_if(all->lanes, [all](const auto& item) {
    const Lane& lane = item.second;
    return !lane.active() &&
           (all->active == 0 || lane.virtual_time <= all->now);
  });
}

}  // namespace terrane::server
