#include "server/service/backlog.h"

#include <algorithm>

namespace terrane::server {
namespace {

using std::chrono::nanoseconds;

// A message is on its way for less than that, unless its reader is slow.
constexpr std::chrono::milliseconds kMoment{250};
// More than any call waits; thousands of such calls can be added up.
constexpr double kMostSeconds = 1e6;

constexpr std::size_t Index(WorkClass work_class) {
  return static_cast<std::size_t>(work_class);
}

constexpr WorkClass Other(WorkClass work_class) {
  return work_class == WorkClass::kBatch ? WorkClass::kInteractive
                                         : WorkClass::kBatch;
}

nanoseconds FromSeconds(double seconds) {
  return nanoseconds(
      static_cast<std::int64_t>(std::min(kMostSeconds, seconds) * 1e9));
}

double ToSeconds(nanoseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void Backlog::Set(const Work& work) {
  const auto [entry, is_new] = calls_.try_emplace(work.call);
  Call& call = entry->second;
  if (is_new) {
    call.client = clients_.try_emplace(work.client).first;
    ++call.client->second.calls;
  }
  Uncount(work.call, &call);
  call.work_class = work.work_class;
  call.left = FromSeconds(work.seconds);
  call.paused.reset();
  Count(work.call, &call);
}

void Backlog::AddTask(const Work& work) {
  Set(work);
  ++calls_[work.call].tasks;
}

void Backlog::EndTask(const Work& work, double spent_seconds, Time now) {
  Settle(now);
  if (!work.goes_on) return Remove(work.call);
  const auto found = calls_.find(work.call);
  if (found == calls_.end()) return;  // it was removed meanwhile
  Call& call = found->second;
  if (--call.tasks > 0) return;
  Uncount(work.call, &call);
  call.left = std::max(call.left - FromSeconds(spent_seconds), Duration(0));
  Count(work.call, &call);
  call.paused = now;
  pauses_.emplace_back(now, work.call);
}

void Backlog::Remove(std::uint64_t id) {
  const auto found = calls_.find(id);
  if (found == calls_.end()) return;
  Uncount(id, &found->second);
  const Clients::iterator client = found->second.client;
  if (--client->second.calls == 0) clients_.erase(client);
  calls_.erase(found);
}

void Backlog::Count(std::uint64_t id, Call* call) {
  const std::size_t k = Index(call->work_class);
  Part& part = call->client->second.parts[k];
  part.calls[id] = call->left;
  part.left += call->left;
  left_[k] += call->left;
  call->counts = true;
}

void Backlog::Uncount(std::uint64_t id, Call* call) {
  if (!call->counts) return;
  const std::size_t k = Index(call->work_class);
  Part& part = call->client->second.parts[k];
  part.calls.erase(id);
  part.left -= call->left;
  left_[k] -= call->left;
  call->counts = false;
}

void Backlog::Settle(Time now) {
  while (!pauses_.empty() && now - pauses_.front().first >= kMoment) {
    const auto [paused, id] = pauses_.front();
    pauses_.pop_front();
    const auto found = calls_.find(id);
    if (found != calls_.end() && found->second.paused == paused) {
      Uncount(id, &found->second);
    }
  }
}

Backlog::Duration Backlog::Before(const Work& work, Duration asked,
                                  const Client& client) {
  const Part& part = client.parts[Index(work.work_class)];
  Duration before{0};
  if (work.work_class == WorkClass::kBatch) {
    for (const auto& [id, left] : part.calls) {
      if (id != work.call) before += std::min(left, asked);
    }
    return before;
  }
  before = part.left;
  if (work.call == 0) return before;
  // Calls that ask are mostly the newest: from the last one on.
  for (auto later = part.calls.rbegin();
       later != part.calls.rend() && later->first >= work.call; ++later) {
    before -= later->second;
  }
  return before;
}

Expectation Backlog::Expect(const Work& work, int workers, Time now) {
  Settle(now);
  const Duration asked = FromSeconds(work.seconds);
  const auto client = clients_.find(work.client);
  Duration own = asked;
  if (client != clients_.end()) own += Before(work, asked, client->second);
  Duration ahead = own;
  for (auto other = clients_.begin(); other != clients_.end(); ++other) {
    if (other == client) continue;
    ahead += std::min(other->second.parts[Index(work.work_class)].left, own);
  }
  const WorkClass other_class = Other(work.work_class);
  Duration of_other_class = left_[Index(other_class)];
  const auto self = calls_.find(work.call);
  if (self != calls_.end() && self->second.counts &&
      self->second.work_class == other_class) {
    of_other_class -= self->second.left;
  }
  // The other class takes what its weight gives it, but no more than it has.
  const double wait = ToSeconds(ahead - asked) +
                      std::min(ToSeconds(ahead) * WeightOf(other_class) /
                                   WeightOf(work.work_class),
                               ToSeconds(of_other_class));
  return {work.seconds, wait / workers};
}

double Backlog::Seconds(WorkClass work_class, Time now) {
  Settle(now);
  return ToSeconds(left_[Index(work_class)]);
}

}  // namespace terrane::server
