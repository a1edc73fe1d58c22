// Linger: during a drain, holds the end of a call back until its reader has
// most likely taken what came before.
//
// gRPC closes a connection along with the last call of a drain, and from then
// on the kernel answers whatever the peer still sends (a slow reader's window
// update, the answer to a ping) with a reset. That throws away what was not
// sent yet, up to megabytes of a stream that had ended well, and has proxies
// drop what they had not read. So the status, which lets the connection close,
// waits until the peer has acknowledged every byte before it and then said
// nothing for a moment: a reader that works through what it has got sends
// window updates. Outside of a drain nothing waits.
//
// Threads: Begin from one thread, once; Then from any.
#ifndef TERRANE_SERVER_SERVICE_LINGER_H_
#define TERRANE_SERVER_SERVICE_LINGER_H_

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace terrane::server {

class Linger {
 public:
  using Clock = std::chrono::steady_clock;
  // The sockets whose peer has this port; they stay open.
  using FindSockets = std::function<std::vector<int>(int peer_port)>;

  // From now on ends wait, but not beyond `until`.
  void Begin(FindSockets find, Clock::time_point until);

  // Runs `end`, which ends a call of `peer` ("ipv4:10.0.0.7:4711", as gRPC says
  // it): at once outside of a drain, else on a thread of this object.
  void Then(const std::string& peer, std::function<void()> end);

 private:
  struct Waiting {
    std::vector<int> sockets;
    std::function<void()> end;
    // Since when all has been acknowledged; the clock's beginning when not yet.
    Clock::time_point acknowledged;
  };

  bool MayEnd(Waiting* one) const;
  void Run(const std::stop_token& stop);

  std::atomic<bool> draining_ = false;
  FindSockets find_;
  Clock::time_point until_;
  std::mutex mutex_;
  std::vector<Waiting> waiting_;
  // Last, so that it ends first.
  std::jthread thread_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_LINGER_H_
