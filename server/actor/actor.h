// Actor: the whole service without a network. Messages in, messages out.
//
// What a request goes through is the same for a gRPC call, for the command
// line's --local mode, for benches and for fuzzers: convert and validate ->
// estimate -> prepare -> generate. The gRPC services are thin over this class;
// it knows nothing of gRPC, and the client links it for --local.
//
// Threads: every method may be called from any thread at any time. Errors are
// absl::Status: violations for INVALID_ARGUMENT (core/base/violations.h), a
// reason for NOT_FOUND (server/actor/error_reason.h).
#ifndef TERRANE_SERVER_ACTOR_ACTOR_H_
#define TERRANE_SERVER_ACTOR_ACTOR_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/terrain/terrain.h"
#include "server/actor/flower_maker.h"
#include "server/actor/limits.h"
#include "server/actor/render_maker.h"
#include "server/actor/surface_job.h"
#include "server/actor/tree_maker.h"
#include "terrane/v1/info.pb.h"
#include "terrane/v1/raster.pb.h"
#include "terrane/v1/spot_table.pb.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

// One admitted StreamTiles request. Immutable; tiles may be made in any order,
// by several threads at a time, each with its own scratch.
class TileJob {
 public:
  virtual ~TileJob() = default;

  virtual const v1::StreamHeader& header() const = 0;
  // Tiles of the request, and the index of the first one to send.
  virtual std::int64_t total() const = 0;
  virtual std::int64_t first() const = 0;
  // What the tiles from first() on take on one core of this machine, as such
  // work did so far.
  virtual double EstimatedSeconds() const = 0;
  // Generates and encodes tile `index`, first() <= index < total().
  virtual absl::Status MakeTile(std::int64_t index, std::stop_token stop,
                                core::TileScratch* scratch,
                                v1::HeightTile* tile) const = 0;
};

// Content on its way in. Belongs to one thread at a time.
template <typename Request, typename Response>
class Upload {
 public:
  virtual ~Upload() = default;
  // Takes the next message of the upload; the first one holds the header.
  virtual absl::Status Add(const Request& part) = 0;
  // Checks that all came, hashes and stores.
  virtual absl::StatusOr<Response> Finish() = 0;
};
using RasterUpload = Upload<v1::UploadRasterRequest, v1::UploadRasterResponse>;
using SpotTableUpload =
    Upload<v1::UploadSpotTableRequest, v1::UploadSpotTableResponse>;

// Takes the share of the work that is done, 0 to 1, never falling; called from
// the thread of the call. May be empty.
using OnProgress = std::function<void(double)>;

class Actor {
 public:
  virtual ~Actor() = default;

  // The window that OpenTiles would open, checked before anything is made: its
  // violations and NOT_FOUND, without what takes work.
  virtual absl::StatusOr<v1::Window> CheckTiles(
      const v1::StreamTilesRequest& request) = 0;

  // Every call that takes a stop token answers CANCELLED once it was asked to;
  // a preparation that other calls wait for goes on without it.
  virtual absl::StatusOr<std::shared_ptr<const TileJob>> OpenTiles(
      const v1::StreamTilesRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(
      const v1::PrepareTerrainRequest& request, const OnProgress& on_progress,
      std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetProfileResponse> GetProfile(
      const v1::GetProfileRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetHeightsResponse> GetHeights(
      const v1::GetHeightsRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::EstimateTilesResponse> EstimateTiles(
      const v1::EstimateTilesRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetPresetResponse> GetPreset(
      const v1::GetPresetRequest& request) = 0;
  virtual v1::GetServerInfoResponse GetServerInfo() = 0;

  // The other generators; they live as long as the actor.
  virtual const SurfaceMaker& surfaces() const = 0;
  virtual const TreeMaker& trees() const = 0;
  virtual const FlowerMaker& flowers() const = 0;
  virtual const RenderMaker& renders() const = 0;

  virtual std::unique_ptr<RasterUpload> BeginRasterUpload() = 0;
  virtual absl::StatusOr<v1::GetRasterResponse> GetRaster(
      const v1::GetRasterRequest& request) = 0;
  virtual std::unique_ptr<SpotTableUpload> BeginSpotTableUpload() = 0;
  virtual absl::StatusOr<v1::GetSpotTableResponse> GetSpotTable(
      const v1::GetSpotTableRequest& request) = 0;
};

// `workers` is only reported (GetServerInfo).
std::unique_ptr<Actor> MakeActor(const Limits& limits, int workers);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_ACTOR_H_
