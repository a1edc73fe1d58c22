// One call of a load test, in flight: sent without waiting, every message
// verified as it comes, its result handed on once.
//
// Calls run in gRPC's own threads (the callback API), so that hundreds in
// flight cost no thread each. `on_result` is called once after Start, from such
// a thread; it may destroy the call.
#ifndef TERRANE_CLIENT_BENCH_LOAD_CALL_H_
#define TERRANE_CLIENT_BENCH_LOAD_CALL_H_

#include <grpcpp/channel.h>
#include <grpcpp/support/status_code_enum.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/bench/request_mix.h"
#include "client/bench/workload.h"
#include "client/channel_security.h"

namespace terrane::client {

using LoadClock = std::chrono::steady_clock;

// What a call brought.
struct CallResult {
  // The server's, or DATA_LOSS: what came is not what was asked for.
  grpc::StatusCode code = grpc::StatusCode::OK;
  std::string message;
  // How long a refusing server asks to stay away.
  std::optional<std::chrono::milliseconds> retry_delay;
  // When the first message that holds data came; not set when none did.
  std::optional<LoadClock::time_point> first_data;
  LoadClock::time_point end;
  // Messages that hold data: tiles, blocks of rows, parts of flowers.
  std::int64_t tiles = 0;
  // Heights, vertices, segments and instances in them, and their bytes.
  std::int64_t samples = 0;
  std::int64_t bytes = 0;
};

class LoadCall {
 public:
  using OnResult = std::function<void(CallResult)>;

  virtual ~LoadCall() = default;
  virtual void Start() = 0;
  // From any thread, while the call lives; its result still comes.
  virtual void Cancel() = 0;
};

// Makes the calls of a load test.
class CallMaker {
 public:
  virtual ~CallMaker() = default;
  // Not started yet. The call fails when it has not ended by `deadline`.
  virtual std::unique_ptr<LoadCall> Make(const PlannedRequest& plan,
                                         LoadClock::time_point deadline,
                                         LoadCall::OnResult on_result) = 0;
};

// Over `connections` channels to `server` in turn, each with a TCP connection
// of its own (to each replica, if there are several). Clients of the mix are
// told apart by the header x-forwarded-for, which a server heeds with
// --trust-forwarded-for: gRPC cannot bind a connection to an address of its
// own. `workload` must outlive what is returned. Errors: those of OpenChannel.
absl::StatusOr<std::unique_ptr<CallMaker>> MakeGrpcCalls(
    const std::string& server, const ChannelSecurity& security, int connections,
    int clients, const Workload* workload);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_LOAD_CALL_H_
