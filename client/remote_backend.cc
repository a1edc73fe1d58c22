#include "client/remote_backend.h"

#include <grpcpp/client_context.h>

#include <algorithm>
#include <utility>

#include "client/raster_upload.h"
#include "client/spot_upload.h"
#include "client/surface_verifier.h"
#include "client/tile_verifier.h"

namespace terrane::client {
namespace {

// Writes the parts that `send` makes of the content, and ends the call.
template <typename Content, typename Request>
grpc::Status WriteParts(
    const Content& content,
    absl::Status (*send)(const Content&,
                         const std::function<absl::Status(const Request&)>&),
    grpc::ClientWriter<Request>* writer) {
  // A refused part shows as the status of Finish.
  const absl::Status sent = send(content, [&](const Request& part) {
    return writer->Write(part) ? absl::OkStatus()
                               : absl::CancelledError("refused");
  });
  if (sent.ok()) writer->WritesDone();
  return writer->Finish();
}

// What a message that is no header brings.
const v1::HeightTile& TileOf(const v1::StreamTilesResponse& message) {
  return message.tile();
}
const v1::StreamSurfaceResponse& MeshOrHeights(
    const v1::StreamSurfaceResponse& message) {
  return message;
}

}  // namespace

RemoteBackend::RemoteBackend(const std::string& server,
                             const ChannelSecurity& security, Patience patience)
    : caller_(server, security, std::move(patience)),
      terrain_(v1::TerrainService::NewStub(caller_.channel())),
      surface_(v1::SurfaceService::NewStub(caller_.channel())),
      raster_(v1::RasterService::NewStub(caller_.channel())),
      spot_table_(v1::SpotTableService::NewStub(caller_.channel())),
      info_(v1::InfoService::NewStub(caller_.channel())),
      trees_(&caller_),
      flowers_(&caller_),
      renders_(&caller_) {
  caller_.SetBringBack(
      [this](const std::string& content_id,
             std::stop_token stop) -> std::optional<absl::Status> {
        if (!uploads_.contains(content_id)) return std::nullopt;
        return UploadAgain(content_id, std::move(stop));
      });
}

absl::Status RemoteBackend::StreamTiles(const v1::StreamTilesRequest& request,
                                        const OnHeader& on_header,
                                        const OnTile& on_tile,
                                        std::stop_token stop) {
  TileVerifier verifier(request);
  v1::StreamTilesRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_tile(verifier.next_index());
    return terrain_->StreamTiles(context, rest);
  };
  return caller_.Stream<v1::StreamTilesResponse>(open, on_header, on_tile,
                                                 TileOf, stop, &verifier);
}

absl::Status RemoteBackend::StreamSurface(
    const v1::StreamSurfaceRequest& request, const OnSurfaceHeader& on_header,
    const OnSurfaceTile& on_tile, std::stop_token stop) {
  SurfaceVerifier verifier(request);
  v1::StreamSurfaceRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_tile(verifier.next_index());
    return surface_->StreamSurface(context, rest);
  };
  return caller_.Stream<v1::StreamSurfaceResponse>(
      open, on_header, on_tile, MeshOrHeights, stop, &verifier);
}

absl::StatusOr<v1::GetProfileResponse> RemoteBackend::GetProfile(
    const v1::GetProfileRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::GetProfileResponse>(
      terrain_.get(), &v1::TerrainService::Stub::GetProfile, request, stop);
}

absl::StatusOr<v1::GetHeightsResponse> RemoteBackend::GetHeights(
    const v1::GetHeightsRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::GetHeightsResponse>(
      terrain_.get(), &v1::TerrainService::Stub::GetHeights, request, stop);
}

absl::StatusOr<v1::EstimateTilesResponse> RemoteBackend::EstimateTiles(
    const v1::EstimateTilesRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::EstimateTilesResponse>(
      terrain_.get(), &v1::TerrainService::Stub::EstimateTiles, request, stop);
}

absl::StatusOr<v1::GetPresetResponse> RemoteBackend::GetPreset(
    const v1::GetPresetRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::GetPresetResponse>(
      terrain_.get(), &v1::TerrainService::Stub::GetPreset, request, stop);
}

absl::StatusOr<v1::GetServerInfoResponse> RemoteBackend::GetServerInfo(
    std::stop_token stop) {
  return caller_.Unary<v1::GetServerInfoResponse>(
      info_.get(), &v1::InfoService::Stub::GetServerInfo,
      v1::GetServerInfoRequest(), stop);
}

absl::StatusOr<v1::EstimateSurfaceResponse> RemoteBackend::EstimateSurface(
    const v1::EstimateSurfaceRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::EstimateSurfaceResponse>(
      surface_.get(), &v1::SurfaceService::Stub::EstimateSurface, request,
      stop);
}

absl::StatusOr<v1::GetSurfacePresetResponse> RemoteBackend::GetSurfacePreset(
    const v1::GetSurfacePresetRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::GetSurfacePresetResponse>(
      surface_.get(), &v1::SurfaceService::Stub::GetSurfacePreset, request,
      stop);
}

absl::StatusOr<v1::GetRasterResponse> RemoteBackend::GetRaster(
    const v1::GetRasterRequest& request, std::stop_token stop) {
  return caller_.Unary<v1::GetRasterResponse>(
      raster_.get(), &v1::RasterService::Stub::GetRaster, request, stop);
}

absl::StatusOr<v1::PreparedTerrain> RemoteBackend::PrepareTerrain(
    const v1::PrepareTerrainRequest& request,
    const OnPrepareProgress& on_progress, std::stop_token stop) {
  v1::PreparedTerrain prepared;
  double farthest = 0;
  const absl::Status status = caller_.Run(
      RemoteCaller::CallKind::kUnary,
      [&] {
        return PrepareOnce(request, on_progress, stop, &farthest, &prepared);
      },
      stop);
  if (!status.ok()) return status;
  return prepared;
}

RemoteCaller::Attempt RemoteBackend::PrepareOnce(
    const v1::PrepareTerrainRequest& request,
    const OnPrepareProgress& on_progress, std::stop_token stop,
    double* farthest, v1::PreparedTerrain* prepared) {
  StreamTry stream(stop, caller_.patience().stall);
  const auto reader = stream.Start([&](grpc::ClientContext* context) {
    return terrain_->PrepareTerrain(context, request);
  });
  RemoteCaller::Attempt attempt;
  bool complete = false;
  v1::PrepareTerrainResponse message;
  while (stream.Read(reader.get(), &message)) {
    attempt.answered = true;
    if (message.has_prepared()) {
      *prepared = message.prepared();
      complete = true;
      continue;
    }
    const double fraction = message.progress().fraction();
    // A server may well die of this preparation, each time at the same place.
    if (fraction > *farthest) attempt.progressed = true;
    *farthest = std::max(*farthest, fraction);
    if (on_progress) on_progress(fraction);
  }
  attempt.error = stream.Finish(reader.get());
  if (attempt.error.status.ok() && !complete) {
    attempt.error.status =
        absl::DataLossError("the server ended without a prepared terrain");
  }
  return attempt;
}

absl::StatusOr<std::string> RemoteBackend::UploadRaster(
    std::shared_ptr<const core::Raster> raster, std::stop_token stop) {
  return Upload(
      [this, raster](std::stop_token upload_stop, std::string* id) {
        return UploadRasterOnce(*raster, std::move(upload_stop), id);
      },
      stop);
}

absl::StatusOr<std::string> RemoteBackend::UploadSpotTable(
    std::shared_ptr<const SpotTable> table, std::stop_token stop) {
  return Upload(
      [this, table](std::stop_token upload_stop, std::string* id) {
        return UploadTableOnce(*table, std::move(upload_stop), id);
      },
      stop);
}

absl::StatusOr<std::string> RemoteBackend::Upload(const UploadContent& upload,
                                                  std::stop_token stop) {
  std::string content_id;
  const absl::Status status = caller_.Run(
      RemoteCaller::CallKind::kUnary, [&] { return upload(stop, &content_id); },
      stop);
  if (!status.ok()) return status;
  uploads_.insert_or_assign(content_id, upload);
  return content_id;
}

absl::Status RemoteBackend::UploadAgain(const std::string& content_id,
                                        std::stop_token stop) {
  // A copy: the upload keeps itself anew.
  const UploadContent upload = uploads_.at(content_id);
  const absl::StatusOr<std::string> answer = Upload(upload, stop);
  if (!answer.ok()) return answer.status();
  if (*answer != content_id) {
    return absl::DataLossError("the server calls the content " + content_id +
                               " now " + *answer);
  }
  return absl::OkStatus();
}

RemoteCaller::Attempt RemoteBackend::UploadRasterOnce(
    const core::Raster& raster, std::stop_token stop, std::string* raster_id) {
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  v1::UploadRasterResponse response;
  const auto writer = raster_->UploadRaster(&context, &response);
  RemoteCaller::Attempt attempt{
      DecodeStatus(WriteParts(raster, SendRaster, writer.get()),
                   context.GetServerTrailingMetadata())};
  *raster_id = response.raster_id();
  return attempt;
}

RemoteCaller::Attempt RemoteBackend::UploadTableOnce(const SpotTable& table,
                                                     std::stop_token stop,
                                                     std::string* table_id) {
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  v1::UploadSpotTableResponse response;
  const auto writer = spot_table_->UploadSpotTable(&context, &response);
  RemoteCaller::Attempt attempt{
      DecodeStatus(WriteParts(table, SendSpotTable, writer.get()),
                   context.GetServerTrailingMetadata())};
  *table_id = response.table_id();
  return attempt;
}

}  // namespace terrane::client
