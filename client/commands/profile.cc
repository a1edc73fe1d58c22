// `terrane profile`: samples of a 1-D recipe as CSV.
#include <fmt/format.h>

#include <cstdint>
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
  terrane profile --preset fbm/fig04b --out profile.csv
  terrane profile --preset fbm/fig04b --seed 3 --level 10 --first 0 --count 512
  terrane profile --preset fbm/fig04b --level 8 --spots heights.csv --out met.csv
Columns: x, height D(x), macro shape d(x).)";

struct ProfileCommand {
  ConnectionOptions connection;
  TerrainOptions terrain;
  std::optional<int> level;
  std::int64_t first = 0;
  std::int64_t count = 0;
  std::string out = "-";
};

int Run(const ProfileCommand& command, std::stop_token stop) {
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenTerrain> terrain =
      ChooseTerrain(command.terrain, command.level, backend.get(), stop);
  if (!terrain.ok()) return ReportStatus(terrain.status());
  const absl::StatusOr<std::optional<v1::SpotReport>> spots =
      PrepareSpots(*terrain, ProgressMode::kAuto, backend.get(), stop);
  if (!spots.ok()) return ReportStatus(spots.status());
  v1::GetProfileRequest request;
  *request.mutable_terrain() = terrain->choice;
  request.set_level(terrain->level);
  request.set_first(command.first);
  request.set_count(command.count);
  const absl::StatusOr<v1::GetProfileResponse> profile =
      backend->GetProfile(request, stop);
  if (!profile.ok()) return ReportStatus(profile.status());
  std::string text = "x,height,macro\n";
  for (int i = 0; i < profile->heights_size(); ++i) {
    text +=
        fmt::format("{},{},{}\n", profile->first_x() + i * profile->step_x(),
                    profile->heights(i), profile->macro_heights(i));
  }
  PrintSpotReport(*spots, *terrain);
  return ReportStatus(WriteText(command.out, text));
}

}  // namespace

void AddProfileCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("profile", "Sample a 1-D recipe as CSV");
  const auto command = std::make_shared<ProfileCommand>();
  AddRecipeOptions(subcommand, &command->terrain);
  subcommand
      ->add_option("--level", command->level,
                   "Each level halves the spacing (default: the preset's "
                   "view, else 0)")
      ->check(CLI::Range(0, core::kMaxLevel));
  subcommand->add_option("--first", command->first,
                         "First sample of that level");
  subcommand
      ->add_option("--count", command->count,
                   "Samples (default: all of a bounded domain)")
      ->check(CLI::Range(std::int64_t{0}, core::kMaxIndex));
  subcommand->add_option("--out", command->out,
                         "CSV file to write (default: standard output)");
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
