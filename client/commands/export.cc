// `terrane export`: the tiles of a terrain, one file each, made by one of
// several shards that need not know of each other.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

#include "client/chosen_spots.h"
#include "client/commands/command.h"
#include "client/commands/height_output.h"
#include "client/commands/shared_options.h"
#include "client/exit_code.h"
#include "client/export_manifest.h"
#include "client/export_shard.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane export --preset fbm/fig06b --level 9 --tiles all --out world/tile.tif
  terrane export --dem model.tif --tiles all --out world/tile.exr --shards 4 --shard 0
  parallel terrane export --preset fbm/fig06b --level 9 --tiles all \
    --out world/tile.tif --shards 4 --shard {} ::: 0 1 2 3
  terrane export --verify --out world/tile.tif --shards 4
A shard makes one run of the tiles, counted row by row. It writes what it made to
world/tile.tif.shard-I-of-N.json and, run again, makes only what is missing.
Exit codes: 0 all is there, 1 error, 2 usage, 3 some tiles are there, 4 server
not reached, 130 interrupted.)";

constexpr std::int64_t kMostShards = 1'000'000;
constexpr std::int64_t kMostTilesAShard = 100'000;

struct ExportCommand {
  ConnectionOptions connection;
  TerrainOptions terrain;
  ExtentOptions extent;
  HeightOutput output;
  std::int64_t shards = 1;
  std::int64_t shard = 0;
  bool verify = false;
};

int Usage(const absl::Status& status) {
  ReportStatus(status);
  return kExitUsage;
}

// The formats of 16 bits need one range, and no shard knows that of the others.
absl::Status CheckOutput(const HeightOutput& output) {
  const absl::StatusOr<HeightFormat> format = FormatOf(output.path);
  if (!format.ok()) return format.status();
  if (IsQuantised(*format) && output.range.empty()) {
    return absl::InvalidArgumentError(
        "--range: must be given for .png and .r16, whose tiles share it");
  }
  return absl::OkStatus();
}

// What can be counted, and listed in a manifest.
absl::Status CheckTiles(const v1::TileRange& tiles, std::int64_t shards) {
  if (tiles.columns() < 1 || tiles.rows() < 1) {
    return absl::InvalidArgumentError(
        fmt::format("--tiles: COLUMNS and ROWS must be at least 1, got {},{}",
                    tiles.columns(), tiles.rows()));
  }
  const std::int64_t most = kMostTilesAShard * shards;
  if (tiles.columns() > most / tiles.rows()) {
    return absl::InvalidArgumentError(fmt::format(
        "--shards: a shard makes at most {} tiles, got {} x {} tiles for {}",
        kMostTilesAShard, tiles.columns(), tiles.rows(), shards));
  }
  return absl::OkStatus();
}

std::string CompressionName(Compression compression) {
  for (const auto& [name, value] : kCompressions) {
    if (value == compression) return name;
  }
  return "";
}

ExportJob JobOf(const ExportCommand& command,
                const v1::StreamTilesRequest& request,
                const v1::PreparedTerrain& prepared) {
  ExportJob job;
  job.set_recipe_hash(prepared.recipe_hash());
  job.set_revision(prepared.revision());
  job.set_level(request.level());
  job.set_sampling(request.sampling() == v1::SAMPLING_AREA ? "area" : "point");
  job.set_tile_size(request.tile_size());
  job.set_tile_x(static_cast<double>(request.tiles().x()));
  job.set_tile_y(static_cast<double>(request.tiles().y()));
  job.set_tile_columns(static_cast<double>(request.tiles().columns()));
  job.set_tile_rows(static_cast<double>(request.tiles().rows()));
  job.set_file(std::filesystem::path(command.output.path).filename());
  job.set_compression(CompressionName(command.output.compression));
  if (!command.output.range.empty()) {
    job.set_minimum(command.output.range[0]);
    job.set_maximum(command.output.range[1]);
  }
  job.set_shards(static_cast<double>(command.shards));
  return job;
}

void Print(const ExportSummary& summary, bool json) {
  if (json) {
    std::cout << JsonLine(summary) << '\n';
    return;
  }
  std::cout << fmt::format(
      "{} tiles, {} made now, {} there already, {}B, {:.2f} s\n",
      summary.tiles(), summary.made(), summary.kept(),
      ShortNumber(summary.bytes()), summary.seconds());
}

int Verify(const ExportCommand& command, std::stop_token stop) {
  ExportSummary summary;
  const absl::StatusOr<std::vector<std::string>> faults =
      VerifyExport(command.output.path, command.shards, stop, &summary);
  if (!faults.ok()) return ReportStatus(faults.status());
  for (const std::string& fault : *faults) {
    std::cerr << "terrane: " << fault << '\n';
  }
  Print(summary, command.output.json);
  return faults->empty() ? kExitOk : kExitPartial;
}

int Export(const ExportCommand& command, std::stop_token stop) {
  const absl::Status usable = CheckOutput(command.output);
  if (!usable.ok()) return Usage(usable);
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenTerrain> terrain =
      ChooseTerrain(command.terrain, command.extent.level, backend.get(), stop);
  if (!terrain.ok()) return ReportStatus(terrain.status());
  const absl::StatusOr<v1::StreamTilesRequest> request =
      TilesRequest(command.output, command.extent.sampling, *terrain);
  if (!request.ok()) return Usage(request.status());
  const absl::Status counted = CheckTiles(request->tiles(), command.shards);
  if (!counted.ok()) return Usage(counted);

  const auto start = std::chrono::steady_clock::now();
  const absl::StatusOr<v1::PreparedTerrain> prepared =
      PrepareTerrain(*terrain, command.output.progress, backend.get(), stop);
  if (!prepared.ok()) return ReportStatus(prepared.status());

  ExportShard shard(command.output.path, JobOf(command, *request, *prepared),
                    command.shard, *request, SinkOptionsOf(command.output));
  const absl::Status status =
      shard.Run(command.output.progress, backend.get(), stop);
  ExportSummary summary = shard.Summary();
  summary.set_seconds(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count());
  Print(summary, command.output.json);
  const int code = ReportStatus(status);
  return code == kExitError && summary.tiles() > 0 ? kExitPartial : code;
}

// Throws CLI's errors for options that are right one by one.
void Check(const ExportCommand& command) {
  if (command.output.path.empty()) throw CLI::RequiredError("--out");
  if (command.shard >= command.shards) {
    throw CLI::ValidationError(fmt::format("--shard: must be 0 to {}, got {}",
                                           command.shards - 1, command.shard));
  }
  const std::filesystem::path folder =
      std::filesystem::path(command.output.path).parent_path();
  if (folder.string().find('{') != std::string::npos) {
    throw CLI::ValidationError(
        "--out: {x} and {y} belong into the name of the file, got folder \"" +
        folder.string() + "\"");
  }
  if (!command.verify && command.output.tiles.empty()) {
    throw CLI::RequiredError("--tiles");
  }
  CheckHeightOutput(command.output);
}

}  // namespace

void AddExportCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand = app->add_subcommand(
      "export", "Generate tiles into files, shard by shard");
  const auto command = std::make_shared<ExportCommand>();
  subcommand
      ->add_option("--shards", command->shards,
                   "Shards that the tiles are split over")
      ->check(CLI::Range(std::int64_t{1}, kMostShards))
      ->capture_default_str()
      ->group("Shards");
  subcommand->add_option("--shard", command->shard, "The one to make, from 0")
      ->check(CLI::Range(std::int64_t{0}, kMostShards - 1))
      ->capture_default_str()
      ->group("Shards");
  subcommand
      ->add_flag("--verify", command->verify,
                 "Make nothing: say whether the tiles of all shards are there, "
                 "by the manifests beside --out")
      ->group("Shards");
  AddTerrainOptions(subcommand, &command->terrain);
  AddSampleOptions(subcommand, &command->extent);
  AddHeightOutputOptions(subcommand, &command->output);
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->parse_complete_callback([command] { Check(*command); });
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) {
      return command->verify ? Verify(*command, stop) : Export(*command, stop);
    };
  });
}

}  // namespace terrane::client
