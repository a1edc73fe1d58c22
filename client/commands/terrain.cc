// `terrane terrain`: heights into files.
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <map>
#include <memory>

#include "client/chosen_spots.h"
#include "client/commands/command.h"
#include "client/commands/shared_options.h"
#include "client/exit_code.h"
#include "client/progress.h"
#include "client/terrain_export.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane terrain --preset fbm/fig06b --out hills.png
  terrane terrain --dem model.tif --level 3 --out finer.tif
  terrane terrain --dem model.tif --tiles all --tile-size 513 --out game/tile.r16
  terrane terrain --local --seed 7 --level 4 --window 0,0,2048,2048 --out world.exr
  terrane terrain --dem model.tif --spots survey.csv --spots-crs EPSG:4326 --out met.tif
--out by extension: .tif .png (16-bit) .exr .r16 .f32; .png, .r16 and .f32 get a
JSON sidecar. Exit codes: 0 ok, 1 error, 2 usage, 3 some files written, 4 server
not reached, 130 interrupted.)";

struct TerrainCommand {
  ConnectionOptions connection;
  TerrainOptions terrain;
  ExtentOptions extent;
  std::string tiles;
  std::optional<int> tile_size;
  std::string out;
  std::vector<double> range;
  Compression compression = Compression::kDeflate;
  bool json = false;
  bool dry_run = false;
  ProgressMode progress = ProgressMode::kAuto;
};

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

absl::StatusOr<v1::StreamTilesRequest> MakeRequest(
    const TerrainCommand& command, const ChosenTerrain& terrain) {
  v1::StreamTilesRequest request;
  *request.mutable_terrain() = terrain.choice;
  request.set_level(terrain.level);
  request.set_sampling(command.extent.sampling);
  // Neighbouring POINT tiles share an edge, hence the odd size.
  const bool shared_edge =
      !command.tiles.empty() && command.extent.sampling == v1::SAMPLING_POINT;
  request.set_tile_size(command.tile_size.value_or(shared_edge ? 257 : 256));
  request.set_encoding(v1::HEIGHT_ENCODING_FLOAT32_LE);
  if (!command.tiles.empty()) {
    const absl::StatusOr<v1::TileRange> range = command.tiles == "all"
                                                    ? AllTiles(terrain, request)
                                                    : ParseTiles(command.tiles);
    if (!range.ok()) return range.status();
    *request.mutable_tiles() = *range;
  } else if (!command.extent.window.empty()) {
    *request.mutable_window() = WindowOf(command.extent.window);
  } else if (terrain.view.has_window() &&
             request.level() == terrain.view.level()) {
    *request.mutable_window() = terrain.view.window();
  }
  return request;
}

int PrintEstimate(const v1::StreamTilesRequest& request,
                  const ChosenTerrain& terrain, bool json, Backend* backend,
                  std::stop_token stop) {
  v1::EstimateTilesRequest ask;
  *ask.mutable_request() = request;
  const absl::StatusOr<v1::EstimateTilesResponse> estimate =
      backend->EstimateTiles(ask, stop);
  if (!estimate.ok()) {
    return ReportStatus(NameRows(estimate.status(), terrain));
  }
  if (json) {
    std::cout << JsonLine(*estimate) << '\n';
    return kExitOk;
  }
  std::cout << fmt::format(
      "{} tiles, {} samples, {} bytes of heights\n"
      "{} lattice points, about {:.3g} s of one core, {} bytes of memory\n",
      estimate->tiles(), estimate->samples(), estimate->data_bytes(),
      estimate->generated_points(), estimate->cpu_seconds(),
      estimate->memory_bytes());
  if (estimate->prepare_bytes() > 0) {
    std::cout << fmt::format(
        "before that, to meet the spot heights: about {:.3g} s, at most {} "
        "bytes\n",
        estimate->prepare_seconds(), estimate->prepare_bytes());
  }
  return kExitOk;
}

void PrintSummary(const TerrainSummary& summary) {
  const std::string what =
      summary.files_size() == 1
          ? summary.files(0)
          : fmt::format("{} files, {} to {}", summary.files_size(),
                        summary.files(0),
                        summary.files(summary.files_size() - 1));
  std::cout << fmt::format(
      "wrote {}\n{:.0f} x {:.0f} samples of level {}, heights {:.6g} to "
      "{:.6g}, {:.2f} s, {}samples/s\n",
      what, summary.width(), summary.height(), summary.level(),
      summary.minimum(), summary.maximum(), summary.seconds(),
      ShortNumber(summary.samples_per_second()));
}

// Streams the tiles into files.
absl::Status Export(const TerrainCommand& command,
                    const v1::StreamTilesRequest& request, Backend* backend,
                    std::stop_token stop, TerrainExport* files) {
  std::unique_ptr<Progress> progress;
  const absl::Status status = backend->StreamTiles(
      request,
      [&](const v1::StreamHeader& header) {
        const v1::Window& window = header.window();
        progress = std::make_unique<Progress>(command.progress,
                                              window.width() * window.height());
        return files->AddHeader(header);
      },
      [&](const v1::HeightTile& tile) {
        if (stop.stop_requested()) return absl::CancelledError("interrupted");
        progress->Advance(tile.window().width() * tile.window().height());
        return files->AddTile(tile);
      },
      stop);
  progress.reset();
  return status.ok() ? files->Finish() : status;
}

// A GeoTIFF is written block by block, so that memory stays flat: the tiles of
// one must be blocks.
absl::Status CheckTileSize(const TerrainCommand& command) {
  const absl::StatusOr<HeightFormat> format = FormatOf(command.out);
  if (!format.ok()) return format.status();
  if (*format == HeightFormat::kTiff && command.tiles.empty() &&
      command.tile_size.value_or(256) % 16 != 0) {
    return absl::InvalidArgumentError(fmt::format(
        "--tile-size: must be a multiple of 16 for one .tif, got {}",
        *command.tile_size));
  }
  return absl::OkStatus();
}

int Usage(const absl::Status& status) {
  ReportStatus(status);
  return kExitUsage;
}

int Run(const TerrainCommand& command, std::stop_token stop) {
  if (!command.dry_run) {
    const absl::Status status = CheckTileSize(command);
    if (!status.ok()) return Usage(status);
  }
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenTerrain> terrain =
      ChooseTerrain(command.terrain, command.extent.level, backend.get(), stop);
  if (!terrain.ok()) return ReportStatus(terrain.status());
  const absl::StatusOr<v1::StreamTilesRequest> request =
      MakeRequest(command, *terrain);
  if (!request.ok()) return Usage(request.status());
  if (command.dry_run) {
    return PrintEstimate(*request, *terrain, command.json, backend.get(), stop);
  }

  const auto start = std::chrono::steady_clock::now();
  const absl::StatusOr<std::optional<v1::SpotReport>> spots =
      PrepareSpots(*terrain, command.progress, backend.get(), stop);
  if (!spots.ok()) return ReportStatus(spots.status());

  SinkOptions options;
  options.compression = command.compression;
  if (!command.range.empty()) {
    options.range = HeightRange{command.range[0], command.range[1]};
  }
  TerrainExport files(command.out,
                      command.tiles.empty() ? TerrainExport::Files::kOne
                                            : TerrainExport::Files::kOneATile,
                      options);
  const absl::Status status =
      Export(command, *request, backend.get(), stop, &files);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  TerrainSummary summary = files.Summary();
  summary.set_seconds(seconds);
  summary.set_samples_per_second(summary.samples() / seconds);
  if (!status.ok()) {
    const int code = ReportStatus(status);
    return code != kExitInterrupted && !files.files_written().empty()
               ? kExitPartial
               : code;
  }
  if (command.json) {
    std::cout << JsonLine(summary) << '\n';
  } else {
    PrintSummary(summary);
  }
  PrintSpotReport(*spots, *terrain);
  return kExitOk;
}

const std::map<std::string, Compression> kCompressions = {
    {"deflate", Compression::kDeflate},
    {"zstd", Compression::kZstd},
    {"none", Compression::kNone}};

const std::map<std::string, ProgressMode> kProgressModes = {
    {"auto", ProgressMode::kAuto},
    {"none", ProgressMode::kNone},
    {"json", ProgressMode::kJson}};

// An empty text when the range is one.
std::string CheckRange(const std::vector<double>& range) {
  if (range[0] < range[1]) return "";
  return fmt::format("--range: MIN must be below MAX, got {},{}", range[0],
                     range[1]);
}

void AddOutputOptions(CLI::App* app, TerrainCommand* command) {
  CLI::Option* out =
      app->add_option("--out", command->out, "File to write")->group("Output");
  app->add_option("--tiles", command->tiles,
                  "One file a tile: X,Y,COLUMNS,ROWS in whole tiles, or all; "
                  "{x} and {y} in --out stand for the tile's place")
      ->excludes("--window")
      ->group("Output");
  app->add_option("--tile-size", command->tile_size,
                  "Samples a side of a tile (default: 256; POINT tiles share "
                  "their edges: 257)")
      ->check(CLI::Range(2, 1 << 20))
      ->group("Output");
  app->add_option("--range", command->range,
                  "Heights MIN,MAX of the 16-bit formats (default: the range "
                  "of all that is written)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("MIN,MAX")
      ->group("Output");
  app->add_option("--compress", command->compression,
                  "Of .tif: deflate, zstd or none")
      ->transform(OneOf(kCompressions))
      ->type_name("NAME")
      ->default_str("deflate")
      ->group("Output");
  app->add_flag("--json", command->json,
                "Print what was written as JSON on standard output")
      ->group("Output");
  app->add_option("--progress", command->progress,
                  "auto (a bar on a terminal), none or json, on standard error")
      ->transform(OneOf(kProgressModes))
      ->type_name("NAME")
      ->default_str("auto")
      ->group("Output");
  CLI::Option* dry_run = app->add_flag("--dry-run", command->dry_run,
                                       "Only print samples, bytes and cost")
                             ->group("Output");
  app->parse_complete_callback([command, out, dry_run] {
    if (out->count() == 0 && dry_run->count() == 0) {
      throw CLI::RequiredError("--out");
    }
    if (command->range.empty()) return;
    const std::string wrong = CheckRange(command->range);
    if (!wrong.empty()) throw CLI::ValidationError(wrong);
  });
}

}  // namespace

void AddTerrainCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("terrain", "Generate heights into files");
  const auto command = std::make_shared<TerrainCommand>();
  AddTerrainOptions(subcommand, &command->terrain);
  AddExtentOptions(subcommand, &command->extent);
  AddOutputOptions(subcommand, command.get());
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
