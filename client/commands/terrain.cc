// `terrane terrain`: heights into files.
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <memory>

#include "client/chosen_spots.h"
#include "client/commands/command.h"
#include "client/commands/height_output.h"
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
  HeightOutput output;
  bool dry_run = false;
};

absl::StatusOr<v1::StreamTilesRequest> MakeRequest(
    const TerrainCommand& command, const ChosenTerrain& terrain) {
  if (!command.output.tiles.empty()) {
    return TilesRequest(command.output, command.extent.sampling, terrain);
  }
  v1::StreamTilesRequest request =
      SamplesRequest(command.output, command.extent.sampling, terrain);
  if (!command.extent.window.empty()) {
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
        progress = std::make_unique<Progress>(command.output.progress,
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
  const HeightOutput& output = command.output;
  const absl::StatusOr<HeightFormat> format = FormatOf(output.path);
  if (!format.ok()) return format.status();
  if (*format == HeightFormat::kTiff && output.tiles.empty() &&
      output.tile_size.value_or(256) % 16 != 0) {
    return absl::InvalidArgumentError(fmt::format(
        "--tile-size: must be a multiple of 16 for one .tif, got {}",
        *output.tile_size));
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
    return PrintEstimate(*request, *terrain, command.output.json, backend.get(),
                         stop);
  }

  const auto start = std::chrono::steady_clock::now();
  const absl::StatusOr<std::optional<v1::SpotReport>> spots =
      PrepareSpots(*terrain, command.output.progress, backend.get(), stop);
  if (!spots.ok()) return ReportStatus(spots.status());

  TerrainExport files(command.output.path,
                      command.output.tiles.empty()
                          ? TerrainExport::Files::kOne
                          : TerrainExport::Files::kOneATile,
                      SinkOptionsOf(command.output));
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
  if (command.output.json) {
    std::cout << JsonLine(summary) << '\n';
  } else {
    PrintSummary(summary);
  }
  PrintSpotReport(*spots, *terrain);
  return kExitOk;
}

void AddOutputOptions(CLI::App* app, TerrainCommand* command) {
  const HeightOutputOptions options =
      AddHeightOutputOptions(app, &command->output);
  options.tiles->excludes("--window");
  CLI::Option* dry_run = app->add_flag("--dry-run", command->dry_run,
                                       "Only print samples, bytes and cost")
                             ->group("Output");
  app->parse_complete_callback([command, out = options.out, dry_run] {
    if (out->count() == 0 && dry_run->count() == 0) {
      throw CLI::RequiredError("--out");
    }
    CheckHeightOutput(command->output);
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
