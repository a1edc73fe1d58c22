// An Actor whose tiles cost nothing and can be held back, for tests of what
// surrounds the generation.
#ifndef TERRANE_TESTS_SERVER_FAKE_ACTOR_H_
#define TERRANE_TESTS_SERVER_FAKE_ACTOR_H_

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "server/actor/actor.h"

namespace terrane::server {

// What the tiles of a FakeActor did, and how they behave.
struct FakeTiles {
  std::size_t tile_bytes = 1024;
  // What a stream is estimated to take.
  std::atomic<double> seconds = 0;
  // A tile that is not let through is at work until its stop token is set.
  std::atomic<bool> hold = false;
  // The same of the preparation before them.
  std::atomic<bool> hold_preparation = false;
  std::atomic<std::int64_t> started = 0;
  std::atomic<std::int64_t> stopped = 0;
};

// What holds something back: until `hold` is false, or the stop token is set.
inline absl::Status HoldBack(const std::atomic<bool>& hold,
                             const std::stop_token& stop, FakeTiles* tiles) {
  ++tiles->started;
  while (hold) {
    if (stop.stop_requested()) {
      ++tiles->stopped;
      return absl::CancelledError("stopped");
    }
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return absl::OkStatus();
}

// The content of a tile, for comparing.
inline std::string FakeTileData(std::int64_t index, std::size_t size) {
  std::string data(size, '\0');
  for (std::size_t i = 0; i < size; ++i) {
    data[i] =
        static_cast<char>((static_cast<std::size_t>(index) * 31 + i) % 251);
  }
  return data;
}

class FakeJob : public TileJob {
 public:
  FakeJob(std::int64_t total, std::int64_t first, FakeTiles* tiles)
      : total_(total), first_(first), tiles_(tiles) {
    header_.set_recipe_hash("sha256:fake");
  }

  const v1::StreamHeader& header() const override { return header_; }
  std::int64_t total() const override { return total_; }
  std::int64_t first() const override { return first_; }
  double EstimatedSeconds() const override { return tiles_->seconds; }
  absl::Status MakeTile(std::int64_t index, std::stop_token stop,
                        core::TileScratch*,
                        v1::HeightTile* tile) const override {
    const absl::Status status = HoldBack(tiles_->hold, stop, tiles_);
    if (!status.ok()) return status;
    tile->set_index(index);
    tile->set_total(total_);
    *tile->mutable_data() = FakeTileData(index, tiles_->tile_bytes);
    return absl::OkStatus();
  }

 private:
  const std::int64_t total_;
  const std::int64_t first_;
  FakeTiles* const tiles_;
  v1::StreamHeader header_;
};

// StreamTiles: `tile_size` of the request is the number of tiles. GetPreset: an
// internal error that names a path. Everything else answers with empty
// messages.
class FakeActor : public Actor {
 public:
  FakeTiles& tiles() { return tiles_; }

  absl::StatusOr<v1::Window> CheckTiles(
      const v1::StreamTilesRequest&) override {
    return v1::Window();
  }
  absl::StatusOr<std::shared_ptr<const TileJob>> OpenTiles(
      const v1::StreamTilesRequest& request, std::stop_token stop) override {
    if (tiles_.hold_preparation) {
      const absl::Status status =
          HoldBack(tiles_.hold_preparation, stop, &tiles_);
      if (!status.ok()) return status;
    }
    return std::make_shared<FakeJob>(request.tile_size(), request.first_tile(),
                                     &tiles_);
  }
  absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(
      const v1::PrepareTerrainRequest&, const OnProgress& on_progress,
      std::stop_token stop) override {
    on_progress(0.25);
    const absl::Status status =
        HoldBack(tiles_.hold_preparation, stop, &tiles_);
    if (!status.ok()) return status;
    v1::PreparedTerrain prepared;
    prepared.set_recipe_hash("sha256:fake");
    return prepared;
  }
  absl::StatusOr<v1::GetProfileResponse> GetProfile(
      const v1::GetProfileRequest&, std::stop_token stop) override {
    const absl::Status status = HoldBack(tiles_.hold, stop, &tiles_);
    if (!status.ok()) return status;
    return v1::GetProfileResponse();
  }
  absl::StatusOr<v1::GetHeightsResponse> GetHeights(
      const v1::GetHeightsRequest&, std::stop_token) override {
    return v1::GetHeightsResponse();
  }
  absl::StatusOr<v1::EstimateTilesResponse> EstimateTiles(
      const v1::EstimateTilesRequest&, std::stop_token) override {
    return v1::EstimateTilesResponse();
  }
  absl::StatusOr<v1::GetPresetResponse> GetPreset(
      const v1::GetPresetRequest&) override {
    return absl::InternalError("cannot read /etc/secret");
  }
  v1::GetServerInfoResponse GetServerInfo() override { return {}; }
  const SurfaceMaker& surfaces() const override { return surfaces_; }
  const TreeMaker& trees() const override { return trees_; }
  const FlowerMaker& flowers() const override { return flowers_; }
  const RenderMaker& renders() const override { return renders_; }
  std::unique_ptr<RasterUpload> BeginRasterUpload() override { return nullptr; }
  absl::StatusOr<v1::GetRasterResponse> GetRaster(
      const v1::GetRasterRequest&) override {
    return v1::GetRasterResponse();
  }
  std::unique_ptr<SpotTableUpload> BeginSpotTableUpload() override {
    return nullptr;
  }
  absl::StatusOr<v1::GetSpotTableResponse> GetSpotTable(
      const v1::GetSpotTableRequest&) override {
    return v1::GetSpotTableResponse();
  }

 private:
  FakeTiles tiles_;
  const SurfaceMaker surfaces_{Limits()};
  const TreeMaker trees_{Limits()};
  const FlowerMaker flowers_{Limits()};
  const RenderMaker renders_{this, Limits()};
};

// Waits up to a minute for a condition that other threads bring about.
template <typename Condition>
bool Eventually(Condition condition) {
  for (int i = 0; i < 60'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

// Has `ask` make calls with longer and longer deadlines until one is being
// worked on when its deadline passes.
template <typename Ask>
bool EventuallyStarts(const FakeTiles& tiles, Ask ask) {
  for (std::chrono::milliseconds time(200); time < std::chrono::minutes(1);
       time *= 2) {
    ask(std::chrono::system_clock::now() + time);
    if (tiles.started > 0) return true;
  }
  return false;
}

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_FAKE_ACTOR_H_
