// Spot heights from files: a CSV table, or a layer of any vector format that
// GDAL reads.
//
// CSV: the first line names the columns, in any order and case: x, y, z, and
// standard_error (or se) if there is one; other columns are passed over.
// Vector: every point is a spot, every line a line of spots. The height is that
// of a field, or the Z of the geometry.
//
// Threads: any. Errors: NOT_FOUND or UNKNOWN for a file that cannot be read,
// INVALID_ARGUMENT naming the file and the line (CSV) or feature (vector).
#ifndef TERRANE_CLIENT_SPOT_FILE_H_
#define TERRANE_CLIENT_SPOT_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/spot_table.h"

namespace terrane::client {

// Which file, and what of it.
struct SpotFileOptions {
  std::string path;
  // Field or column of the heights; empty: z of a CSV, Z of a geometry.
  std::string field;
  // Field or column of the standard errors; empty: standard_error or se of a
  // CSV if there is one, none of a vector layer.
  std::string error_field;
  // Layer of a vector file; empty: the only one.
  std::string layer;
  // CRS of the coordinates; empty: the file's own.
  std::string crs;
};

// Vertices and a height each.
struct SpotPolyline {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> height;
  double standard_error = 0;
  std::int64_t source = 0;
};

struct SpotFile {
  std::string path;
  SpotTable table;
  std::vector<SpotPolyline> lines;
  // WKT; empty when it is not known.
  std::string crs;
  // What a row's source counts: "line" or "feature".
  const char* source_word = "line";

  // Such as "points.csv line 17".
  std::string PlaceOf(std::int64_t source) const;
};

// A 1-D recipe (`dimensions` 1) needs no y.
absl::StatusOr<SpotFile> ReadSpotFile(const SpotFileOptions& options,
                                      int dimensions);

// The vector half of ReadSpotFile (client/spot_layer.cc).
absl::StatusOr<SpotFile> ReadSpotLayer(const SpotFileOptions& options);

// Transforms x and y to another CRS (WKT or AUTHORITY:CODE); heights stay as
// they are. Does nothing when one of the two is not known or both are the same.
// Coordinates are x east (longitude), y north (latitude), whatever order the
// CRS's authority says. Error: a CRS that PROJ does not know, a row that cannot
// be transformed.
absl::Status TransformSpots(const std::string& target_crs, SpotFile* spots);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SPOT_FILE_H_
