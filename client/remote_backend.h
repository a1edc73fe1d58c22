// RemoteBackend: the API of a server across the network, over gRPC.
//
// What it adds to the generated stubs: the patience of a RemoteCaller; every
// tile verified; a raster or spot table that the server has evicted, or that
// another replica has, uploaded again, a few times a call.
#ifndef TERRANE_CLIENT_REMOTE_BACKEND_H_
#define TERRANE_CLIENT_REMOTE_BACKEND_H_

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "client/backend.h"
#include "client/remote_caller.h"
#include "client/remote_flowers.h"
#include "client/remote_renders.h"
#include "client/remote_trees.h"
#include "terrane/v1/info.grpc.pb.h"
#include "terrane/v1/raster.grpc.pb.h"
#include "terrane/v1/spot_table.grpc.pb.h"
#include "terrane/v1/surface.grpc.pb.h"
#include "terrane/v1/terrain.grpc.pb.h"

namespace terrane::client {

class RemoteBackend : public Backend {
 public:
  // `server` is as client/server_address.h reads it. Connects with the first
  // call.
  explicit RemoteBackend(const std::string& server,
                         const ChannelSecurity& security = {},
                         Patience patience = {});

  absl::Status StreamTiles(const v1::StreamTilesRequest& request,
                           const OnHeader& on_header, const OnTile& on_tile,
                           std::stop_token stop) override;
  absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(
      const v1::PrepareTerrainRequest& request,
      const OnPrepareProgress& on_progress, std::stop_token stop) override;
  absl::StatusOr<v1::GetProfileResponse> GetProfile(
      const v1::GetProfileRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetHeightsResponse> GetHeights(
      const v1::GetHeightsRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::EstimateTilesResponse> EstimateTiles(
      const v1::EstimateTilesRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetPresetResponse> GetPreset(
      const v1::GetPresetRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetServerInfoResponse> GetServerInfo(
      std::stop_token stop) override;
  absl::Status StreamSurface(const v1::StreamSurfaceRequest& request,
                             const OnSurfaceHeader& on_header,
                             const OnSurfaceTile& on_tile,
                             std::stop_token stop) override;
  absl::StatusOr<v1::EstimateSurfaceResponse> EstimateSurface(
      const v1::EstimateSurfaceRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetSurfacePresetResponse> GetSurfacePreset(
      const v1::GetSurfacePresetRequest& request,
      std::stop_token stop) override;
  absl::StatusOr<std::string> UploadRaster(
      std::shared_ptr<const core::Raster> raster,
      std::stop_token stop) override;
  absl::StatusOr<v1::GetRasterResponse> GetRaster(
      const v1::GetRasterRequest& request, std::stop_token stop) override;
  absl::StatusOr<std::string> UploadSpotTable(
      std::shared_ptr<const SpotTable> table, std::stop_token stop) override;
  TreeBackend& trees() override { return trees_; }
  FlowerBackend& flowers() override { return flowers_; }
  RenderBackend& renders() override { return renders_; }

 private:
  using Attempt = RemoteCaller::Attempt;

  // Uploads content, and keeps how to do it again.
  using UploadContent = std::function<Attempt(std::stop_token, std::string*)>;
  absl::StatusOr<std::string> Upload(const UploadContent& upload,
                                     std::stop_token stop);
  absl::Status UploadAgain(const std::string& content_id, std::stop_token stop);
  Attempt UploadRasterOnce(const core::Raster& raster, std::stop_token stop,
                           std::string* raster_id);
  Attempt UploadTableOnce(const SpotTable& table, std::stop_token stop,
                          std::string* table_id);
  Attempt PrepareOnce(const v1::PrepareTerrainRequest& request,
                      const OnPrepareProgress& on_progress,
                      std::stop_token stop, double* farthest,
                      v1::PreparedTerrain* prepared);

  RemoteCaller caller_;
  std::unique_ptr<v1::TerrainService::Stub> terrain_;
  std::unique_ptr<v1::SurfaceService::Stub> surface_;
  std::unique_ptr<v1::RasterService::Stub> raster_;
  std::unique_ptr<v1::SpotTableService::Stub> spot_table_;
  std::unique_ptr<v1::InfoService::Stub> info_;
  RemoteTrees trees_;
  RemoteFlowers flowers_;
  RemoteRenders renders_;
  // What was uploaded so far, by id.
  std::map<std::string, UploadContent> uploads_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_REMOTE_BACKEND_H_
