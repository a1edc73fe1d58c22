// The manifest of a shard of an export: which tiles it has made, as files with
// their SHA-256 (ExportManifest of client/report.proto, as JSON).
//
// It is what makes an export resumable: a tile counts as made when its files
// are there with the bytes that the manifest names. Like every output it is
// whole or not there (client/output_file.h).
#ifndef TERRANE_CLIENT_EXPORT_MANIFEST_H_
#define TERRANE_CLIENT_EXPORT_MANIFEST_H_

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/report.pb.h"

namespace terrane::client {

// NAME.EXTENSION.shard-I-of-N.json beside the tiles of NAME.EXTENSION, I from
// 0.
std::string ManifestPath(const std::string& out, std::int64_t shard,
                         std::int64_t shards);

// Errors: NOT_FOUND when there is none, INVALID_ARGUMENT when it is none.
absl::StatusOr<ExportManifest> ReadManifest(const std::string& path);
// And makes the names of the tiles outlast a crash of the system.
absl::Status WriteManifest(const std::string& path,
                           const ExportManifest& manifest);

// Name, size and hash of a file. Error: NOT_FOUND when it cannot be read.
absl::StatusOr<ExportFile> DescribeFile(const std::string& path);

// Whether the files of a tile lie in `folder` with the bytes that it names.
bool IsThere(const std::string& folder, const ExportTile& tile);

// What is wrong with the export to `out`, a line each: manifests missing or of
// another job, tiles that are not listed or not there. Empty when all of its
// tiles are there. Adds what was read to `summary`. Error: CANCELLED when
// `stop` is asked for, which is looked at before each tile.
absl::StatusOr<std::vector<std::string>> VerifyExport(const std::string& out,
                                                      std::int64_t shards,
                                                      std::stop_token stop,
                                                      ExportSummary* summary);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_EXPORT_MANIFEST_H_
