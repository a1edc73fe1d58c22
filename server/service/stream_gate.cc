#include "server/service/stream_gate.h"

#include <utility>

namespace terrane::server {

std::optional<StreamGate::Ticket> StreamGate::Enter(Entrant entrant) {
  Ticket ticket = 0;
  std::function<void()> start;
  std::function<void()> refuse;
  {
    std::lock_guard lock(mutex_);
    ticket = ++last_ticket_;
    const auto client = clients_.try_emplace(entrant.client).first;
    if (active_.size() < max_active_ &&
        client->second.active < max_active_of_client_) {
      ++client->second.active;
      active_.emplace(ticket, client);
      start = std::move(entrant.start);
    } else {
      if (waiting_.size() >= max_waiting_) {
        const auto loser = Loser(client);
        if (loser == clients_.end()) {
          Forget(client);
          return std::nullopt;
        }
        const Ticket last = loser->second.waiting.rbegin()->first;
        refuse = TakeWaiting(loser, last).refuse;
      }
      client->second.waiting.emplace(ticket, std::move(entrant));
      waiting_.emplace(ticket, client);
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
    if (const auto found = waiting_.find(ticket); found != waiting_.end()) {
      TakeWaiting(found->second, ticket);
      return;
    }
    const auto left = active_.find(ticket);
    if (left == active_.end()) return;
    --left->second->second.active;
    Forget(left->second);
    active_.erase(left);
    const auto next = Next();
    if (next == clients_.end()) return;
    const Ticket first = next->second.waiting.begin()->first;
    ++next->second.active;
    active_.emplace(first, next);
    start = TakeWaiting(next, first).start;
  }
  start();
}

StreamGate::Clients::iterator StreamGate::Loser(Clients::iterator newcomer) {
  // Of two clients alike the later stream goes; the newcomer's is the last.
  std::pair most(newcomer->second.waiting.size() + 1, last_ticket_);
  auto loser = clients_.end();
  for (auto one = clients_.begin(); one != clients_.end(); ++one) {
    const auto& waiting = one->second.waiting;
    if (waiting.empty()) continue;
    const std::pair its(waiting.size(), waiting.rbegin()->first);
    if (its > most) {
      most = its;
      loser = one;
    }
  }
  return loser;
}

StreamGate::Clients::iterator StreamGate::Next() {
  auto next = clients_.end();
  for (auto one = clients_.begin(); one != clients_.end(); ++one) {
    if (one->second.waiting.empty() ||
        one->second.active >= max_active_of_client_) {
      continue;
    }
    const auto place = [](Clients::iterator client) {
      return std::pair(client->second.active,
                       client->second.waiting.begin()->first);
    };
    if (next == clients_.end() || place(one) < place(next)) next = one;
  }
  return next;
}

StreamGate::Entrant StreamGate::TakeWaiting(Clients::iterator client,
                                            Ticket ticket) {
  Entrant entrant = std::move(client->second.waiting.extract(ticket).mapped());
  waiting_.erase(ticket);
  Forget(client);
  return entrant;
}

void StreamGate::Forget(Clients::iterator client) {
  if (client->second.active == 0 && client->second.waiting.empty()) {
    clients_.erase(client);
  }
}

}  // namespace terrane::server
