// FairQueue: whose task runs next.
//
// Fair queueing in two steps. Classes share the workers by weight, so that
// interactive work comes before batch work, which still moves; within a class
// clients share alike, whatever they have queued. What a task cost is charged
// when it has ended, as measured, so a wrong guess costs nobody anything. Of
// one client's tasks the one with the lowest ticket comes first.
//
// A client that comes starts at the virtual time of its class, which moves as
// if all clients with something to do were served at once: one that waits is
// overtaken neither by those that come back nor by a stream of new ones.
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
#include <unordered_map>
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
  // The task of `call` that waits, if one does: nobody needs it any more. It
  // is for the caller to destroy, without a lock.
  Task Drop(std::uint64_t call);
  // Clients that something is known of, in all classes.
  std::size_t clients() const;

 private:
  // By ticket, then in order.
  using Place = std::pair<std::uint64_t, std::uint64_t>;
  // The tasks of a client.
  struct Lane {
    bool active() const { return running > 0 || !waiting.empty(); }

    std::map<Place, Taken> waiting;
    int running = 0;
    double virtual_time = 0;  // seconds charged, among the lanes of the class
  };
  struct Class {
    std::map<std::string, Lane> lanes;
    std::size_t waiting = 0;
    std::size_t active = 0;   // lanes with something to do
    double virtual_time = 0;  // seconds by weight, among the classes
    double now = 0;           // where a lane that comes begins
  };
  // Where the task of a call waits.
  struct Queued {
    WorkClass work_class;
    std::string client;
    Place place;
  };

  Class& Of(WorkClass work_class) {
    return classes_[static_cast<std::size_t>(work_class)];
  }
  // Takes a task out of its lane.
  Taken Take(Class* all, Lane* lane, Place place);
  // Forgets lanes that have nothing to do and no debt.
  static void Forget(Class* all);

  std::array<Class, kWorkClasses> classes_;
  std::unordered_map<std::uint64_t, Queued> queued_;  // by call
  std::size_t waiting_ = 0;
  std::uint64_t pushed_ = 0;
  double now_ = 0;  // virtual time of the class taken last
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_FAIR_QUEUE_H_
