// RunSource: the messages of a MessageRun (server/actor/message_run.h) as a
// StreamSource.
#ifndef TERRANE_SERVER_SERVICE_RUN_SOURCE_H_
#define TERRANE_SERVER_SERVICE_RUN_SOURCE_H_

#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/actor/message_run.h"
#include "server/service/stream_source.h"

namespace terrane::server {

template <typename Request, typename Message>
class RunSource : public StreamSource {
 public:
  using OpenRun =
      std::function<OpenedRun<Message>(const Request&, std::stop_token)>;

  // `request` holds a serialized Request.
  RunSource(const grpc::ByteBuffer& request, OpenRun open)
      : request_(request), open_(std::move(open)) {}

  absl::StatusOr<grpc::ByteBuffer> Open(std::stop_token stop,
                                        CallRecord* record) override {
    Request request;
    if (!grpc::SerializationTraits<Request>::Deserialize(&request_, &request)
             .ok()) {
      return absl::InvalidArgumentError("the request is not a " +
                                        Request::descriptor()->name());
    }
    auto run = open_(request, stop);
    if (!run.ok()) return run.status();
    run_ = *std::move(run);
    record->recipe_hash = run_->recipe_hash();
    return Make(std::move(stop));
  }

  double EstimatedSeconds() const override { return run_->EstimatedSeconds(); }

  bool AllMade() const override { return run_->Done(); }

  absl::StatusOr<grpc::ByteBuffer> Next(std::stop_token stop,
                                        core::TileScratch*,
                                        CallRecord* record) override {
    auto bytes = Make(std::move(stop));
    if (!bytes.ok()) return bytes;
    record->tiles += 1;
    record->samples += run_->last_items();
    record->bytes += static_cast<std::int64_t>(bytes->Length());
    return bytes;
  }

 private:
  absl::StatusOr<grpc::ByteBuffer> Make(std::stop_token stop) {
    const absl::Status made = run_->Next(std::move(stop), &message_);
    if (!made.ok()) return made;
    grpc::ByteBuffer bytes;
    bool own = false;
    const grpc::Status status =
        grpc::SerializationTraits<Message>::Serialize(message_, &bytes, &own);
    if (!status.ok()) return absl::InternalError(status.error_message());
    return bytes;
  }

  grpc::ByteBuffer request_;
  const OpenRun open_;
  std::unique_ptr<MessageRun<Message>> run_;
  // Keeps its memory from message to message.
  Message message_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_RUN_SOURCE_H_
