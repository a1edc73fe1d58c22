// RemoteCaller: one server across the network, called with patience.
//
// What the services' clients share: a channel; calls that are tried again, with
// bounded, jittered waits, when that can help; cut or stalled streams opened
// again at what is missing; errors with their details. A server that was never
// reached is given up soon: within a second where nobody listens, after some
// seconds where no answer comes at all. One that has ever answered is given
// the time to restart.
//
// Threads: one call at a time, from any thread.
#ifndef TERRANE_CLIENT_REMOTE_CALLER_H_
#define TERRANE_CLIENT_REMOTE_CALLER_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/channel_security.h"
#include "client/patience.h"
#include "client/stall_watch.h"
#include "client/status_details.h"

namespace terrane::client {

// Cancels the call on the server as soon as `stop` is asked for.
class CancelOnStop {
 public:
  CancelOnStop(std::stop_token stop, grpc::ClientContext* context)
      : callback_(std::move(stop), Cancel{context}) {}

 private:
  struct Cancel {
    void operator()() const { context->TryCancel(); }
    grpc::ClientContext* context;
  };
  std::stop_callback<Cancel> callback_;
};

// One try of a call that brings a stream: cancelled when asked to stop, and
// when nothing comes for too long.
class StreamTry {
 public:
  // 0: it may take for ever.
  StreamTry(std::stop_token stop, std::chrono::milliseconds stall)
      : cancel_(std::move(stop), &context_),
        stall_(stall),
        watch_(stall, [this] { context_.TryCancel(); }) {}

  template <typename Open>
  auto Start(const Open& open) {
    return watch_.During([&] { return open(&context_); });
  }
  template <typename Reader, typename Message>
  bool Read(Reader* reader, Message* message) {
    return watch_.During([&] { return reader->Read(message); });
  }
  template <typename Reader>
  RemoteError Finish(Reader* reader) {
    const grpc::Status status = watch_.During([&] { return reader->Finish(); });
    if (!status.ok() && watch_.stalled()) return StallError();
    return DecodeStatus(status, context_.GetServerTrailingMetadata());
  }
  void Cancel() { context_.TryCancel(); }

 private:
  RemoteError StallError() const;

  grpc::ClientContext context_;
  const CancelOnStop cancel_;
  const std::chrono::milliseconds stall_;
  StallWatch watch_;
};

class RemoteCaller {
 public:
  // What became of one try of a call.
  struct Attempt {
    RemoteError error;
    // A message came.
    bool answered = false;
    // The next try has less to do.
    bool progressed = false;
    // The failure is the caller's own (a full disk), so trying again is futile.
    bool final = false;
  };
  enum class CallKind { kUnary, kStream };
  // Brings content back that the server has evicted; nothing when there is
  // none by that id to bring.
  using BringBack = std::function<std::optional<absl::Status>(
      const std::string& content_id, std::stop_token stop)>;

  // `server` is as client/server_address.h reads it. Connects with the first
  // call; where the channel cannot be opened (client/channel.h), every call
  // answers why.
  explicit RemoteCaller(const std::string& server,
                        const ChannelSecurity& security = {},
                        Patience patience = {});

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }
  const Patience& patience() const { return patience_; }
  void SetBringBack(BringBack bring_back) {
    bring_back_ = std::move(bring_back);
  }

  absl::Status Run(CallKind kind, const std::function<Attempt()>& attempt,
                   std::stop_token stop);

  // One unary call; `method` is a member of the stub.
  template <typename Response, typename Stub, typename Method, typename Request>
  absl::StatusOr<Response> Unary(Stub* stub, Method method,
                                 const Request& request, std::stop_token stop);

  // A stream, opened again where it was cut: `open` starts it at what is
  // missing, the verifier knows which. `part_of` is what of a message that is
  // no header is checked and handed on.
  template <typename Message, typename Open, typename Header, typename Part,
            typename PartOf, typename Verifier>
  absl::Status Stream(const Open& open, const Header& on_header,
                      const Part& on_part, const PartOf& part_of,
                      std::stop_token stop, Verifier* verifier);

 private:
  template <typename Message, typename Open, typename Header, typename Part,
            typename PartOf, typename Verifier>
  Attempt StreamOnce(const Open& open, const Header& on_header,
                     const Part& on_part, const PartOf& part_of,
                     std::stop_token stop, Verifier* verifier);
  std::optional<absl::Status> BringBackTo(int replicas,
                                          const std::string& content_id,
                                          std::stop_token stop);
  absl::Status GivenUp(const absl::Status& status) const;
  bool Wait(const RemoteError& error, int failures, std::stop_token stop);

  const std::string target_;
  const Patience patience_;
  const absl::StatusOr<std::shared_ptr<grpc::Channel>> opened_;
  const std::shared_ptr<grpc::Channel> channel_;
  BringBack bring_back_;
  // The server has answered, in this call or an earlier one.
  bool reached_ = false;
  // Jitter of the waits; never touches a result.
  std::mt19937 jitter_{std::random_device{}()};
};

template <typename Response, typename Stub, typename Method, typename Request>
absl::StatusOr<Response> RemoteCaller::Unary(Stub* stub, Method method,
                                             const Request& request,
                                             std::stop_token stop) {
  Response response;
  const absl::Status status = Run(
      CallKind::kUnary,
      [&] {
        grpc::ClientContext context;
        const CancelOnStop cancel(stop, &context);
        const grpc::Status answer =
            (stub->*method)(&context, request, &response);
        return Attempt{
            DecodeStatus(answer, context.GetServerTrailingMetadata())};
      },
      stop);
  if (!status.ok()) return status;
  return response;
}

template <typename Message, typename Open, typename Header, typename Part,
          typename PartOf, typename Verifier>
absl::Status RemoteCaller::Stream(const Open& open, const Header& on_header,
                                  const Part& on_part, const PartOf& part_of,
                                  std::stop_token stop, Verifier* verifier) {
  return Run(
      CallKind::kStream,
      [&] {
        return StreamOnce<Message>(open, on_header, on_part, part_of, stop,
                                   verifier);
      },
      stop);
}

template <typename Message, typename Open, typename Header, typename Part,
          typename PartOf, typename Verifier>
RemoteCaller::Attempt RemoteCaller::StreamOnce(
    const Open& open, const Header& on_header, const Part& on_part,
    const PartOf& part_of, std::stop_token stop, Verifier* verifier) {
  StreamTry stream(stop, patience_.stall);
  const auto reader = stream.Start(open);
  const std::int64_t first_missing = verifier->next_index();

  Attempt attempt;
  absl::Status status;
  Message message;
  while (status.ok() && stream.Read(reader.get(), &message)) {
    attempt.answered = true;
    if (message.has_header()) {
      const bool first = !verifier->has_header();
      status = verifier->CheckHeader(message.header());
      if (status.ok() && first) {
        status = on_header(message.header());
        attempt.final = !status.ok();
      }
    } else {
      status = verifier->CheckTile(part_of(message));
      if (status.ok()) {
        status = on_part(part_of(message));
        attempt.final = !status.ok();
      }
    }
  }
  attempt.progressed = verifier->next_index() > first_missing;
  if (!status.ok()) {
    stream.Cancel();
    stream.Finish(reader.get());
    attempt.error.status = status;
    return attempt;
  }
  attempt.error = stream.Finish(reader.get());
  if (attempt.error.status.ok()) attempt.error.status = verifier->CheckEnd();
  return attempt;
}

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_REMOTE_CALLER_H_
