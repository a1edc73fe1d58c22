#include "client/local_backend.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "client/raster_upload.h"
#include "client/spot_upload.h"
#include "client/surface_verifier.h"
#include "client/tile_verifier.h"
#include "core/terrain/terrain.h"
#include "server/actor/cpu_quota.h"

namespace terrane::client {
namespace {

// Makes one tile, by its index, with the scratch memory of its thread.
template <typename Tile>
using MakeTile = std::function<absl::Status(std::int64_t, std::stop_token,
                                            core::TileScratch*, Tile*)>;

// Makes the tiles `first` to `total` of a job on several threads and hands them
// out in order. A thread that is too far ahead of the reader waits.
template <typename Tile>
class OrderedTiles {
 public:
  OrderedTiles(std::int64_t first, std::int64_t total, MakeTile<Tile> make,
               int threads)
      : total_(total),
        make_(std::move(make)),
        next_to_make_(first),
        next_to_take_(first),
        slots_(static_cast<std::size_t>(threads) * 2) {
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([this](std::stop_token stop) { Make(stop); });
    }
  }

  // Stops the threads, waiting for the tiles in work to notice.
  ~OrderedTiles() {
    for (std::jthread& thread : threads_) thread.request_stop();
  }

  // The next tile; CANCELLED when `stop` is asked for.
  absl::StatusOr<Tile> Take(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    Slot& slot = SlotOf(next_to_take_);
    if (!changed_.wait(lock, stop, [&] { return slot.filled; })) {
      return absl::CancelledError("interrupted");
    }
    slot.filled = false;
    ++next_to_take_;
    absl::Status status = std::move(slot.status);
    Tile tile = std::move(slot.tile);
    lock.unlock();
    changed_.notify_all();
    if (!status.ok()) return status;
    return tile;
  }

 private:
  struct Slot {
    bool filled = false;
    absl::Status status;
    Tile tile;
  };

  Slot& SlotOf(std::int64_t index) {
    return slots_[static_cast<std::size_t>(index) % slots_.size()];
  }

  void Make(std::stop_token stop) {
    core::TileScratch scratch;
    const auto slot_count = static_cast<std::int64_t>(slots_.size());
    while (true) {
      std::unique_lock lock(mutex_);
      const bool may_go = changed_.wait(lock, stop, [&] {
        return next_to_make_ >= total_ ||
               next_to_make_ < next_to_take_ + slot_count;
      });
      if (!may_go || next_to_make_ >= total_) return;
      const std::int64_t index = next_to_make_++;
      lock.unlock();

      Tile tile;
      absl::Status status = make_(index, stop, &scratch, &tile);

      lock.lock();
      Slot& slot = SlotOf(index);
      slot.filled = true;
      slot.status = std::move(status);
      slot.tile = std::move(tile);
      lock.unlock();
      changed_.notify_all();
    }
  }

  const std::int64_t total_;
  const MakeTile<Tile> make_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::int64_t next_to_make_;
  std::int64_t next_to_take_;
  std::vector<Slot> slots_;
  // Last, so that the threads end before what they use goes.
  std::vector<std::jthread> threads_;
};

// Makes, verifies and hands out the tiles of a job.
template <typename Tile, typename Job, typename Verifier, typename OnTileOf>
absl::Status HandOut(const Job& job, MakeTile<Tile> make, int threads,
                     Verifier* verifier, const OnTileOf& on_tile,
                     std::stop_token stop) {
  OrderedTiles<Tile> tiles(job.first(), job.total(), std::move(make), threads);
  while (verifier->next_index() < job.total()) {
    const absl::StatusOr<Tile> tile = tiles.Take(stop);
    if (!tile.ok()) return tile.status();
    absl::Status status = verifier->CheckTile(*tile);
    if (status.ok()) status = on_tile(*tile);
    if (!status.ok()) return status;
  }
  return verifier->CheckEnd();
}

}  // namespace

LocalBackend::LocalBackend(int threads)
    : threads_(threads > 0 ? threads : server::UsableCpus()),
      actor_(server::MakeActor(server::Limits(), threads_)),
      trees_(&actor_->trees()),
      flowers_(&actor_->flowers()),
      renders_(&actor_->renders()) {}

absl::Status LocalBackend::StreamTiles(const v1::StreamTilesRequest& request,
                                       const OnHeader& on_header,
                                       const OnTile& on_tile,
                                       std::stop_token stop) {
  const absl::StatusOr<std::shared_ptr<const server::TileJob>> job =
      actor_->OpenTiles(request, stop);
  if (!job.ok()) return job.status();
  TileVerifier verifier(request);
  absl::Status status = verifier.CheckHeader((*job)->header());
  if (status.ok()) status = on_header((*job)->header());
  if (!status.ok()) return status;

  return HandOut<v1::HeightTile>(
      **job,
      [&job](std::int64_t index, std::stop_token stopped,
             core::TileScratch* scratch, v1::HeightTile* tile) {
        return (*job)->MakeTile(index, std::move(stopped), scratch, tile);
      },
      threads_, &verifier, on_tile, std::move(stop));
}

absl::Status LocalBackend::StreamSurface(
    const v1::StreamSurfaceRequest& request, const OnSurfaceHeader& on_header,
    const OnSurfaceTile& on_tile, std::stop_token stop) {
  const absl::StatusOr<std::shared_ptr<const server::SurfaceJob>> job =
      actor_->surfaces().Open(request);
  if (!job.ok()) return job.status();
  SurfaceVerifier verifier(request);
  absl::Status status = verifier.CheckHeader((*job)->header());
  if (status.ok()) status = on_header((*job)->header());
  if (!status.ok()) return status;
  return HandOut<v1::StreamSurfaceResponse>(
      **job,
      [&job](std::int64_t index, std::stop_token stopped, core::TileScratch*,
             v1::StreamSurfaceResponse* tile) {
        return (*job)->MakeTile(index, std::move(stopped), tile);
      },
      threads_, &verifier, on_tile, std::move(stop));
}

absl::StatusOr<v1::PreparedTerrain> LocalBackend::PrepareTerrain(
    const v1::PrepareTerrainRequest& request,
    const OnPrepareProgress& on_progress, std::stop_token stop) {
  return actor_->PrepareTerrain(request, on_progress, stop);
}

absl::StatusOr<v1::GetProfileResponse> LocalBackend::GetProfile(
    const v1::GetProfileRequest& request, std::stop_token stop) {
  return actor_->GetProfile(request, stop);
}

absl::StatusOr<v1::GetHeightsResponse> LocalBackend::GetHeights(
    const v1::GetHeightsRequest& request, std::stop_token stop) {
  return actor_->GetHeights(request, stop);
}

absl::StatusOr<v1::EstimateTilesResponse> LocalBackend::EstimateTiles(
    const v1::EstimateTilesRequest& request, std::stop_token stop) {
  return actor_->EstimateTiles(request, std::move(stop));
}

absl::StatusOr<v1::GetPresetResponse> LocalBackend::GetPreset(
    const v1::GetPresetRequest& request, std::stop_token) {
  return actor_->GetPreset(request);
}

absl::StatusOr<v1::GetServerInfoResponse> LocalBackend::GetServerInfo(
    std::stop_token) {
  return actor_->GetServerInfo();
}

absl::StatusOr<v1::EstimateSurfaceResponse> LocalBackend::EstimateSurface(
    const v1::EstimateSurfaceRequest& request, std::stop_token) {
  return actor_->surfaces().Estimate(request);
}

absl::StatusOr<v1::GetSurfacePresetResponse> LocalBackend::GetSurfacePreset(
    const v1::GetSurfacePresetRequest& request, std::stop_token) {
  return actor_->surfaces().GetPreset(request);
}

absl::StatusOr<std::string> LocalBackend::UploadRaster(
    std::shared_ptr<const core::Raster> raster, std::stop_token) {
  const std::unique_ptr<server::RasterUpload> upload =
      actor_->BeginRasterUpload();
  const absl::Status sent = SendRaster(
      *raster,
      [&](const v1::UploadRasterRequest& part) { return upload->Add(part); });
  if (!sent.ok()) return sent;
  absl::StatusOr<v1::UploadRasterResponse> response = upload->Finish();
  if (!response.ok()) return response.status();
  return response->raster_id();
}

absl::StatusOr<v1::GetRasterResponse> LocalBackend::GetRaster(
    const v1::GetRasterRequest& request, std::stop_token) {
  return actor_->GetRaster(request);
}

absl::StatusOr<std::string> LocalBackend::UploadSpotTable(
    std::shared_ptr<const SpotTable> table, std::stop_token) {
  const std::unique_ptr<server::SpotTableUpload> upload =
      actor_->BeginSpotTableUpload();
  const absl::Status sent =
      SendSpotTable(*table, [&](const v1::UploadSpotTableRequest& part) {
        return upload->Add(part);
      });
  if (!sent.ok()) return sent;
  absl::StatusOr<v1::UploadSpotTableResponse> response = upload->Finish();
  if (!response.ok()) return response.status();
  return response->table_id();
}

}  // namespace terrane::client
