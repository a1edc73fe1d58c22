#include "client/chosen_terrain.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

#include "client/chosen_spots.h"
#include "client/placed_raster.h"

namespace terrane::client {
namespace {

constexpr int kDemLevel = 3;
// The finest level that spot heights snap to.
constexpr int kMaxSpotsLevel = 30;

absl::Status ReadRecipeFile(const std::string& path,
                            v1::TerrainRecipe* recipe) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto status = google::protobuf::util::JsonStringToMessage(text, recipe);
  if (status.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      path + " is not a recipe: " + status.message().ToString());
}

// Uploads the model and makes it the macro shape of a recipe in its own frame.
absl::Status UseDem(const TerrainOptions& options, Backend* backend,
                    std::stop_token stop, ChosenTerrain* terrain) {
  const absl::StatusOr<v1::GetServerInfoResponse> info =
      backend->GetServerInfo(stop);
  if (!info.ok()) return info.status();
  ReadOptions read;
  read.band = options.dem_band;
  read.crs = options.dem_crs;
  read.max_samples = info->limits().max_raster_samples();
  absl::StatusOr<PlacedRaster> dem = ReadRaster(options.dem_file, read);
  if (!dem.ok()) return dem.status();
  const auto raster =
      std::make_shared<const core::Raster>(std::move(dem->raster));
  const absl::StatusOr<std::string> raster_id =
      backend->UploadRaster(raster, stop);
  if (!raster_id.ok()) return raster_id.status();

  v1::TerrainRecipe& recipe = terrain->recipe;
  recipe.mutable_macro()->add_parts()->mutable_raster()->set_raster_id(
      *raster_id);
  v1::Frame* frame = recipe.mutable_frame();
  frame->set_origin_x(raster->frame.origin_x);
  frame->set_origin_y(raster->frame.origin_y);
  frame->set_spacing_x(raster->frame.spacing_x);
  frame->set_spacing_y(raster->frame.spacing_y);
  frame->set_crs(dem->crs);
  terrain->domain.emplace();
  terrain->domain->set_cells_x(raster->width - 1);
  terrain->domain->set_cells_y(raster->height - 1);
  if (options.no_refine) {
    *recipe.mutable_domain() = *terrain->domain;
  } else {
    recipe.mutable_refinement();
  }
  return absl::OkStatus();
}

absl::Status SetRoughness(const std::string& text, v1::TerrainRecipe* recipe) {
  if (text == "auto") {
    recipe->clear_roughness();
    return absl::OkStatus();
  }
  double roughness = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, roughness);
  if (result.ec != std::errc() || result.ptr != end) {
    return absl::InvalidArgumentError(
        "--roughness: must be \"auto\" or a number in (0, 1), got \"" + text +
        "\"");
  }
  recipe->set_roughness(roughness);
  return absl::OkStatus();
}

// Whether anything but the seed differs from the recipe as it is.
bool HasOverrides(const TerrainOptions& options) {
  return options.source.has_value() || options.mapping.has_value() ||
         !options.roughness.empty() || options.fidelity.has_value() ||
         !options.spots.path.empty();
}

absl::Status Override(const TerrainOptions& options,
                      v1::TerrainRecipe* recipe) {
  if (options.source.has_value()) recipe->set_source(*options.source);
  if (options.mapping.has_value()) recipe->set_mapping(*options.mapping);
  if (options.fidelity.has_value()) recipe->set_fidelity(*options.fidelity);
  if (options.roughness.empty()) return absl::OkStatus();
  return SetRoughness(options.roughness, recipe);
}

absl::Status UsePreset(const std::string& name, Backend* backend,
                       std::stop_token stop, ChosenTerrain* terrain) {
  v1::GetPresetRequest request;
  request.set_name(name);
  const absl::StatusOr<v1::GetPresetResponse> answer =
      backend->GetPreset(request, stop);
  if (!answer.ok()) return answer.status();
  terrain->recipe = answer->preset().recipe();
  terrain->view = answer->preset().view();
  terrain->title = answer->preset().title();
  return absl::OkStatus();
}

absl::Status UseBase(const TerrainOptions& options, Backend* backend,
                     std::stop_token stop, ChosenTerrain* terrain) {
  if (!options.dem_file.empty()) {
    return UseDem(options, backend, stop, terrain);
  }
  absl::Status status;
  if (!options.preset.empty()) {
    status = UsePreset(options.preset, backend, stop, terrain);
  } else if (!options.recipe_file.empty()) {
    status = ReadRecipeFile(options.recipe_file, &terrain->recipe);
  }
  if (terrain->recipe.has_domain()) terrain->domain = terrain->recipe.domain();
  return status;
}

// The level to make when none was asked for.
int DefaultLevel(const ChosenTerrain& terrain) {
  if (terrain.recipe.has_refinement()) return kDemLevel;
  return terrain.view.level();
}

}  // namespace

absl::StatusOr<ChosenTerrain> ChooseTerrain(const TerrainOptions& options,
                                            std::optional<int> level,
                                            Backend* backend,
                                            std::stop_token stop) {
  ChosenTerrain terrain;
  absl::Status status = UseBase(options, backend, stop, &terrain);
  if (status.ok()) status = Override(options, &terrain.recipe);
  if (!status.ok()) return status;
  terrain.level = level.value_or(DefaultLevel(terrain));
  if (!options.spots.path.empty()) {
    const int spots_level =
        options.spots_level.value_or(std::min(terrain.level, kMaxSpotsLevel));
    auto spots =
        UseSpots(options.spots, spots_level, backend, stop, &terrain.recipe);
    if (!spots.ok()) return spots.status();
    terrain.spots = *std::move(spots);
  }
  if (!options.preset.empty() && !HasOverrides(options)) {
    terrain.choice.set_preset(options.preset);
  } else {
    *terrain.choice.mutable_recipe() = terrain.recipe;
  }
  if (options.seed.has_value()) terrain.choice.set_seed(*options.seed);
  return terrain;
}

}  // namespace terrane::client
