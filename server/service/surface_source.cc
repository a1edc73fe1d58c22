#include "server/service/surface_source.h"

#include <grpcpp/impl/codegen/proto_utils.h>

#include <utility>

#include "absl/status/status.h"

namespace terrane::server {
namespace {

absl::StatusOr<grpc::ByteBuffer> Serialized(
    const v1::StreamSurfaceResponse& message) {
  grpc::ByteBuffer bytes;
  bool own = false;
  const grpc::Status status =
      grpc::SerializationTraits<v1::StreamSurfaceResponse>::Serialize(
          message, &bytes, &own);
  if (!status.ok()) return absl::InternalError(status.error_message());
  return bytes;
}

class SurfaceSource : public StreamSource {
 public:
  SurfaceSource(const ServiceParts& parts, const grpc::ByteBuffer& request)
      : parts_(parts), request_(request) {}

  absl::StatusOr<grpc::ByteBuffer> Open(std::stop_token,
                                        CallRecord* record) override {
    v1::StreamSurfaceRequest request;
    const grpc::Status parsed =
        grpc::SerializationTraits<v1::StreamSurfaceRequest>::Deserialize(
            &request_, &request);
    if (!parsed.ok()) {
      return absl::InvalidArgumentError(
          "the request is not a StreamSurfaceRequest");
    }
    auto job = parts_.actor->surfaces().Open(request);
    if (!job.ok()) return job.status();
    job_ = *std::move(job);
    next_tile_ = job_->first();
    record->recipe_hash = job_->header().recipe_hash();
    v1::StreamSurfaceResponse message;
    *message.mutable_header() = job_->header();
    return Serialized(message);
  }

  double EstimatedSeconds() const override { return job_->EstimatedSeconds(); }

  bool AllMade() const override { return next_tile_ == job_->total(); }

  absl::StatusOr<grpc::ByteBuffer> Next(std::stop_token stop,
                                        core::TileScratch*,
                                        CallRecord* record) override {
    const absl::Status status =
        job_->MakeTile(next_tile_, std::move(stop), &message_);
    if (!status.ok()) return status;
    ++next_tile_;
    const v1::Window& window = message_.has_mesh_tile()
                                   ? message_.mesh_tile().window()
                                   : message_.height_tile().window();
    record->tiles += 1;
    record->samples += window.width() * window.height();
    auto bytes = Serialized(message_);
    if (bytes.ok()) {
      record->bytes += static_cast<std::int64_t>(bytes->Length());
    }
    return bytes;
  }

 private:
  const ServiceParts& parts_;
  grpc::ByteBuffer request_;
  std::shared_ptr<const SurfaceJob> job_;
  std::int64_t next_tile_ = 0;
  // Keeps its memory from tile to tile.
  v1::StreamSurfaceResponse message_;
};

}  // namespace

std::unique_ptr<StreamSource> MakeSurfaceSource(
    const ServiceParts& parts, const grpc::ByteBuffer& request) {
  return std::make_unique<SurfaceSource>(parts, request);
}

}  // namespace terrane::server
