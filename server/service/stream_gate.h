// StreamGate: how many streams are generated at the same time.
//
// Up to `active` streams run; up to `waiting` more stand in line and start,
// first come first, as others end. The rest is refused at once, which is kinder
// than a line that nobody reaches the end of.
//
// Threads: any. `start` runs on the thread that lets the stream in and only
// hands work over.
#ifndef TERRANE_SERVER_SERVICE_STREAM_GATE_H_
#define TERRANE_SERVER_SERVICE_STREAM_GATE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>

namespace terrane::server {

class StreamGate {
 public:
  using Ticket = std::int64_t;

  StreamGate(std::size_t active, std::size_t waiting)
      : max_active_(active), max_waiting_(waiting) {}

  // Calls `start` now or later; nothing when the line is full.
  std::optional<Ticket> Enter(std::function<void()> start);
  // The stream is over, whether it started or still stood in line.
  void Leave(Ticket ticket);

 private:
  const std::size_t max_active_;
  const std::size_t max_waiting_;
  std::mutex mutex_;
  Ticket next_ticket_ = 0;
  std::set<Ticket> active_;
  std::map<Ticket, std::function<void()>> waiting_;  // first come first
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STREAM_GATE_H_
