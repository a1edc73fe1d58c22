// Raw height files for game engines, each with a JSON sidecar (HeightSidecar of
// client/report.proto) that tells how to read it: NAME.r16 (unsigned 16-bit
// little-endian) and NAME.f32 (binary32 little-endian), row-major.
#ifndef TERRANE_CLIENT_RAW_HEIGHTS_H_
#define TERRANE_CLIENT_RAW_HEIGHTS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/placed_raster.h"
#include "client/report.pb.h"

namespace terrane::client {

// The sidecar's name: the file's own with .json added.
std::string SidecarPath(const std::string& path);

absl::Status WriteSidecar(const std::string& path,
                          const HeightSidecar& sidecar);

// Reads a .r16 or .f32 file by its sidecar. Errors: NOT_FOUND without one,
// INVALID_ARGUMENT when it does not describe the file.
absl::StatusOr<PlacedRaster> ReadRawHeights(const std::string& path,
                                            std::int64_t max_samples);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RAW_HEIGHTS_H_
