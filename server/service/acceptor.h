// Acceptor: the server's listening sockets, and the thread that accepts.
//
// gRPC 1.51's own listener never accepts again once the process has run out of
// descriptors (CVE-2023-4785), and knows no limit of connections. So they are
// accepted here and handed to gRPC one by one.
//
// The cap: at most `max_connections` are open; one more is accepted and reset
// at once, so that its client turns to another replica instead of waiting in
// the backlog for an end that may not come.
//
// Out of descriptors (or memory for a socket): what comes waits in the backlog,
// and the thread tries again when a connection ends, else twenty times a
// second.
//
// gRPC owns the sockets and tells nobody when it closes them, so a duplicate of
// each is watched. gRPC shuts a socket down in both directions before it closes
// it, and so does the kernel when the peer resets it; that is EPOLLHUP on the
// duplicate, which is closed then and holds nothing open. (Watching gRPC's
// descriptor itself would miss the end: closing it takes it out of the epoll
// set.) A connection thus costs two descriptors, and a peer that only half
// closes keeps its place until gRPC lets go of it.
//
// Threads: Start, Stop and the destructor from one thread; counts from any.
#ifndef TERRANE_SERVER_SERVICE_ACCEPTOR_H_
#define TERRANE_SERVER_SERVICE_ACCEPTOR_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "absl/status/statusor.h"
#include "server/service/descriptor.h"

namespace terrane::server {

class Acceptor {
 public:
  // Takes a connected, non-blocking socket over. Runs on the thread that
  // accepts.
  using TakeConnection = std::function<void(int fd)>;
  // Is told of each connection that the cap refused; on the same thread.
  using OnRefused = std::function<void()>;

  // Binds and listens; nothing is accepted yet. `address` is HOST:PORT or
  // [IPV6]:PORT; port 0 takes a free one; a name stands for all its addresses.
  // A connection whose peer takes nothing of what was sent for `stall_limit` is
  // ended by the kernel: gRPC cannot cancel a call while it waits for a socket.
  // Errors: INVALID_ARGUMENT for another form, UNAVAILABLE when the address
  // cannot be listened on.
  static absl::StatusOr<std::unique_ptr<Acceptor>> Listen(
      const std::string& address, int max_connections,
      std::chrono::milliseconds stall_limit);
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  int port() const { return port_; }
  int max_connections() const { return max_connections_; }

  void Start(
      TakeConnection take, OnRefused on_refused = [] {});
  // Closes the listening sockets, and with them what waits in the backlog.
  // Connections that were handed over live on, uncounted. Final.
  void Stop();
  // After Stop: the sockets whose peer has this port (one, but for peers of
  // several hosts). They stay open as long as this object.
  std::vector<int> SocketsFrom(int peer_port) const;

  // Open now; reset because of the cap so far.
  int connections() const { return connections_; }
  std::int64_t refused() const { return refused_; }

 private:
  explicit Acceptor(int max_connections) : max_connections_(max_connections) {}

  absl::Status ListenOn(const std::string& host, const std::string& port,
                        std::chrono::milliseconds stall_limit);
  void Run();
  // True unless accepting has to pause for want of descriptors.
  bool AcceptFrom(int listener);
  bool HandOver(Descriptor connection);
  void WakeOnConnections(bool on);
  bool Watch(int fd, std::uint32_t events);

  const int max_connections_;
  int port_ = 0;
  std::vector<Descriptor> listeners_;
  Descriptor epoll_;
  Descriptor stop_event_;
  TakeConnection take_;
  OnRefused on_refused_;
  // The duplicates that are watched, by themselves. Of the thread.
  std::unordered_map<int, Descriptor> watched_;
  std::atomic<int> connections_ = 0;
  std::atomic<std::int64_t> refused_ = 0;
  std::thread thread_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_ACCEPTOR_H_
