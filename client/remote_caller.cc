#include "client/remote_caller.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <utility>

#include "client/server_address.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

// A tile of the largest size is just over gRPC's default of 4 MiB.
constexpr int kMaxMessageBytes = 64 << 20;

// Tries in a row that bring nothing new: few when the server was never reached,
// so that a wrong address shows at once; more to outlast a restart.
constexpr int kTriesBeforeContact = 3;
constexpr int kTriesAfterContact = 9;

constexpr milliseconds kFirstWait{100};
constexpr milliseconds kLongestWait{2'000};
constexpr milliseconds kLongestAskedWait{30'000};

bool WorthAnotherTry(const RemoteError& error, bool stream) {
  switch (error.status.code()) {
    case absl::StatusCode::kUnavailable:
      return true;
    case absl::StatusCode::kResourceExhausted:
      return error.retry_delay.has_value();
    // What a balancer answers when its backend dies, and a damaged tile.
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kDataLoss:
      return stream;
    default:
      return false;
  }
}

// Sleeps; false when asked to stop meanwhile.
bool Sleep(milliseconds duration, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
  return !stop.stop_requested();
}

}  // namespace

std::shared_ptr<grpc::Channel> MakeChannel(const std::string& server,
                                           ChannelKind kind) {
  const ServerAddress address =
      ParseServerAddress(server).value_or(ServerAddress{server});
  grpc::ChannelArguments arguments;
  // A proxy of the environment is the way to other machines.
  if (address.loopback) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  if (address.several) arguments.SetLoadBalancingPolicyName("round_robin");
  if (kind == ChannelKind::kOwnConnection) {
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  }
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  // A restarted server is found again within our own waits.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1'000);
  return grpc::CreateCustomChannel(
      address.target, grpc::InsecureChannelCredentials(), arguments);
}

RemoteCaller::RemoteCaller(const std::string& server)
    : target_(server), channel_(MakeChannel(server, ChannelKind::kShared)) {}

absl::Status RemoteCaller::Run(CallKind kind,
                               const std::function<Attempt()>& attempt,
                               std::stop_token stop) {
  int failures = 0;
  int allowed = kTriesBeforeContact;
  std::set<std::string> brought_back;
  while (true) {
    const Attempt result = attempt();
    const RemoteError& error = result.error;
    if (error.status.ok() || result.final) return error.status;
    if (stop.stop_requested()) return absl::CancelledError("interrupted");
    if (bring_back_ && !error.missing_content.empty() &&
        brought_back.insert(error.missing_content).second) {
      const std::optional<absl::Status> status =
          bring_back_(error.missing_content, stop);
      if (status.has_value()) {
        if (!status->ok()) return *status;
        continue;
      }
    }
    if (result.progressed) {
      failures = 0;
      allowed = kTriesAfterContact;
    }
    ++failures;
    if (!WorthAnotherTry(error, kind == CallKind::kStream) ||
        failures >= allowed) {
      if (error.status.code() != absl::StatusCode::kUnavailable) {
        return error.status;
      }
      return absl::UnavailableError("server " + target_ + " does not answer: " +
                                    std::string(error.status.message()));
    }
    if (!Wait(error, failures, stop)) {
      return absl::CancelledError("interrupted");
    }
  }
}

bool RemoteCaller::Wait(const RemoteError& error, int failures,
                        std::stop_token stop) {
  const milliseconds backoff =
      std::min(kFirstWait * (1 << std::min(failures - 1, 10)), kLongestWait);
  // Between half and one and a half of it, so that clients do not return
  // together.
  std::uniform_int_distribution<milliseconds::rep> spread(
      backoff.count() / 2, backoff.count() * 3 / 2);
  milliseconds wait(spread(jitter_));
  if (error.retry_delay.has_value()) {
    wait += std::min(*error.retry_delay, kLongestAskedWait);
  }
  return Sleep(wait, stop);
}

}  // namespace terrane::client
