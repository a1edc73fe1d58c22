#include "client/export_shard.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <utility>

#include "client/raw_heights.h"
#include "client/tile_shard.h"

namespace terrane::client {

std::chrono::nanoseconds WaitAfterSave(std::chrono::nanoseconds cost) {
  return std::max<std::chrono::nanoseconds>(std::chrono::seconds(1), cost * 20);
}

ExportShard::ExportShard(std::string path, ExportJob job, std::int64_t shard,
                         v1::StreamTilesRequest request,
                         const SinkOptions& options)
    : manifest_path_(
          ManifestPath(path, shard, static_cast<std::int64_t>(job.shards()))),
      folder_(std::filesystem::path(path).parent_path().string()),
      job_(std::move(job)),
      shard_(shard),
      request_(std::move(request)),
      whole_(request_.tiles()),
      files_(std::move(path), TerrainExport::Files::kOneATile, options) {}

absl::Status ExportShard::Run(ProgressMode progress, Backend* backend,
                              std::stop_token stop) {
  const absl::StatusOr<std::vector<std::int64_t>> missing = Missing(stop);
  if (!missing.ok()) return missing.status();
  const absl::Status made = Make(*missing, progress, backend, stop);
  const absl::Status saved = Save();
  return made.ok() ? saved : made;
}

ExportSummary ExportShard::Summary() const {
  ExportSummary summary;
  summary.add_manifests(manifest_path_);
  summary.set_tiles(static_cast<double>(tiles_.size()));
  summary.set_made(static_cast<double>(made_));
  summary.set_kept(summary.tiles() - summary.made());
  for (const auto& [index, tile] : tiles_) {
    for (const ExportFile& file : tile.files()) {
      summary.set_bytes(summary.bytes() + file.bytes());
    }
  }
  summary.set_recipe_hash(job_.recipe_hash());
  summary.set_revision(job_.revision());
  return summary;
}

absl::StatusOr<std::vector<std::int64_t>> ExportShard::Missing(
    std::stop_token stop) {
  const absl::StatusOr<ExportManifest> before = ReadManifest(manifest_path_);
  if (before.ok()) {
    const absl::Status taken = TakeOver(*before, stop);
    if (!taken.ok()) return taken;
  } else if (!absl::IsNotFound(before.status())) {
    std::cerr << "terrane: " << before.status().message()
              << "; every tile is made anew\n";
  }
  const TileRun run = ShardOf(whole_.columns() * whole_.rows(),
                              static_cast<std::int64_t>(job_.shards()), shard_);
  std::vector<std::int64_t> missing;
  for (std::int64_t i = run.first; i < run.end; ++i) {
    if (!tiles_.contains(i)) missing.push_back(i);
  }
  return missing;
}

absl::Status ExportShard::TakeOver(const ExportManifest& before,
                                   std::stop_token stop) {
  if (!google::protobuf::util::MessageDifferencer::Equals(before.job(), job_)) {
    std::cerr << "terrane: " << manifest_path_
              << " is of another job; every tile is made anew\n";
    return absl::OkStatus();
  }
  for (const ExportTile& tile : before.tiles()) {
    if (stop.stop_requested()) return absl::CancelledError("interrupted");
    if (!IsThere(folder_, tile)) continue;
    tiles_[IndexOf(static_cast<std::int64_t>(tile.x()),
                   static_cast<std::int64_t>(tile.y()))] = tile;
  }
  return absl::OkStatus();
}

absl::Status ExportShard::Make(const std::vector<std::int64_t>& missing,
                               ProgressMode mode, Backend* backend,
                               std::stop_token stop) {
  Progress progress(mode, static_cast<std::int64_t>(missing.size()), "tiles");
  for (const v1::TileRange& rectangle : RectanglesOf(whole_, missing)) {
    *request_.mutable_tiles() = rectangle;
    const absl::Status status = backend->StreamTiles(
        request_,
        [&](const v1::StreamHeader& header) { return AddHeader(header); },
        [&](const v1::HeightTile& tile) {
          if (stop.stop_requested()) return absl::CancelledError("interrupted");
          progress.Advance(1);
          return Add(tile);
        },
        stop);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status ExportShard::AddHeader(const v1::StreamHeader& header) {
  if (header.recipe_hash() != job_.recipe_hash() ||
      header.revision() != job_.revision()) {
    return absl::FailedPreconditionError(fmt::format(
        "the server's tiles are of recipe {} at revision {}, those of this job "
        "of recipe {} at revision {}",
        header.recipe_hash(), header.revision(), job_.recipe_hash(),
        job_.revision()));
  }
  return files_.AddHeader(header);
}

absl::Status ExportShard::Add(const v1::HeightTile& tile) {
  const absl::Status status = files_.AddTile(tile);
  if (!status.ok()) return status;
  ExportTile made;
  made.set_x(static_cast<double>(tile.tile_x()));
  made.set_y(static_cast<double>(tile.tile_y()));
  const std::string& path = files_.files_written().back();
  for (const std::string& file : {path, SidecarPath(path)}) {
    // Not every format has a sidecar.
    if (file != path && !std::filesystem::exists(file)) continue;
    absl::StatusOr<ExportFile> described = DescribeFile(file);
    if (!described.ok()) return described.status();
    *made.add_files() = *std::move(described);
  }
  tiles_[IndexOf(tile.tile_x(), tile.tile_y())] = std::move(made);
  ++made_;
  return Clock::now() < next_save_ ? absl::OkStatus() : Save();
}

absl::Status ExportShard::Save() {
  const Clock::time_point start = Clock::now();
  ExportManifest manifest;
  *manifest.mutable_job() = job_;
  manifest.set_shard(static_cast<double>(shard_));
  for (const auto& [index, tile] : tiles_) *manifest.add_tiles() = tile;
  if (!folder_.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);  // WriteFile tells
  }
  absl::Status status = WriteManifest(manifest_path_, manifest);
  const Clock::time_point end = Clock::now();
  next_save_ = end + WaitAfterSave(end - start);
  return status;
}

std::int64_t ExportShard::IndexOf(std::int64_t x, std::int64_t y) const {
  return (y - whole_.y()) * whole_.columns() + (x - whole_.x());
}

}  // namespace terrane::client
