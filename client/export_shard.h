// ExportShard: one shard of an export at work, one file a tile.
//
// It takes over the tiles that an earlier run has made
// (client/export_manifest.h) and makes the others. Its manifest is written now
// and then (WaitAfterSave) and at the end, whatever the end: an interrupt or a
// full disk costs the tile in work, a crash what was made since. Belongs to one
// thread.
#ifndef TERRANE_CLIENT_EXPORT_SHARD_H_
#define TERRANE_CLIENT_EXPORT_SHARD_H_

#include <chrono>
#include <cstdint>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/backend.h"
#include "client/export_manifest.h"
#include "client/progress.h"
#include "client/report.pb.h"
#include "client/terrain_export.h"

namespace terrane::client {

// How long a shard works after it has written its manifest, which took `cost`,
// until it does so again. The manifest grows with the shard: this keeps it to a
// twentieth of the time.
std::chrono::nanoseconds WaitAfterSave(std::chrono::nanoseconds cost);

class ExportShard {
 public:
  // `request` asks for the tiles of all shards, of which `job` has as many as
  // it says; `shard` is one of them, from 0. `path` is as TerrainExport's.
  ExportShard(std::string path, ExportJob job, std::int64_t shard,
              v1::StreamTilesRequest request, const SinkOptions& options);

  // Errors: those of the backend and of the files; CANCELLED when `stop` is
  // asked for; FAILED_PRECONDITION when tiles come of another recipe or
  // revision than the job's, as from a server that is being replaced.
  absl::Status Run(ProgressMode progress, Backend* backend,
                   std::stop_token stop);

  // What is there; not the times.
  ExportSummary Summary() const;

 private:
  using Clock = std::chrono::steady_clock;

  // The tiles of the shard that are not there.
  absl::StatusOr<std::vector<std::int64_t>> Missing(std::stop_token stop);
  absl::Status TakeOver(const ExportManifest& before, std::stop_token stop);
  absl::Status Make(const std::vector<std::int64_t>& missing, ProgressMode mode,
                    Backend* backend, std::stop_token stop);
  absl::Status AddHeader(const v1::StreamHeader& header);
  absl::Status Add(const v1::HeightTile& tile);
  absl::Status Save();
  std::int64_t IndexOf(std::int64_t x, std::int64_t y) const;

  const std::string manifest_path_;
  const std::string folder_;
  const ExportJob job_;
  const std::int64_t shard_;
  v1::StreamTilesRequest request_;
  const v1::TileRange whole_;
  TerrainExport files_;
  // Those that are there, by index in `whole_`.
  std::map<std::int64_t, ExportTile> tiles_;
  std::int64_t made_ = 0;
  Clock::time_point next_save_ = Clock::now() + WaitAfterSave({});
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_EXPORT_SHARD_H_
