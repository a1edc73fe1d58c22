// TerrainExport: a stream of tiles into one file, or into one file a tile.
//
// Feed it the header and the tiles of a stream, then Finish. Files are whole or
// not there (client/output_file.h); when one file a tile is written, those that
// are finished stay when a later one fails. Belongs to one thread.
#ifndef TERRANE_CLIENT_TERRAIN_EXPORT_H_
#define TERRANE_CLIENT_TERRAIN_EXPORT_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/height_sink.h"
#include "client/output_file.h"
#include "client/report.pb.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::client {

class TerrainExport {
 public:
  enum class Files { kOne, kOneATile };

  // `path`: the file; for one file a tile, {x} and {y} stand for the tile's
  // column and row, and without them _x{x}_y{y} goes before the extension.
  TerrainExport(std::string path, Files files, SinkOptions options);

  absl::Status AddHeader(const v1::StreamHeader& header);
  absl::Status AddTile(const v1::HeightTile& tile);
  absl::Status Finish();

  // What is known so far: files, counts, range, hash; not the times.
  TerrainSummary Summary() const;
  const std::vector<std::string>& files_written() const { return written_; }

 private:
  // A tile that waits in the spool for the range of the whole request.
  struct SpooledTile {
    std::int64_t x;
    std::int64_t y;
    core::Window window;
    std::int64_t offset;
  };

  HeightLayout LayoutOf(const core::Window& window) const;
  std::string TilePath(std::int64_t x, std::int64_t y) const;
  absl::Status WriteTileFile(std::int64_t x, std::int64_t y,
                             const core::Window& window,
                             const HeightTotals& totals,
                             std::span<const float> heights);
  absl::Status Spool(const v1::HeightTile& tile, const core::Window& window);
  absl::Status FinishSpooled();

  std::string path_;
  Files files_;
  SinkOptions options_;
  v1::StreamHeader header_;
  HeightTotals totals_;
  std::int64_t samples_ = 0;
  std::int64_t tiles_ = 0;
  std::vector<float> heights_;  // of the tile in work

  std::unique_ptr<HeightSink> sink_;  // Files::kOne
  // Files::kOneATile with 16 bits and no given range: every tile is kept until
  // the range of all is known.
  std::optional<OutputFile> spool_;
  std::int64_t spool_bytes_ = 0;
  std::vector<SpooledTile> spooled_;
  std::vector<std::string> written_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TERRAIN_EXPORT_H_
