// The line of progress of a load test: what happens right now. On a terminal
// only, or as JSON lines. Belongs to one thread.
#ifndef TERRANE_CLIENT_BENCH_LOAD_PROGRESS_H_
#define TERRANE_CLIENT_BENCH_LOAD_PROGRESS_H_

#include <string>

#include "client/bench/meter.h"
#include "client/progress.h"

namespace terrane::client {

class LoadProgress : private ProgressLine {
 public:
  // `what` names the run: "open loop, 120 requests/s".
  LoadProgress(ProgressMode mode, std::string what)
      : ProgressLine(mode), what_(std::move(what)) {}

  void Show(int in_flight, LoadMeter* meter);

 private:
  const std::string what_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_LOAD_PROGRESS_H_
