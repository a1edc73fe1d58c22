// FairQueue: whose task runs next.
//
// Start-time fair queueing in two steps. Classes share the workers by weight,
// so that interactive work comes before batch work, which still moves; within a
// class clients share alike, whatever they have queued. What a task cost is
// charged when it has ended, as measured, so a wrong guess costs nobody
// anything. Of one client's tasks the one with the lowest ticket comes first.
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
#include "server/service/work.h"

namespace terrane::server {

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

 private:
  // The tasks of a client; by ticket, then in order.
  struct Lane {
    std::map<std::pair<std::uint64_t, std::uint64_t>, Taken> waiting;
    int running = 0;
    double virtual_time = 0;  // seconds charged, among the lanes of the class
  };
  struct Class {
    std::map<std::string, Lane> lanes;
    std::size_t waiting = 0;
    double virtual_time = 0;  // seconds by weight, among the classes
    double now = 0;           // virtual time of the lane taken last
  };

  Class& Of(WorkClass work_class) {
    return classes_[static_cast<std::size_t>(work_class)];
  }

  std::array<Class, kWorkClasses> classes_;
  std::size_t waiting_ = 0;
  std::uint64_t pushed_ = 0;
  double now_ = 0;  // virtual time of the class taken last
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_FAIR_QUEUE_H_
