// The spot heights of --spots: from a file into a recipe, and the preparation
// that they take.
#ifndef TERRANE_CLIENT_CHOSEN_SPOTS_H_
#define TERRANE_CLIENT_CHOSEN_SPOTS_H_

#include <memory>
#include <optional>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/backend.h"
#include "client/progress.h"
#include "client/spot_file.h"

namespace terrane::client {

struct ChosenTerrain;

// Reads the file, brings it into the CRS of the terrain, uploads its points and
// puts them and its lines in the place of the recipe's own spot heights. Says
// on standard error when a CRS is not known.
absl::StatusOr<std::shared_ptr<const SpotFile>> UseSpots(
    const SpotFileOptions& options, int level, Backend* backend,
    std::stop_token stop, v1::TerrainRecipe* recipe);

// An error of a call in which rows of the file's table and its lines are named
// by their place in the file.
absl::Status NameRows(const absl::Status& status, const ChosenTerrain& terrain);

// Makes a terrain ready; with spot heights it shows how far that is. Errors are
// named by NameRows.
absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(const ChosenTerrain& terrain,
                                                   ProgressMode progress,
                                                   Backend* backend,
                                                   std::stop_token stop);

// Makes a terrain with spot heights ready, and shows how far that is; nothing
// to do for one without. Errors are named by NameRows.
absl::StatusOr<std::optional<v1::SpotReport>> PrepareSpots(
    const ChosenTerrain& terrain, ProgressMode progress, Backend* backend,
    std::stop_token stop);

// One line on standard error: what became of the spot heights.
void PrintSpotReport(const std::optional<v1::SpotReport>& report,
                     const ChosenTerrain& terrain);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHOSEN_SPOTS_H_
