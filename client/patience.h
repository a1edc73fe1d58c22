// Patience: how long a client waits, and for what.
//
// Between two tries of a call the wait doubles from 0.1 s to 2 s, and is spread
// by half of it either way, so that clients do not return together. What the
// server asks for comes on top of it, up to 30 s.
//
// Threads: any.
#ifndef TERRANE_CLIENT_PATIENCE_H_
#define TERRANE_CLIENT_PATIENCE_H_

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>

namespace terrane::client {

// The wait after `failures` tries in a row, at least 1. `asked`: for how long
// the server asked. `spread` is a random number in [0, 1). A pure function.
std::chrono::milliseconds WaitBeforeNextTry(
    int failures, std::optional<std::chrono::milliseconds> asked,
    double spread);

// False when asked to stop meanwhile.
bool SleepFor(std::chrono::milliseconds duration, std::stop_token stop);

// A connection on which nothing comes is asked after this time whether the
// other end is there (HTTP/2 PING), and given up when it does not say so within
// the same time. The server allows five seconds or more
// (server/service/connection_limits.cc).
constexpr std::chrono::milliseconds kPingAfter{20'000};

struct Patience {
  // A stream that brings nothing for this time counts as cut; 0: it may take
  // for ever.
  std::chrono::milliseconds stall{120'000};
  std::chrono::milliseconds ping_after = kPingAfter;
  // Waits between two tries.
  std::function<bool(std::chrono::milliseconds, std::stop_token)> wait =
      SleepFor;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_PATIENCE_H_
