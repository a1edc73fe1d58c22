#include "client/commands/height_output.h"

#include <fmt/format.h>

#include <cstdint>
#include <iostream>

#include "client/commands/shared_options.h"

namespace terrane::client {
namespace {

const std::map<std::string, ProgressMode> kProgressModes = {
    {"auto", ProgressMode::kAuto},
    {"none", ProgressMode::kNone},
    {"json", ProgressMode::kJson}};

// The whole tiles of a bounded domain, from its first sample on.
absl::StatusOr<v1::TileRange> AllTiles(const ChosenTerrain& terrain,
                                       const v1::StreamTilesRequest& request) {
  if (!terrain.domain.has_value()) {
    return absl::InvalidArgumentError(
        "--tiles all: the domain is endless; say --tiles X,Y,COLUMNS,ROWS");
  }
  const bool area = request.sampling() == v1::SAMPLING_AREA;
  const int stride = area ? request.tile_size() : request.tile_size() - 1;
  const std::int64_t cells_x = terrain.domain->cells_x() << request.level();
  const std::int64_t cells_y = terrain.domain->cells_y() << request.level();
  v1::TileRange range;
  range.set_columns(cells_x / stride);
  range.set_rows(cells_y / stride);
  if (range.columns() == 0 || range.rows() == 0) {
    return absl::InvalidArgumentError(fmt::format(
        "--tile-size: no tile of {} fits into the domain of {} x {} cells",
        request.tile_size(), cells_x, cells_y));
  }
  const std::int64_t left_x = cells_x % stride;
  const std::int64_t left_y = cells_y % stride;
  if (left_x != 0 || left_y != 0) {
    std::cerr << fmt::format(
        "terrane: whole tiles leave out the last {} columns and {} rows\n",
        left_x, left_y);
  }
  return range;
}

absl::StatusOr<v1::TileRange> ParseTiles(const std::string& text) {
  std::vector<std::int64_t> numbers;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    std::int64_t number = 0;
    if (CLI::detail::lexical_cast(part, number)) numbers.push_back(number);
  }
  if (numbers.size() != 4) {
    return absl::InvalidArgumentError(
        "--tiles: must be all or X,Y,COLUMNS,ROWS, got \"" + text + "\"");
  }
  v1::TileRange range;
  range.set_x(numbers[0]);
  range.set_y(numbers[1]);
  range.set_columns(numbers[2]);
  range.set_rows(numbers[3]);
  return range;
}

}  // namespace

const std::map<std::string, Compression> kCompressions = {
    {"deflate", Compression::kDeflate},
    {"zstd", Compression::kZstd},
    {"none", Compression::kNone}};

HeightOutputOptions AddHeightOutputOptions(CLI::App* app,
                                           HeightOutput* output) {
  CLI::Option* out =
      app->add_option("--out", output->path, "File to write")->group("Output");
  CLI::Option* tiles =
      app->add_option("--tiles", output->tiles,
                      "One file a tile: X,Y,COLUMNS,ROWS in whole tiles, or "
                      "all; {x} and {y} in --out stand for the tile's place")
          ->group("Output");
  app->add_option("--tile-size", output->tile_size,
                  "Samples a side of a tile (default: 256; POINT tiles share "
                  "their edges: 257)")
      ->check(CLI::Range(2, 1 << 20))
      ->group("Output");
  app->add_option("--range", output->range,
                  "Heights MIN,MAX of the 16-bit formats (default: the range "
                  "of all that is written)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("MIN,MAX")
      ->group("Output");
  app->add_option("--compress", output->compression,
                  "Of .tif: deflate, zstd or none")
      ->transform(OneOf(kCompressions))
      ->type_name("NAME")
      ->default_str("deflate")
      ->group("Output");
  app->add_flag("--json", output->json,
                "Print what was written as JSON on standard output")
      ->group("Output");
  app->add_option("--progress", output->progress,
                  "auto (a bar on a terminal), none or json, on standard error")
      ->transform(OneOf(kProgressModes))
      ->type_name("NAME")
      ->default_str("auto")
      ->group("Output");
  return {out, tiles};
}

void CheckHeightOutput(const HeightOutput& output) {
  const std::vector<double>& range = output.range;
  if (range.empty() || range[0] < range[1]) return;
  throw CLI::ValidationError(fmt::format(
      "--range: MIN must be below MAX, got {},{}", range[0], range[1]));
}

SinkOptions SinkOptionsOf(const HeightOutput& output) {
  SinkOptions options;
  options.compression = output.compression;
  if (!output.range.empty()) {
    options.range = HeightRange{output.range[0], output.range[1]};
  }
  return options;
}

v1::StreamTilesRequest SamplesRequest(const HeightOutput& output,
                                      v1::Sampling sampling,
                                      const ChosenTerrain& terrain) {
  v1::StreamTilesRequest request;
  *request.mutable_terrain() = terrain.choice;
  request.set_level(terrain.level);
  request.set_sampling(sampling);
  request.set_encoding(v1::HEIGHT_ENCODING_FLOAT32_LE);
  request.set_tile_size(output.tile_size.value_or(256));
  return request;
}

absl::StatusOr<v1::StreamTilesRequest> TilesRequest(
    const HeightOutput& output, v1::Sampling sampling,
    const ChosenTerrain& terrain) {
  v1::StreamTilesRequest request = SamplesRequest(output, sampling, terrain);
  // Neighbouring POINT tiles share an edge, hence the odd size.
  const bool shared_edge = sampling == v1::SAMPLING_POINT;
  request.set_tile_size(output.tile_size.value_or(shared_edge ? 257 : 256));
  const absl::StatusOr<v1::TileRange> range = output.tiles == "all"
                                                  ? AllTiles(terrain, request)
                                                  : ParseTiles(output.tiles);
  if (!range.ok()) return range.status();
  *request.mutable_tiles() = *range;
  return request;
}

}  // namespace terrane::client
