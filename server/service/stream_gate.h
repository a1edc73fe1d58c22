// StreamGate: how many streams are open at the same time.
//
// Up to `active` streams are open; up to `waiting` more stand in line. As one
// ends, a stream of the client with the fewest open ones starts, of these the
// one that came first. When the line is full, the client with the most streams
// in it loses its last one: a client that asks for a thousand streams waits for
// itself and not before the others.
//
// Threads: any. `start` and `refuse` run on a thread that enters or leaves, and
// only hand work over.
#ifndef TERRANE_SERVER_SERVICE_STREAM_GATE_H_
#define TERRANE_SERVER_SERVICE_STREAM_GATE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace terrane::server {

class StreamGate {
 public:
  using Ticket = std::uint64_t;

  // What becomes of a stream: one of both is called, once, unless it leaves
  // before.
  struct Entrant {
    std::string client;
    std::function<void()> start;
    std::function<void()> refuse;
  };

  StreamGate(std::size_t active, std::size_t waiting)
      : max_active_(active), max_waiting_(waiting) {}

  // Calls `start` now or later. Nothing when the line is full and the stream
  // may not take another's place in it.
  std::optional<Ticket> Enter(Entrant entrant);
  // The stream is over, whether it started, was refused or still stood in line.
  void Leave(Ticket ticket);

 private:
  struct Client {
    std::size_t active = 0;
    std::size_t waiting = 0;
  };

  // Who must go so that one more stream of `client` can wait: a stream in line,
  // or the newcomer itself (nothing).
  std::optional<Ticket> Loser(const std::string& client);
  // Takes a stream out of the line.
  Entrant TakeWaiting(Ticket ticket);
  void Forget(const std::string& client);

  const std::size_t max_active_;
  const std::size_t max_waiting_;
  std::mutex mutex_;
  Ticket last_ticket_ = 0;
  std::map<Ticket, std::string> active_;
  std::map<Ticket, Entrant> waiting_;  // first come first
  std::map<std::string, Client> clients_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STREAM_GATE_H_
