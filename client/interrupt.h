// Interrupt: turns Ctrl-C (SIGINT), SIGTERM and a closed terminal (SIGHUP) into
// a stop token, so that a command ends in order: the stream is cancelled on the
// server and half-written files go. A second signal ends the process at once.
//
// Make one in main before any other thread starts: it blocks the signals for
// all of them and waits for them in a thread of its own.
#ifndef TERRANE_CLIENT_INTERRUPT_H_
#define TERRANE_CLIENT_INTERRUPT_H_

#include <csignal>
#include <stop_token>
#include <thread>

namespace terrane::client {

class Interrupt {
 public:
  Interrupt();

  std::stop_token token() const { return source_.get_token(); }

 private:
  void Watch(std::stop_token done);

  std::stop_source source_;
  sigset_t signals_;
  std::jthread watcher_;  // last: ends before what it uses goes
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_INTERRUPT_H_
