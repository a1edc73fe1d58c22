// From the options that say which terrain, to the recipe that is asked for.
#ifndef TERRANE_CLIENT_CHOSEN_TERRAIN_H_
#define TERRANE_CLIENT_CHOSEN_TERRAIN_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/backend.h"
#include "client/spot_file.h"

namespace terrane::client {

// At most one of preset, recipe_file and dem_file; none: a recipe of defaults.
// What is set further down takes the place of what the recipe says.
struct TerrainOptions {
  std::string preset;
  std::string recipe_file;
  std::string dem_file;
  int dem_band = 0;
  std::string dem_crs;
  // The elevation model as a plain macro shape instead of a refinement.
  bool no_refine = false;
  std::optional<std::int64_t> seed;
  std::optional<v1::FractalSource> source;
  std::optional<v1::HeightMapping> mapping;
  // "auto" or H; empty: as the recipe says.
  std::string roughness;
  std::optional<double> fidelity;
  // Spot heights in the place of the recipe's own; an empty path: as it says.
  SpotFileOptions spots;
  // Level that they snap to; default: the level that is made.
  std::optional<int> spots_level;
};

struct ChosenTerrain {
  v1::TerrainChoice choice;
  // The recipe before the server fills in its defaults.
  v1::TerrainRecipe recipe;
  // Its bounded domain, that of an elevation model included; nothing when it is
  // endless or only the server knows.
  std::optional<v1::Domain> domain;
  // How a preset wants to be looked at; empty otherwise.
  v1::PresetView view;
  std::string title;
  // The file of --spots, whose rows errors speak of; null without one.
  std::shared_ptr<const SpotFile> spots;
  // The level to make.
  int level = 0;
};

// Reads files, uploads the elevation model and the spot heights, and asks for
// the preset. `level` is the one asked for; without it the preset's view says,
// level 3 of an elevation model, else 0. Errors: an unreadable file, a recipe
// that is no JSON of a TerrainRecipe, a roughness that is no number, and those
// of the backend.
absl::StatusOr<ChosenTerrain> ChooseTerrain(const TerrainOptions& options,
                                            std::optional<int> level,
                                            Backend* backend,
                                            std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHOSEN_TERRAIN_H_
