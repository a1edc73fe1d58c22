#include "server/service/terrain_source.h"

#include <grpcpp/impl/codegen/proto_utils.h>

#include <utility>

#include "server/service/tile_message.h"

namespace terrane::server {
namespace {

class TerrainSource : public StreamSource {
 public:
  TerrainSource(const ServiceParts& parts, const grpc::ByteBuffer& request)
      : parts_(parts), request_(request) {}

  absl::StatusOr<grpc::ByteBuffer> Open(std::stop_token stop,
                                        CallRecord* record) override {
    v1::StreamTilesRequest request;
    const grpc::Status parsed =
        grpc::SerializationTraits<v1::StreamTilesRequest>::Deserialize(
            &request_, &request);
    if (!parsed.ok()) {
      return absl::InvalidArgumentError(
          "the request is not a StreamTilesRequest");
    }
    auto job = parts_.actor->OpenTiles(request, std::move(stop));
    if (!job.ok()) return job.status();
    job_ = *std::move(job);
    next_tile_ = job_->first();
    record->recipe_hash = job_->header().recipe_hash();
    return HeaderMessage(job_->header());
  }

  double EstimatedSeconds() const override { return job_->EstimatedSeconds(); }

  bool AllMade() const override { return next_tile_ == job_->total(); }

  absl::StatusOr<grpc::ByteBuffer> Next(std::stop_token stop,
                                        core::TileScratch* scratch,
                                        CallRecord* record) override {
    tile_.set_allocated_data(parts_.buffers->Take().release());
    const absl::Status status =
        job_->MakeTile(next_tile_, std::move(stop), scratch, &tile_);
    if (!status.ok()) return status;
    ++next_tile_;
    record->tiles += 1;
    record->samples += tile_.window().width() * tile_.window().height();
    record->bytes += static_cast<std::int64_t>(tile_.data().size());
    return TakeTileMessage(parts_.buffers, &tile_);
  }

 private:
  const ServiceParts& parts_;
  grpc::ByteBuffer request_;
  std::shared_ptr<const TileJob> job_;
  std::int64_t next_tile_ = 0;
  v1::HeightTile tile_;
};

}  // namespace

std::unique_ptr<StreamSource> MakeTerrainSource(
    const ServiceParts& parts, const grpc::ByteBuffer& request) {
  return std::make_unique<TerrainSource>(parts, request);
}

}  // namespace terrane::server
