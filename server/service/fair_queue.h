// FairQueue: whose task runs next, and when what is asked for now would be
// done.
//
// Start-time fair queueing in two steps. Classes share the workers by weight,
// so that interactive work comes before batch work, which still moves; within a
// class clients share alike, whatever they have queued. What a task cost is
// charged when it has ended, as measured, so a wrong guess costs nobody
// anything. Of one client's tasks the one with the lowest ticket comes first.
//
// The expected finish is that of the fluid model: a client gets through its own
// backlog while every other one gets through as much, at most, of its own.
//
// Not thread-safe: WorkerPool holds it under its mutex.
#ifndef TERRANE_SERVER_SERVICE_FAIR_QUEUE_H_
#define TERRANE_SERVER_SERVICE_FAIR_QUEUE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "core/terrain/terrain.h"

namespace terrane::server {

enum class WorkClass {
  kOpening,      // reading requests, so that refusals come at once
  kInteractive,  // calls whose price is small
  kBatch,        // all other calls
};
inline constexpr std::size_t kWorkClasses = 3;

// What a task belongs to.
struct Work {
  WorkClass work_class = WorkClass::kInteractive;
  // Whose share of the workers it takes.
  std::string client;
  // Its place among the tasks of its client, lowest first.
  std::uint64_t ticket = 0;
  // What its call has left to do on one worker, this task included.
  double seconds = 0;
};

class FairQueue {
 public:
  using Task = std::function<void(core::TileScratch*)>;

  // A task that was taken and is to be returned by Finish.
  struct Taken {
    Work work;
    Task task;
  };

  void Push(Work work, Task task);
  bool empty() const { return waiting_ == 0; }
  std::size_t waiting() const { return waiting_; }
  // The queue must not be empty.
  Taken Pop();
  // The task that was taken for `work` has ended.
  void Finish(const Work& work, double spent_seconds);

  // How long from now `work` would take to end on `workers` workers.
  double ExpectedSeconds(const Work& work, int workers) const;
  // What the calls of a class with a task here, or at work, have left to do.
  double BacklogSeconds(WorkClass work_class) const;

 private:
  struct Waiting {
    double seconds;
    Task task;
  };
  // The tasks of a client; by ticket, then in order.
  struct Lane {
    std::map<std::pair<std::uint64_t, std::uint64_t>, Waiting> waiting;
    int running = 0;
    double backlog = 0;       // seconds of those waiting and running
    double virtual_time = 0;  // seconds charged, among the lanes of the class
  };
  struct Class {
    std::map<std::string, Lane> lanes;
    std::size_t waiting = 0;
    double virtual_time = 0;  // seconds by weight, among the classes
    double now = 0;           // virtual time of the lane taken last
  };

  // What a client gets through until `work` has ended: of interactive calls all
  // that came before; of batch calls, which take turns, as much of each.
  double OwnSeconds(const Work& work) const;

  Class& Of(WorkClass work_class) {
    return classes_[static_cast<std::size_t>(work_class)];
  }
  const Class& Of(WorkClass work_class) const {
    return classes_[static_cast<std::size_t>(work_class)];
  }

  std::array<Class, kWorkClasses> classes_;
  std::size_t waiting_ = 0;
  std::uint64_t pushed_ = 0;
  double now_ = 0;  // virtual time of the class taken last
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_FAIR_QUEUE_H_
