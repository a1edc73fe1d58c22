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
// Not thread-safe: WorkerPool holds it under its mutex.
#ifndef TERRANE_SERVER_SERVICE_BACKLOG_H_
#define TERRANE_SERVER_SERVICE_BACKLOG_H_

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "server/service/work.h"

namespace terrane::server {

class Backlog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `work.call` has `work.seconds` left to do, whatever was said before.
  void Set(const Work& work);
  // The same, and a task of it waits for a worker.
  void AddTask(const Work& work);
  // That task has ended after `spent_seconds`, and the call with it, unless it
  // goes on. Its next task may have been added before.
  void EndTask(const Work& work, double spent_seconds, Time now);
  void Remove(std::uint64_t call);

  // When `work` would end on `workers` workers. What is known of `work.call` so
  // far is left out.
  Expectation Expect(const Work& work, int workers, Time now) const;
  double Seconds(WorkClass work_class, Time now) const;

 private:
  struct Call {
    WorkClass work_class = WorkClass::kInteractive;
    std::string client;
    double seconds = 0;
    int tasks = 0;  // waiting or at work
    std::optional<Time> paused;
  };

  static bool Counts(const Call& call, Time now);

  std::map<std::uint64_t, Call> calls_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_BACKLOG_H_
