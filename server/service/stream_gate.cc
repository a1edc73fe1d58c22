#include "server/service/stream_gate.h"

#include <utility>

namespace terrane::server {

std::optional<StreamGate::Ticket> StreamGate::Enter(
    std::function<void()> start) {
  Ticket ticket = 0;
  {
    std::lock_guard lock(mutex_);
    const bool waits = active_.size() >= max_active_;
    if (waits && waiting_.size() >= max_waiting_) return std::nullopt;
    ticket = next_ticket_++;
    if (waits) {
      waiting_.emplace(ticket, std::move(start));
      return ticket;
    }
    active_.insert(ticket);
  }
  start();
  return ticket;
}

void StreamGate::Leave(Ticket ticket) {
  std::function<void()> start;
  {
    std::lock_guard lock(mutex_);
    waiting_.erase(ticket);
    if (active_.erase(ticket) == 0 || waiting_.empty()) return;
    auto next = waiting_.extract(waiting_.begin());
    active_.insert(next.key());
    start = std::move(next.mapped());
  }
  start();
}

}  // namespace terrane::server
