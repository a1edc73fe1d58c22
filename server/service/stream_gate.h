// StreamGate: how many streams are open at the same time.
//
// Up to `active` streams are open, three quarters at most of one client:
// readers that take their time hold their places, and others must find one. Up
// to `waiting` more stand in line. As one ends, a stream of the client with the
// fewest open ones starts, of these the one that came first. When the line is
// full, the client with the most streams in it loses its last one: a client
// that asks for a thousand streams waits for itself and not before the others.
// What either costs grows with the clients and not with the streams: a storm of
// refusals must stay cheap.
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
#include <unordered_map>

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
      : max_active_(active),
        max_active_of_client_((3 * active + 3) / 4),
        max_waiting_(waiting) {}

  // Calls `start` now or later. Nothing when the line is full and the stream
  // may not take another's place in it.
  std::optional<Ticket> Enter(Entrant entrant);
  // The stream is over, whether it started, was refused or still stood in line.
  void Leave(Ticket ticket);

 private:
  struct Client {
    std::size_t active = 0;
    std::map<Ticket, Entrant> waiting;  // first come first
  };
  using Clients = std::map<std::string, Client>;

  // Whose last stream must go so that one more of `newcomer` can wait, or the
  // end when that is the newcomer's.
  Clients::iterator Loser(Clients::iterator newcomer);
  // Whose first stream in line goes next; the end when nobody's may.
  Clients::iterator Next();
  // Takes a stream out of the line.
  Entrant TakeWaiting(Clients::iterator client, Ticket ticket);
  // Drops a client that has no streams.
  void Forget(Clients::iterator client);

  const std::size_t max_active_;
  const std::size_t max_active_of_client_;
  const std::size_t max_waiting_;
  std::mutex mutex_;
  Ticket last_ticket_ = 0;
  Clients clients_;
  std::unordered_map<Ticket, Clients::iterator> active_;
  std::unordered_map<Ticket, Clients::iterator> waiting_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STREAM_GATE_H_
