// HeightSink: takes the heights of one file, rectangle by rectangle, and writes
// them in the format that the file's extension names.
//
//   .tif   GeoTIFF, Float32, predictor 3, tiled, with CRS and AREA_OR_POINT
//   .f32   raw binary32 little-endian, row-major, with a JSON sidecar
//   .r16   raw unsigned 16-bit little-endian, with a JSON sidecar
//   .png   16-bit grey, with a JSON sidecar
//   .exr   OpenEXR, 32-bit float, one channel Y
//
// The file appears under its name only when Finish has succeeded
// (client/output_file.h). Memory stays flat whatever the size of the file, but
// for .png and .exr, which are built in memory. Belongs to one thread.
#ifndef TERRANE_CLIENT_HEIGHT_SINK_H_
#define TERRANE_CLIENT_HEIGHT_SINK_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/grid/lattice_window.h"

namespace terrane::client {

enum class HeightFormat { kTiff, kF32, kR16, kPng, kExr };

// By the extension. Error: INVALID_ARGUMENT naming those that there are.
absl::StatusOr<HeightFormat> FormatOf(const std::string& path);

// Whether heights are rounded to 16 bits over a range.
bool IsQuantised(HeightFormat format);

// What a file holds and where it lies.
struct HeightLayout {
  // The samples, as indices of the level.
  core::Window window;
  int level = 0;
  core::Sampling sampling = core::Sampling::kPoint;
  // World place of the file's first sample, and the distance of neighbours.
  core::Frame frame;
  std::string crs;  // WKT or AUTHORITY:CODE; empty: none
  // Side of the rectangles that will be written.
  int tile_size = 256;
  // Provenance.
  std::string recipe_hash;
  int revision = 0;
};

enum class Compression { kDeflate, kZstd, kNone };

struct HeightRange {
  double minimum = 0;
  double maximum = 0;
};

struct SinkOptions {
  // .tif only.
  Compression compression = Compression::kDeflate;
  // .r16 and .png: the range of the 16 bits; default: that of the data.
  std::optional<HeightRange> range;
};

// Range of the heights that are data, and how many are not.
class HeightTotals {
 public:
  void Add(float minimum, float maximum, std::int64_t nodata_samples);

  // 0 to 0 when nothing was data.
  HeightRange range() const { return range_.value_or(HeightRange()); }
  std::int64_t nodata_samples() const { return nodata_samples_; }

 private:
  std::optional<HeightRange> range_;
  std::int64_t nodata_samples_ = 0;
};

class HeightSink {
 public:
  virtual ~HeightSink() = default;

  // Row-major heights of a rectangle, columns and rows counted from the file's
  // first sample.
  virtual absl::Status Write(const core::Window& rectangle,
                             std::span<const float> heights) = 0;
  // All has been written; `totals` are those of the file. Call once, last.
  virtual absl::Status Finish(const HeightTotals& totals) = 0;
};

// Errors: an unknown extension, too large for the format, a CRS that is not
// understood, a file that cannot be created.
absl::StatusOr<std::unique_ptr<HeightSink>> OpenHeightSink(
    const std::string& path, const HeightLayout& layout,
    const SinkOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_HEIGHT_SINK_H_
