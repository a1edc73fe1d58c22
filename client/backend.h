// Backend: whatever answers the API: a server across the network or the same
// code in this process. The commands are written against it and cannot tell.
//
// Threads: one call at a time, from any thread; `stop` may be asked for from
// any other. Errors: INVALID_ARGUMENT carries violations
// (core/base/violations.h), CANCELLED means that `stop` was asked for,
// UNAVAILABLE that nobody answers.
#ifndef TERRANE_CLIENT_BACKEND_H_
#define TERRANE_CLIENT_BACKEND_H_

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/flower_backend.h"
#include "client/render_backend.h"
#include "client/spot_table.h"
#include "client/tree_backend.h"
#include "core/grid/raster.h"
#include "terrane/v1/info.pb.h"
#include "terrane/v1/raster.pb.h"
#include "terrane/v1/surface.pb.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::client {

// Takes the header, once, before any tile.
using OnHeader = std::function<absl::Status(const v1::StreamHeader&)>;
// Takes the tiles in the order of their index. An error ends the stream and is
// what StreamTiles answers.
using OnTile = std::function<absl::Status(const v1::HeightTile&)>;

// The same of a surface; tiles come as the messages that hold them.
using OnSurfaceHeader = std::function<absl::Status(const v1::SurfaceHeader&)>;
using OnSurfaceTile =
    std::function<absl::Status(const v1::StreamSurfaceResponse&)>;
// Takes the share of a preparation that is done, 0 to 1.
using OnPrepareProgress = std::function<void(double)>;

class Backend {
 public:
  virtual ~Backend() = default;

  // Tiles arrive verified (client/tile_verifier.h) and each exactly once, also
  // when the connection was cut and resumed in between.
  virtual absl::Status StreamTiles(const v1::StreamTilesRequest& request,
                                   const OnHeader& on_header,
                                   const OnTile& on_tile,
                                   std::stop_token stop) = 0;
  // Progress starts again from 0 when a lost server's work is done again.
  virtual absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(
      const v1::PrepareTerrainRequest& request,
      const OnPrepareProgress& on_progress, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetProfileResponse> GetProfile(
      const v1::GetProfileRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetHeightsResponse> GetHeights(
      const v1::GetHeightsRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::EstimateTilesResponse> EstimateTiles(
      const v1::EstimateTilesRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetPresetResponse> GetPreset(
      const v1::GetPresetRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetServerInfoResponse> GetServerInfo(
      std::stop_token stop) = 0;

  // As StreamTiles, verified by client/surface_verifier.h.
  virtual absl::Status StreamSurface(const v1::StreamSurfaceRequest& request,
                                     const OnSurfaceHeader& on_header,
                                     const OnSurfaceTile& on_tile,
                                     std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::EstimateSurfaceResponse> EstimateSurface(
      const v1::EstimateSurfaceRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetSurfacePresetResponse> GetSurfacePreset(
      const v1::GetSurfacePresetRequest& request, std::stop_token stop) = 0;

  // Uploads a raster whose posts without data are NaN, and answers its id. The
  // backend keeps the raster: a server that has evicted it gets it again.
  virtual absl::StatusOr<std::string> UploadRaster(
      std::shared_ptr<const core::Raster> raster, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetRasterResponse> GetRaster(
      const v1::GetRasterRequest& request, std::stop_token stop) = 0;

  // The same for a table of spot heights.
  virtual absl::StatusOr<std::string> UploadSpotTable(
      std::shared_ptr<const SpotTable> table, std::stop_token stop) = 0;

  // The other services; they live as long as this.
  virtual TreeBackend& trees() = 0;
  virtual FlowerBackend& flowers() = 0;
  virtual RenderBackend& renders() = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BACKEND_H_
