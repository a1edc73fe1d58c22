// `terrane heights`: heights at scattered points, CSV in and out.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>

#include "client/chosen_spots.h"
#include "client/commands/command.h"
#include "client/commands/shared_options.h"
#include "client/csv.h"
#include "client/exit_code.h"
#include "core/grid/lattice_window.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  echo "10,20" | terrane heights --preset fbm/fig06b
  terrane heights --dem model.tif --level 3 --points trees.csv --out z.csv
Points are x,y in world units (the CRS of --dem, x east); the answer is x,y,z.)";

struct HeightsCommand {
  ConnectionOptions connection;
  TerrainOptions terrain;
  std::optional<int> level;
  std::string points = "-";
  std::string out = "-";
};

using Columns = std::vector<std::vector<double>>;

absl::StatusOr<Columns> ReadPoints(const std::string& path) {
  if (path == "-") return ReadCsv(&std::cin, "standard input", 2);
  std::ifstream file(path);
  if (!file) return absl::NotFoundError("cannot read " + path);
  return ReadCsv(&file, path, 2);
}

// Asks for points [first, last) and appends their lines.
absl::Status AppendHeights(const Columns& points, std::size_t first,
                           std::size_t last, Backend* backend,
                           std::stop_token stop, v1::GetHeightsRequest* request,
                           std::string* text) {
  request->clear_points();
  for (std::size_t i = first; i < last; ++i) {
    v1::Point* point = request->add_points();
    point->set_x(points[0][i]);
    point->set_y(points[1][i]);
  }
  const absl::StatusOr<v1::GetHeightsResponse> answer =
      backend->GetHeights(*request, stop);
  if (!answer.ok()) return answer.status();
  for (std::size_t i = first; i < last; ++i) {
    *text += fmt::format("{},{},{}\n", points[0][i], points[1][i],
                         answer->heights(static_cast<int>(i - first)));
  }
  return absl::OkStatus();
}

int Run(const HeightsCommand& command, std::stop_token stop) {
  const absl::StatusOr<Columns> points = ReadPoints(command.points);
  if (!points.ok()) return ReportStatus(points.status());
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenTerrain> terrain =
      ChooseTerrain(command.terrain, command.level, backend.get(), stop);
  if (!terrain.ok()) return ReportStatus(terrain.status());
  const absl::StatusOr<v1::GetServerInfoResponse> info =
      backend->GetServerInfo(stop);
  if (!info.ok()) return ReportStatus(info.status());

  const absl::StatusOr<std::optional<v1::SpotReport>> spots =
      PrepareSpots(*terrain, ProgressMode::kAuto, backend.get(), stop);
  if (!spots.ok()) return ReportStatus(spots.status());

  v1::GetHeightsRequest request;
  *request.mutable_terrain() = terrain->choice;
  request.set_level(terrain->level);
  const auto most =
      static_cast<std::size_t>(std::max(info->limits().max_points(), 1));
  const std::size_t count = (*points)[0].size();
  std::string text = "x,y,z\n";
  for (std::size_t first = 0; first < count; first += most) {
    const absl::Status status =
        AppendHeights(*points, first, std::min(first + most, count),
                      backend.get(), stop, &request, &text);
    if (!status.ok()) return ReportStatus(status);
  }
  PrintSpotReport(*spots, *terrain);
  return ReportStatus(WriteText(command.out, text));
}

}  // namespace

void AddHeightsCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("heights", "Heights at scattered points");
  const auto command = std::make_shared<HeightsCommand>();
  AddTerrainOptions(subcommand, &command->terrain);
  subcommand
      ->add_option("--level", command->level,
                   "Lattice level that is interpolated (default: the preset's "
                   "view, 3 with --dem, else 0)")
      ->check(CLI::Range(0, core::kMaxLevel));
  subcommand->add_option("--points", command->points,
                         "CSV of x,y (default: standard input)");
  subcommand->add_option("--out", command->out,
                         "CSV file to write (default: standard output)");
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
