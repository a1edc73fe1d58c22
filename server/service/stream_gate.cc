#include "server/service/stream_gate.h"

#include <algorithm>
#include <utility>

namespace terrane::server {

std::optional<StreamGate::Ticket> StreamGate::Enter(Entrant entrant) {
  Ticket ticket = 0;
  std::function<void()> start;
  std::function<void()> refuse;
  {
    std::lock_guard lock(mutex_);
    ticket = ++last_ticket_;
    if (active_.size() < max_active_) {
      ++clients_[entrant.client].active;
      active_.emplace(ticket, entrant.client);
      start = std::move(entrant.start);
    } else {
      if (waiting_.size() >= max_waiting_) {
        const std::optional<Ticket> loser = Loser(entrant.client);
        if (!loser.has_value()) return std::nullopt;
        refuse = TakeWaiting(*loser).refuse;
      }
      ++clients_[entrant.client].waiting;
      waiting_.emplace(ticket, std::move(entrant));
    }
  }
  if (refuse) refuse();
  if (start) start();
  return ticket;
}

void StreamGate::Leave(Ticket ticket) {
  std::function<void()> start;
  {
    std::lock_guard lock(mutex_);
    if (waiting_.contains(ticket)) TakeWaiting(ticket);
    const auto left = active_.find(ticket);
    if (left == active_.end()) return;
    --clients_[left->second].active;
    Forget(left->second);
    active_.erase(left);
    if (waiting_.empty()) return;
    const auto next = std::min_element(
        waiting_.begin(), waiting_.end(), [this](const auto& a, const auto& b) {
          return clients_[a.second.client].active <
                 clients_[b.second.client].active;
        });
    const Ticket next_ticket = next->first;
    Entrant entrant = TakeWaiting(next_ticket);
    ++clients_[entrant.client].active;
    active_.emplace(next_ticket, std::move(entrant.client));
    start = std::move(entrant.start);
  }
  start();
}

std::optional<StreamGate::Ticket> StreamGate::Loser(const std::string& client) {
  std::size_t most = clients_[client].waiting + 1;
  std::optional<Ticket> loser;
  // From the last one on: of two clients alike the later stream goes.
  for (auto one = waiting_.rbegin(); one != waiting_.rend(); ++one) {
    const std::size_t waiting = clients_[one->second.client].waiting;
    if (waiting > most) {
      most = waiting;
      loser = one->first;
    }
  }
  Forget(client);
  return loser;
}

StreamGate::Entrant StreamGate::TakeWaiting(Ticket ticket) {
  Entrant entrant = std::move(waiting_.extract(ticket).mapped());
  --clients_[entrant.client].waiting;
  Forget(entrant.client);
  return entrant;
}

void StreamGate::Forget(const std::string& client) {
  const auto found = clients_.find(client);
  if (found != clients_.end() && found->second.active == 0 &&
      found->second.waiting == 0) {
    clients_.erase(found);
  }
}

}  // namespace terrane::server
