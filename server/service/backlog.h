// Backlog: what the calls that are open have left to do, and when one more
// would be done.
//
// Calls are counted and not tasks: a stream has no task waiting while its
// message is on the way, or while it stands in line for its first one, and its
// work comes all the same. Only a stream that has waited for its reader for a
// moment does not count until it goes on: a slow reader keeps no worker busy.
//
// The expected finish is that of the fluid model of FairQueue: a client gets
// through its own backlog while every other one gets through as much, at most,
// of its own; batch calls of a client take turns.
//
// Sums are kept per client, so an expectation costs as much as there are
// clients, and a few of one's own calls: it is asked for of every call that is
// refused, too. They are of whole nanoseconds, and so never drift.
//
// Not thread-safe: WorkerPool holds it under its mutex.
#ifndef TERRANE_SERVER_SERVICE_BACKLOG_H_
#define TERRANE_SERVER_SERVICE_BACKLOG_H_

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "server/service/work.h"

namespace terrane::server {

class Backlog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `work.call` has `work.seconds` left to do, whatever was said before. Its
  // client stays the same.
  void Set(const Work& work);
  // The same, and a task of it waits for a worker.
  void AddTask(const Work& work);
  // That task has ended after `spent_seconds`, and the call with it, unless it
  // goes on. Its next task may have been added before.
  void EndTask(const Work& work, double spent_seconds, Time now);
  void Remove(std::uint64_t call);

  // When `work` would end on `workers` workers. What is known of `work.call` so
  // far is left out.
  Expectation Expect(const Work& work, int workers, Time now);
  double Seconds(WorkClass work_class, Time now);

 private:
  using Duration = std::chrono::nanoseconds;

  // What a client has left to do in one class.
  struct Part {
    Duration left{0};
    std::map<std::uint64_t, Duration> calls;  // those that count
  };
  struct Client {
    std::array<Part, kWorkClasses> parts;
    int calls = 0;
  };
  using Clients = std::map<std::string, Client>;

  struct Call {
    WorkClass work_class = WorkClass::kInteractive;
    Clients::iterator client;
    Duration left{0};
    int tasks = 0;  // waiting or at work
    bool counts = false;
    std::optional<Time> paused;
  };

  // Takes a call into the sums, and out of them.
  void Count(std::uint64_t id, Call* call);
  void Uncount(std::uint64_t id, Call* call);
  // Streams whose reader has let them wait for a moment no longer count.
  void Settle(Time now);
  // What `client` does before or along with `work`, which asks for `asked`.
  static Duration Before(const Work& work, Duration asked,
                         const Client& client);

  Clients clients_;
  std::unordered_map<std::uint64_t, Call> calls_;
  std::array<Duration, kWorkClasses> left_{};
  // Calls that paused, in the order in which they did; one that went on since
  // is still in it.
  std::deque<std::pair<Time, std::uint64_t>> pauses_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_BACKLOG_H_
