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
  const std::pair place(work.ticket, pushed_++);
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
  all.now = lane.virtual_time;
  auto entry = lane.waiting.extract(lane.waiting.begin());
  ++lane.running;
  --all.waiting;
  --waiting_;
  return std::move(entry.mapped());
}

void FairQueue::Finish(const Work& work, double spent_seconds) {
  Class& all = Of(work.work_class);
  all.virtual_time += spent_seconds / WeightOf(work.work_class);
  const auto found = all.lanes.find(work.client);
  Lane& lane = found->second;
  lane.virtual_time += spent_seconds;
  --lane.running;
  if (lane.running > 0 || !lane.waiting.empty()) return;
  // A lane that the others have caught up with would start anew just there.
  std::erase_if(all.lanes, [&all](const auto& item) {
    const Lane& idle = item.second;
    return idle.running == 0 && idle.waiting.empty() &&
           idle.virtual_time <= all.now;
  });
}

}  // namespace terrane::server
