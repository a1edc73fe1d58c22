// RunLoad: sends the requests of a mix to a server, in a closed or an open
// loop, and meters what becomes of them.
//
// The load goes on past the measured time until every measured request has
// ended, so that the last ones meet the same load as the others; no longer than
// the deadline and a second. What is then still open is cut, and counted as
// unfinished. A caller of a closed loop that found no server waits a little
// before it asks again: a server that is gone answers faster than any other.
#ifndef TERRANE_CLIENT_BENCH_LOAD_H_
#define TERRANE_CLIENT_BENCH_LOAD_H_

#include <cstdint>
#include <functional>
#include <stop_token>

#include "client/bench/arrivals.h"
#include "client/bench/load_call.h"
#include "client/bench/meter.h"
#include "client/bench/request_mix.h"

namespace terrane::client {

struct LoadOptions {
  // Requests a second of an open loop; 0: a closed loop of `concurrency`
  // callers, each of which asks again when it has its answer.
  double rate = 0;
  ArrivalKind arrivals = ArrivalKind::kPoisson;
  int concurrency = 16;
  // Calls in flight of an open loop, at most.
  int max_in_flight = 1024;
  // Tries after the first, of a call that is refused or finds no server; at
  // most 100, with the waits of client/patience.h between. The deadline holds
  // for all tries together.
  int retries = 0;
};

// Called a few times a second, and at the end, with the calls in flight.
using OnTick = std::function<void(int in_flight)>;

// Whether the load ran to its end, or was stopped before.
enum class LoadEnd { kComplete, kStopped };

LoadEnd RunLoad(const LoadOptions& options, const RequestMix& mix,
                CallMaker* calls, LoadMeter* meter, const OnTick& on_tick,
                std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_LOAD_H_
