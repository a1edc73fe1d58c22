// What a task of the worker pool belongs to.
#ifndef TERRANE_SERVER_SERVICE_WORK_H_
#define TERRANE_SERVER_SERVICE_WORK_H_

#include <cstddef>
#include <cstdint>
#include <string>

namespace terrane::server {

enum class WorkClass {
  kOpening,      // reading requests, so that refusals come at once
  kInteractive,  // calls whose price is small
  kBatch,        // all other calls
};
inline constexpr std::size_t kWorkClasses = 3;

// Shares of the workers while every class has something to do. Opening costs
// next to nothing unless a recipe is made ready; batch work gets a tenth of
// what is left.
constexpr double WeightOf(WorkClass work_class) {
  constexpr double kWeights[kWorkClasses] = {0.5, 0.45, 0.05};
  return kWeights[static_cast<std::size_t>(work_class)];
}

struct Work {
  WorkClass work_class = WorkClass::kInteractive;
  // Whose share of the workers it takes.
  std::string client;
  // Its place among the tasks of its client, lowest first.
  std::uint64_t ticket = 0;
  // What its call has left to do on one worker, this task included.
  double seconds = 0;
  // Its call, in the order in which calls came; 0 when it is not to be counted
  // in the backlog.
  std::uint64_t call = 0;
  // The call has more tasks, of which none may be waiting now and then.
  bool goes_on = false;
};

// When a call would end, from now, in seconds.
struct Expectation {
  double work = 0;  // of its own, one task after the other
  double wait = 0;  // while workers are busy with others and what came before
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_WORK_H_
