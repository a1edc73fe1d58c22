#include "client/interrupt.h"

#include <unistd.h>

#include "client/exit_code.h"

namespace terrane::client {
namespace {

// How long the end of the program waits for the watching thread, at most.
constexpr timespec kPollInterval = {0, 20'000'000};

}  // namespace

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    sigaddset(&signals_, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  watcher_ = std::jthread([this](std::stop_token done) { Watch(done); });
}

void Interrupt::Watch(std::stop_token done) {
  while (!done.stop_requested()) {
    if (sigtimedwait(&signals_, nullptr, &kPollInterval) < 0) continue;
    if (source_.stop_requested()) _exit(kExitInterrupted);
    source_.request_stop();
  }
}

}  // namespace terrane::client
