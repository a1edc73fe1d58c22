// RemoteCaller: one server across the network, called with patience.
//
// What the services' clients share: a channel; calls that are tried again, with
// bounded, jittered waits, when that can help; cut streams opened again at what
// is missing; errors with their details. A server that was never reached is
// given up within a second.
//
// Threads: one call at a time, from any thread.
#ifndef TERRANE_CLIENT_REMOTE_CALLER_H_
#define TERRANE_CLIENT_REMOTE_CALLER_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/channel_security.h"
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

class RemoteCaller {
 public:
  // What became of one try of a call.
  struct Attempt {
    RemoteError error;
    // Something new came before it failed: the server is there.
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
                        const ChannelSecurity& security = {});

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }
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
  bool Wait(const RemoteError& error, int failures, std::stop_token stop);

  const std::string target_;
  const absl::StatusOr<std::shared_ptr<grpc::Channel>> opened_;
  const std::shared_ptr<grpc::Channel> channel_;
  BringBack bring_back_;
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
        return Attempt{
            DecodeStatus((stub->*method)(&context, request, &response))};
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
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  const auto reader = open(&context);

  Attempt attempt;
  absl::Status status;
  Message message;
  while (status.ok() && reader->Read(&message)) {
    if (message.has_header()) {
      const bool first = !verifier->has_header();
      status = verifier->CheckHeader(message.header());
      if (status.ok() && first) {
        status = on_header(message.header());
        attempt.final = !status.ok();
        attempt.progressed = true;
      }
    } else {
      status = verifier->CheckTile(part_of(message));
      if (status.ok()) {
        status = on_part(part_of(message));
        attempt.final = !status.ok();
        attempt.progressed = true;
      }
    }
  }
  if (!status.ok()) {
    context.TryCancel();
    reader->Finish();
    attempt.error.status = status;
    return attempt;
  }
  attempt.error = DecodeStatus(reader->Finish());
  if (attempt.error.status.ok()) attempt.error.status = verifier->CheckEnd();
  return attempt;
}

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_REMOTE_CALLER_H_
