// CallRecord: what is noted of one call as it goes, for the log and the metrics
// (server/service/call_book.h).
//
// Belongs to its call, which guards it as it guards its own state. Times come
// from the steady clock.
#ifndef TERRANE_SERVER_SERVICE_CALL_RECORD_H_
#define TERRANE_SERVER_SERVICE_CALL_RECORD_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace terrane::server {

// What a call is to the workers: short, with somebody waiting for it, or long.
enum class CallClass { kInteractive, kBatch };
inline constexpr CallClass kCallClasses[] = {CallClass::kInteractive,
                                             CallClass::kBatch};
// "interactive" or "batch".
const char* NameOf(CallClass call_class);

// Why the server turned work away that it could have done at another time.
enum class Refusal {
  kStreams,      // as many streams are open and waiting as may be
  kDeadline,     // would not be done before the call's deadline
  kMemory,       // the memory is nearly used up
  kClientLimit,  // this client has as much as it may
  kConnections,  // as many connections are open as may be
};
inline constexpr Refusal kRefusals[] = {Refusal::kStreams, Refusal::kDeadline,
                                        Refusal::kMemory, Refusal::kClientLimit,
                                        Refusal::kConnections};
// Such as "streams".
const char* NameOf(Refusal refusal);

struct CallRecord {
  using Clock = std::chrono::steady_clock;

  std::string request_id;
  // Of the trace that the client's traceparent names; empty without one.
  std::string trace_id;
  // A literal, the name of the rpc.
  const char* method = "";
  // Who asks, for fairness; never logged.
  std::string client;
  // Its place among the client's calls (client_places.h), until it is over.
  std::shared_ptr<const void> place;
  std::string recipe_hash;
  CallClass call_class = CallClass::kInteractive;
  // Messages with content that were made; a header is none.
  std::int64_t tiles = 0;
  // Heights, vertices, rows or whatever the messages hold.
  std::int64_t samples = 0;
  // Of what was made, or of what was uploaded.
  std::int64_t bytes = 0;
  // What the work was expected to take on a worker; 0 is unknown.
  double estimated_seconds = 0;
  Clock::time_point begin = Clock::now();
  std::chrono::nanoseconds queued{0};     // waiting for a worker
  std::chrono::nanoseconds generated{0};  // on a worker
  // With a message of a stream, or the answer of a unary call, in gRPC's hands:
  // what a slow reader or a narrow line costs. Overlaps with generating.
  std::chrono::nanoseconds sending{0};
  std::chrono::nanoseconds total{0};  // from the beginning to the end
  std::optional<Refusal> refusal;
  absl::Status status;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CALL_RECORD_H_
