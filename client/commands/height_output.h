// The options of the commands that write heights into files, and the requests
// that follow from them.
#ifndef TERRANE_CLIENT_COMMANDS_HEIGHT_OUTPUT_H_
#define TERRANE_CLIENT_COMMANDS_HEIGHT_OUTPUT_H_

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/chosen_terrain.h"
#include "client/height_sink.h"
#include "client/progress.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::client {

struct HeightOutput {
  std::string path;
  // One file a tile: "all", or X,Y,COLUMNS,ROWS; empty: one file.
  std::string tiles;
  std::optional<int> tile_size;
  std::vector<double> range;  // minimum, maximum; empty: that of the data
  Compression compression = Compression::kDeflate;
  bool json = false;
  ProgressMode progress = ProgressMode::kAuto;
};

// The names of --compress.
extern const std::map<std::string, Compression> kCompressions;

// Those that a command has rules of its own for.
struct HeightOutputOptions {
  CLI::Option* out;
  CLI::Option* tiles;
};

HeightOutputOptions AddHeightOutputOptions(CLI::App* app, HeightOutput* output);
// For the end of parsing: throws CLI's errors for what options do not check.
void CheckHeightOutput(const HeightOutput& output);

SinkOptions SinkOptionsOf(const HeightOutput& output);

// The request of a terrain's samples as floats, without an extent.
v1::StreamTilesRequest SamplesRequest(const HeightOutput& output,
                                      v1::Sampling sampling,
                                      const ChosenTerrain& terrain);

// The request of whole tiles, those of --tiles. Errors: INVALID_ARGUMENT naming
// the option.
absl::StatusOr<v1::StreamTilesRequest> TilesRequest(
    const HeightOutput& output, v1::Sampling sampling,
    const ChosenTerrain& terrain);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_HEIGHT_OUTPUT_H_
