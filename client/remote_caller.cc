#include "client/remote_caller.h"

#include <grpcpp/create_channel.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <utility>

#include "client/channel.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

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

// What stubs can be made of where no channel can be: every call on it fails.
std::shared_ptr<grpc::Channel> LameChannel(const std::string& server) {
  return grpc::CreateChannel(server, nullptr);
}

}  // namespace

RemoteCaller::RemoteCaller(const std::string& server,
                           const ChannelSecurity& security)
    : target_(server),
      opened_(OpenChannel(server, security, ChannelKind::kShared)),
      channel_(opened_.ok() ? *opened_ : LameChannel(server)) {}

absl::Status RemoteCaller::Run(CallKind kind,
                               const std::function<Attempt()>& attempt,
                               std::stop_token stop) {
  if (!opened_.ok()) return opened_.status();
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
