#include "client/chosen_spots.h"

#include <fmt/format.h>

#include <charconv>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "client/chosen_terrain.h"
#include "core/base/violations.h"

namespace terrane::client {
namespace {

// The CRS of a recipe's coordinates; that of a refined model without a frame is
// the server's to know.
absl::StatusOr<std::string> CrsOf(const v1::TerrainRecipe& recipe,
                                  Backend* backend, std::stop_token stop) {
  if (recipe.has_frame() || !recipe.has_refinement() ||
      recipe.macro().parts().empty()) {
    return recipe.frame().crs();
  }
  v1::GetRasterRequest request;
  request.set_raster_id(recipe.macro().parts(0).raster().raster_id());
  const absl::StatusOr<v1::GetRasterResponse> raster =
      backend->GetRaster(request, stop);
  if (!raster.ok()) return raster.status();
  return raster->header().frame().crs();
}

absl::Status MatchCrs(const std::string& terrain_crs, SpotFile* spots) {
  if (terrain_crs.empty() && !spots->crs.empty()) {
    std::cerr << "terrane: " << spots->path
              << " is taken as it is: the terrain has no CRS\n";
  }
  return TransformSpots(terrain_crs, spots);
}

void WriteLine(const SpotPolyline& line, v1::SpotLine* message) {
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    v1::Point* vertex = message->add_vertices();
    vertex->set_x(line.x[i]);
    vertex->set_y(line.y[i]);
  }
  message->mutable_heights()->Add(line.height.begin(), line.height.end());
  message->set_standard_error(line.standard_error);
}

// Puts the place in the file where `text` speaks of a row by its path in the
// request, such as "terrain.recipe.spots.table[17]". `place` answers an empty
// text for a row that it does not know.
void NamePlaces(const std::string& path,
                const std::function<std::string(std::size_t)>& place,
                std::string* text) {
  std::size_t at = 0;
  while ((at = text->find(path, at)) != std::string::npos) {
    std::size_t row = 0;
    const char* const end = text->data() + text->size();
    const auto number =
        std::from_chars(text->data() + at + path.size(), end, row);
    const std::string name =
        number.ec == std::errc() ? place(row) : std::string();
    if (name.empty()) {
      at += path.size();
      continue;
    }
    // The whole word, from the request's own path before it to the "]".
    const std::size_t space = text->find_last_of(' ', at);
    const std::size_t begin = space == std::string::npos ? 0 : space + 1;
    const auto after = static_cast<std::size_t>(number.ptr - text->data()) + 1;
    text->replace(begin, after - begin, name);
    at = begin + name.size();
  }
}

std::string WithPlaces(std::string text, const SpotFile& spots) {
  const SpotTable& table = spots.table;
  NamePlaces(
      "spots.table[",
      [&](std::size_t row) {
        return row < table.rows() ? spots.PlaceOf(table.source[row]) : "";
      },
      &text);
  NamePlaces(
      "spots.lines[",
      [&](std::size_t line) {
        return line < spots.lines.size()
                   ? spots.PlaceOf(spots.lines[line].source)
                   : "";
      },
      &text);
  return text;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const SpotFile>> UseSpots(
    const SpotFileOptions& options, int level, Backend* backend,
    std::stop_token stop, v1::TerrainRecipe* recipe) {
  const int dimensions = recipe->dimensions() == 1 ? 1 : 2;
  absl::StatusOr<SpotFile> read = ReadSpotFile(options, dimensions);
  if (!read.ok()) return read.status();
  const auto spots = std::make_shared<SpotFile>(*std::move(read));
  if (dimensions == 2) {
    const absl::StatusOr<std::string> crs = CrsOf(*recipe, backend, stop);
    if (!crs.ok()) return crs.status();
    const absl::Status status = MatchCrs(*crs, spots.get());
    if (!status.ok()) return status;
  }
  v1::SpotHeights* message = recipe->mutable_spots();
  message->Clear();
  message->set_level(level);
  for (const SpotPolyline& line : spots->lines) {
    WriteLine(line, message->add_lines());
  }
  if (spots->table.rows() > 0) {
    // Shares the file's life, so that the columns are not copied.
    const absl::StatusOr<std::string> id = backend->UploadSpotTable(
        std::shared_ptr<const SpotTable>(spots, &spots->table), stop);
    if (!id.ok()) return id.status();
    message->set_table_id(*id);
  }
  return spots;
}

absl::Status NameRows(const absl::Status& status,
                      const ChosenTerrain& terrain) {
  const std::vector<core::Violation> found = core::ViolationsOf(status);
  if (found.empty() || terrain.spots == nullptr) return status;
  core::Violations violations;
  for (const core::Violation& one : found) {
    violations.Add(WithPlaces(one.field, *terrain.spots),
                   WithPlaces(one.description, *terrain.spots));
  }
  return violations.ToStatus();
}

absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(const ChosenTerrain& terrain,
                                                   ProgressMode progress,
                                                   Backend* backend,
                                                   std::stop_token stop) {
  v1::PrepareTerrainRequest request;
  *request.mutable_terrain() = terrain.choice;
  PreparationProgress shown(terrain.recipe.has_spots() ? progress
                                                       : ProgressMode::kNone);
  absl::StatusOr<v1::PreparedTerrain> prepared = backend->PrepareTerrain(
      request, [&](double fraction) { shown.Show(fraction); }, stop);
  if (!prepared.ok()) return NameRows(prepared.status(), terrain);
  return prepared;
}

absl::StatusOr<std::optional<v1::SpotReport>> PrepareSpots(
    const ChosenTerrain& terrain, ProgressMode progress, Backend* backend,
    std::stop_token stop) {
  if (!terrain.recipe.has_spots()) return std::nullopt;
  const absl::StatusOr<v1::PreparedTerrain> prepared =
      PrepareTerrain(terrain, progress, backend, stop);
  if (!prepared.ok()) return prepared.status();
  if (!prepared->has_spots()) return std::nullopt;
  return prepared->spots();
}

void PrintSpotReport(const std::optional<v1::SpotReport>& report,
                     const ChosenTerrain& terrain) {
  if (!report.has_value()) return;
  const bool exact =
      terrain.spots == nullptr || terrain.spots->table.standard_error.empty();
  std::cerr << fmt::format(
      "terrane: {} spots met {} at level {}, farthest moved {:.6g} by "
      "snapping\n",
      report->spots(), exact ? "exactly" : "within their standard errors",
      report->level(), report->largest_move());
}

}  // namespace terrane::client
