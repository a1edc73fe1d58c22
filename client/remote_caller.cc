#include "client/remote_caller.h"

#include <grpcpp/create_channel.h>

#include <map>
#include <utility>

#include "client/channel.h"

namespace terrane::client {
namespace {

// Tries in a row that bring nothing new: few when the server was never reached,
// so that a wrong address shows at once; more to outlast a restart.
constexpr int kTriesUnreached = 3;
constexpr int kTriesReached = 9;

// How often a call may miss the same content before that is its answer.
constexpr int kMissesOfContent = 3;

bool WorthAnotherTry(const RemoteError& error, bool stream) {
  if (error.turned_away) return false;
  switch (error.status.code()) {
    case absl::StatusCode::kUnavailable:
      return true;
    case absl::StatusCode::kResourceExhausted:
      return error.retry_delay.has_value();
    // Of a server that waited for too long for a reader that was suspended, or
    // for its calls to end before it does.
    case absl::StatusCode::kCancelled:
    // What a balancer answers when its backend dies, and a damaged tile.
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kDataLoss:
      return stream;
    default:
      return false;
  }
}

// Whether the server had a part in it: of itself gRPC says UNAVAILABLE, where
// it does not get through.
bool IsAnswer(const RemoteCaller::Attempt& attempt) {
  const RemoteError& error = attempt.error;
  return attempt.answered || error.retry_delay.has_value() ||
         error.status.code() != absl::StatusCode::kUnavailable;
}

// What stubs can be made of where no channel can be: every call on it fails.
std::shared_ptr<grpc::Channel> LameChannel(const std::string& server) {
  return grpc::CreateChannel(server, nullptr);
}

}  // namespace

RemoteError StreamTry::StallError() const {
  RemoteError error;
  error.status = absl::UnavailableError(
      "nothing came for " +
      std::to_string(std::chrono::duration<double>(stall_).count()) +
      " seconds");
  return error;
}

RemoteCaller::RemoteCaller(const std::string& server,
                           const ChannelSecurity& security, Patience patience)
    : target_(server),
      patience_(std::move(patience)),
      opened_(OpenChannel(server, security, ChannelKind::kShared,
                          patience_.ping_after)),
      channel_(opened_.ok() ? *opened_ : LameChannel(server)) {}

absl::Status RemoteCaller::Run(CallKind kind,
                               const std::function<Attempt()>& attempt,
                               std::stop_token stop) {
  if (!opened_.ok()) return opened_.status();
  int failures = 0;
  std::map<std::string, int> misses;
  while (true) {
    const Attempt result = attempt();
    const RemoteError& error = result.error;
    reached_ = reached_ || IsAnswer(result);
    if (error.status.ok() || result.final) return error.status;
    if (stop.stop_requested()) return absl::CancelledError("interrupted");
    if (bring_back_ && !error.missing_content.empty()) {
      const int missed = ++misses[error.missing_content];
      const auto brought = BringBackTo(missed, error.missing_content, stop);
      if (brought.has_value()) {
        if (!brought->ok()) return *brought;
        continue;
      }
    }
    failures = result.progressed ? 1 : failures + 1;
    if (!WorthAnotherTry(error, kind == CallKind::kStream) ||
        failures >= (reached_ ? kTriesReached : kTriesUnreached)) {
      return GivenUp(error.status);
    }
    if (!Wait(error, failures, stop)) {
      return absl::CancelledError("interrupted");
    }
  }
}

// Uploads take turns between replicas as other calls do, so one may well pass
// the replica that missed the content: with each miss there are more of them.
std::optional<absl::Status> RemoteCaller::BringBackTo(
    int replicas, const std::string& content_id, std::stop_token stop) {
  if (replicas > kMissesOfContent) return std::nullopt;
  std::optional<absl::Status> status;
  for (int i = 0; i < replicas; ++i) {
    status = bring_back_(content_id, stop);
    if (!status.has_value() || !status->ok()) break;
  }
  return status;
}

absl::Status RemoteCaller::GivenUp(const absl::Status& status) const {
  if (status.code() == absl::StatusCode::kCancelled) {
    // Not by who asked for it.
    return absl::AbortedError("server " + target_ + " ended the call: " +
                              std::string(status.message()));
  }
  if (status.code() != absl::StatusCode::kUnavailable) return status;
  return absl::UnavailableError("server " + target_ + " does not answer: " +
                                std::string(status.message()));
}

bool RemoteCaller::Wait(const RemoteError& error, int failures,
                        std::stop_token stop) {
  std::uniform_real_distribution<double> spread(0, 1);
  return patience_.wait(
      WaitBeforeNextTry(failures, error.retry_delay, spread(jitter_)),
      std::move(stop));
}

}  // namespace terrane::client
