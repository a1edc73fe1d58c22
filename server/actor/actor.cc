#include "server/actor/actor.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/base/simd_target.h"
#include "core/base/violations.h"
#include "core/raytrace/ray_tracer.h"
#include "core/surface/surface.h"
#include "core/surface/validate_surface.h"
#include "core/terrain/spec_checks.h"
#include "core/terrain/spot_heights.h"
#include "core/tree/tree_spec.h"
#include "server/actor/chosen_recipe.h"
#include "server/actor/cost_meter.h"
#include "server/actor/error_reason.h"
#include "server/actor/height_tile.h"
#include "server/actor/presets.h"
#include "server/actor/raster_store.h"
#include "server/actor/raster_upload.h"
#include "server/actor/spot_table_store.h"
#include "server/actor/spot_table_upload.h"
#include "server/actor/terrain_cache.h"
#include "server/actor/tile_job.h"
#include "server/convert/request_plan.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

// Spot tables kept: so many of the largest.
constexpr std::int64_t kSpotTables = 16;

// A request's terrain as read: a valid spec only when no violation was added.
struct ReadChoice {
  // Missing is, besides a preset, a raster or a spot table.
  ChosenRecipe<v1::TerrainRecipe> chosen;
  ReadRecipe read;  // of the recipe that was chosen
};

absl::Status RasterNotFound(const std::string& raster_id) {
  return NotFoundError("the raster is not (or no longer) kept; upload it again",
                       {std::string(kRasterNotFound), "raster_id", raster_id});
}

absl::Status SpotTableNotFound(const std::string& table_id) {
  return NotFoundError(
      "the spot table is not (or no longer) kept; upload it again",
      {std::string(kSpotTableNotFound), "table_id", table_id});
}

class TerrainActor : public Actor {
 public:
  TerrainActor(const Limits& limits, int workers)
      : limits_(limits),
        workers_(workers),
        rasters_(limits.raster_store_bytes),
        spot_tables_(kSpotTables * SpotTableBytes(limits.recipe.max_spots)),
        terrains_(limits.prepared_bytes),
        meter_(std::make_shared<CostMeter>()),
        surfaces_(limits),
        trees_(limits),
        flowers_(limits),
        renders_(this, limits) {}

  absl::StatusOr<v1::Window> CheckTiles(
      const v1::StreamTilesRequest& request) override;
  absl::StatusOr<std::shared_ptr<const TileJob>> OpenTiles(
      const v1::StreamTilesRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(
      const v1::PrepareTerrainRequest& request, const OnProgress& on_progress,
      std::stop_token stop) override;
  absl::StatusOr<v1::GetProfileResponse> GetProfile(
      const v1::GetProfileRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetHeightsResponse> GetHeights(
      const v1::GetHeightsRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::EstimateTilesResponse> EstimateTiles(
      const v1::EstimateTilesRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetPresetResponse> GetPreset(
      const v1::GetPresetRequest& request) override;
  v1::GetServerInfoResponse GetServerInfo() override;
  const SurfaceMaker& surfaces() const override { return surfaces_; }
  const TreeMaker& trees() const override { return trees_; }
  const FlowerMaker& flowers() const override { return flowers_; }
  const RenderMaker& renders() const override { return renders_; }
  std::unique_ptr<RasterUpload> BeginRasterUpload() override {
    return MakeRasterUpload(limits_, &rasters_);
  }
  absl::StatusOr<v1::GetRasterResponse> GetRaster(
      const v1::GetRasterRequest& request) override;
  std::unique_ptr<SpotTableUpload> BeginSpotTableUpload() override {
    return MakeSpotTableUpload(limits_, &spot_tables_);
  }
  absl::StatusOr<v1::GetSpotTableResponse> GetSpotTable(
      const v1::GetSpotTableRequest& request) override;

 private:
  struct PlannedTiles {
    ReadChoice choice;
    TilePlan plan;
  };

  // Finds and converts the terrain of a request.
  ReadChoice Read(const v1::TerrainChoice& choice, const std::string& prefix,
                  core::Violations* violations);
  // The terrain of a valid choice, from the cache or made now.
  absl::StatusOr<std::shared_ptr<const PreparedTerrain>> Prepare(
      const ReadChoice& choice, const core::Preparation& preparation);
  absl::StatusOr<PlannedTiles> Plan(const v1::StreamTilesRequest& request,
                                    const std::string& prefix);

  const Limits limits_;
  const int workers_;
  RasterStore rasters_;
  SpotTableStore spot_tables_;
  TerrainCache terrains_;
  const std::shared_ptr<CostMeter> meter_;
  const SurfaceMaker surfaces_;
  const TreeMaker trees_;
  const FlowerMaker flowers_;
  const RenderMaker renders_;
};

// The spec to plan with, or null when there is none or it has violations.
const core::TerrainSpec* ValidSpec(const ReadChoice& choice,
                                   const core::Violations& violations) {
  const core::TerrainSpec& spec = choice.read.spec;
  // The domain of a refinement is that of its raster.
  const bool knows_domain =
      !spec.refinement.has_value() || core::RefinedRaster(spec) != nullptr;
  return violations.empty() && choice.chosen.recipe.has_value() && knows_domain
             ? &spec
             : nullptr;
}

ReadChoice TerrainActor::Read(const v1::TerrainChoice& choice,
                              const std::string& prefix,
                              core::Violations* violations) {
  ReadChoice result;
  result.chosen = ChooseRecipe<v1::TerrainRecipe>(
      choice, FindPreset, prefix + "terrain", violations);
  if (!result.chosen.recipe.has_value()) return result;
  result.read =
      ReadTerrainRecipe(*result.chosen.recipe, {&rasters_, &spot_tables_},
                        limits_.recipe, result.chosen.prefix, violations);
  if (!result.read.missing_raster.empty()) {
    result.chosen.missing = RasterNotFound(result.read.missing_raster);
  } else if (!result.read.missing_spot_table.empty()) {
    result.chosen.missing = SpotTableNotFound(result.read.missing_spot_table);
  }
  return result;
}

absl::StatusOr<std::shared_ptr<const PreparedTerrain>> TerrainActor::Prepare(
    const ReadChoice& choice, const core::Preparation& preparation) {
  const std::int64_t bytes =
      core::Terrain::EstimatePreparation(choice.read.spec).memory_bytes;
  if (bytes > limits_.prepared_bytes) {
    return absl::ResourceExhaustedError(
        "making the terrain ready takes up to " + std::to_string(bytes) +
        " bytes; the server gives " + std::to_string(limits_.prepared_bytes));
  }
  auto prepared =
      terrains_.Prepare(*choice.chosen.recipe, choice.read, preparation);
  const std::vector<core::Violation> found =
      core::ViolationsOf(prepared.status());
  if (found.empty()) return prepared;
  // The core speaks of the recipe, the answer of the request.
  core::Violations violations;
  for (const core::Violation& one : found) {
    violations.Add(choice.chosen.prefix + one.field, one.description);
  }
  return violations.ToStatus();
}

absl::StatusOr<TerrainActor::PlannedTiles> TerrainActor::Plan(
    const v1::StreamTilesRequest& request, const std::string& prefix) {
  core::Violations violations;
  PlannedTiles planned;
  planned.choice = Read(request.terrain(), prefix, &violations);
  planned.plan = PlanTiles(request, ValidSpec(planned.choice, violations),
                           limits_, prefix, &violations);
  const absl::Status fault = FaultOf(violations, planned.choice.chosen.missing);
  if (!fault.ok()) return fault;
  return planned;
}

absl::StatusOr<v1::Window> TerrainActor::CheckTiles(
    const v1::StreamTilesRequest& request) {
  const auto planned = Plan(request, "");
  if (!planned.ok()) return planned.status();
  v1::Window window;
  WriteWindow(planned->plan.whole, &window);
  return window;
}

absl::StatusOr<std::shared_ptr<const TileJob>> TerrainActor::OpenTiles(
    const v1::StreamTilesRequest& request, std::stop_token stop) {
  const auto planned = Plan(request, "");
  if (!planned.ok()) return planned.status();
  auto prepared = Prepare(planned->choice, {std::move(stop), {}});
  if (!prepared.ok()) return prepared.status();
  return MakeTileJob(*std::move(prepared), planned->plan, meter_);
}

absl::StatusOr<v1::PreparedTerrain> TerrainActor::PrepareTerrain(
    const v1::PrepareTerrainRequest& request, const OnProgress& on_progress,
    std::stop_token stop) {
  core::Violations violations;
  const ReadChoice choice = Read(request.terrain(), "", &violations);
  const absl::Status fault = FaultOf(violations, choice.chosen.missing);
  if (!fault.ok()) return fault;
  const auto prepared = Prepare(choice, {std::move(stop), on_progress});
  if (!prepared.ok()) return prepared.status();
  v1::PreparedTerrain answer;
  *answer.mutable_recipe() = (*prepared)->recipe;
  answer.set_recipe_hash((*prepared)->recipe_hash);
  answer.set_revision(core::kTerrainRevision);
  answer.set_memory_bytes((*prepared)->memory_bytes);
  if (const auto spots = (*prepared)->terrain->spots()) {
    *answer.mutable_spots() = WriteSpotReport(*spots);
  }
  return answer;
}

// The terrain without what takes a preparation of minutes. Conditioning moves
// lattice points but adds none, so an estimate counts the same.
ReadChoice WithoutConditioning(ReadChoice choice) {
  core::TerrainSpec& spec = choice.read.spec;
  if (core::ConditionsDiscrete(spec)) {
    spec.discrete_constraints.clear();
    spec.discrete_method.reset();
    choice.chosen.recipe->clear_discrete_constraints();
    choice.chosen.recipe->clear_discrete_method();
  }
  spec.spots = {};
  choice.read.spot_table_id.clear();
  choice.chosen.recipe->clear_spots();
  return choice;
}

absl::StatusOr<v1::EstimateTilesResponse> TerrainActor::EstimateTiles(
    const v1::EstimateTilesRequest& request, std::stop_token stop) {
  const auto planned = Plan(request.request(), "request.");
  if (!planned.ok()) return planned.status();
  const TilePlan& plan = planned->plan;
  const core::PreparationCost preparation =
      core::Terrain::EstimatePreparation(planned->choice.read.spec);
  const auto prepared =
      Prepare(WithoutConditioning(planned->choice), {std::move(stop), {}});
  if (!prepared.ok()) return prepared.status();
  v1::EstimateTilesResponse estimate;
  const TileWork work = WorkOf(*(*prepared)->terrain, plan);
  estimate.set_tiles(plan.total() - plan.first_tile);
  estimate.set_samples(work.samples);
  estimate.set_data_bytes(work.samples * plan.bytes_per_sample());
  estimate.set_generated_points(work.points);
  estimate.set_cpu_seconds(meter_->Seconds(work.points));
  // Two tiles in hand, and the lattice of the one being generated.
  estimate.set_memory_bytes(2 * std::int64_t{plan.tile_size} * plan.tile_size *
                                plan.bytes_per_sample() +
                            work.largest * std::int64_t{sizeof(float)});
  estimate.set_prepare_seconds(preparation.cpu_seconds);
  estimate.set_prepare_bytes(preparation.memory_bytes);
  return estimate;
}

absl::StatusOr<v1::GetProfileResponse> TerrainActor::GetProfile(
    const v1::GetProfileRequest& request, std::stop_token stop) {
  core::Violations violations;
  const ReadChoice choice = Read(request.terrain(), "", &violations);
  const core::TileRequest plan = PlanProfile(
      request, ValidSpec(choice, violations), limits_, "", &violations);
  const absl::Status fault = FaultOf(violations, choice.chosen.missing);
  if (!fault.ok()) return fault;
  const auto prepared = Prepare(choice, {stop, {}});
  if (!prepared.ok()) return prepared.status();
  const core::Terrain& terrain = *(*prepared)->terrain;

  v1::GetProfileResponse response;
  const int count = static_cast<int>(plan.window.width);
  const std::size_t size = static_cast<std::size_t>(count);
  response.mutable_heights()->Resize(count, 0);
  response.mutable_macro_heights()->Resize(count, 0);
  core::TileScratch scratch;
  absl::Status status =
      terrain.Generate(plan, std::move(stop), &scratch,
                       {response.mutable_heights()->mutable_data(), size});
  if (status.ok()) {
    status = terrain.GenerateMacro(
        plan, &scratch,
        {response.mutable_macro_heights()->mutable_data(), size});
  }
  if (!status.ok()) return status;
  *response.mutable_recipe() = (*prepared)->recipe;
  response.set_recipe_hash((*prepared)->recipe_hash);
  response.set_revision(core::kTerrainRevision);
  const core::Frame frame = SampleFrame(
      terrain.spec().frame.value_or(core::Frame{}), plan.level, plan.sampling);
  response.set_first_x(frame.origin_x +
                       static_cast<double>(plan.window.x) * frame.spacing_x);
  response.set_step_x(frame.spacing_x);
  return response;
}

absl::StatusOr<v1::GetHeightsResponse> TerrainActor::GetHeights(
    const v1::GetHeightsRequest& request, std::stop_token stop) {
  core::Violations violations;
  const ReadChoice choice = Read(request.terrain(), "", &violations);
  const std::vector<core::Point2> points = PlanHeights(
      request, ValidSpec(choice, violations), limits_, "", &violations);
  const absl::Status fault = FaultOf(violations, choice.chosen.missing);
  if (!fault.ok()) return fault;
  const auto prepared = Prepare(choice, {stop, {}});
  if (!prepared.ok()) return prepared.status();

  v1::GetHeightsResponse response;
  response.mutable_heights()->Resize(request.points_size(), 0);
  core::TileScratch scratch;
  const absl::Status status = (*prepared)->terrain->GenerateAt(
      request.level(), points, std::move(stop), &scratch,
      {response.mutable_heights()->mutable_data(), points.size()});
  if (!status.ok()) return status;
  *response.mutable_recipe() = (*prepared)->recipe;
  response.set_recipe_hash((*prepared)->recipe_hash);
  response.set_revision(core::kTerrainRevision);
  return response;
}

absl::StatusOr<v1::GetPresetResponse> TerrainActor::GetPreset(
    const v1::GetPresetRequest& request) {
  const auto preset = FindPreset(request.name());
  if (!preset.ok()) return preset.status();
  v1::GetPresetResponse response;
  *response.mutable_preset() = **preset;
  return response;
}

absl::StatusOr<v1::GetRasterResponse> TerrainActor::GetRaster(
    const v1::GetRasterRequest& request) {
  auto stored = rasters_.Get(request.raster_id());
  if (!stored.has_value()) return RasterNotFound(request.raster_id());
  return std::move(stored->description);
}

absl::StatusOr<v1::GetSpotTableResponse> TerrainActor::GetSpotTable(
    const v1::GetSpotTableRequest& request) {
  auto stored = spot_tables_.Get(request.table_id());
  if (!stored.has_value()) return SpotTableNotFound(request.table_id());
  return std::move(stored->description);
}

v1::ServerLimits WriteLimits(const Limits& limits) {
  v1::ServerLimits message;
  message.set_max_request_bytes(limits.max_request_bytes);
  message.set_max_level(limits.max_level);
  message.set_max_tile_size(limits.max_tile_size);
  message.set_max_stream_samples(limits.max_stream_samples);
  message.set_max_points(limits.max_points);
  message.set_max_profile_samples(limits.max_profile_samples);
  message.set_max_discrete_constraints(limits.recipe.max_discrete_constraints);
  message.set_max_continuous_constraints(
      limits.recipe.max_continuous_constraints);
  message.set_max_vertices(limits.recipe.max_vertices);
  message.set_max_macro_parts(limits.recipe.max_macro_parts);
  message.set_max_raster_samples(limits.max_raster_samples);
  message.set_raster_store_bytes(limits.raster_store_bytes);
  message.set_max_concurrent_streams(limits.max_concurrent_streams);
  message.set_max_spots(limits.recipe.max_spots);
  message.set_max_inline_spots(limits.recipe.max_inline_spots);
  message.set_prepared_bytes(limits.prepared_bytes);
  message.set_max_surface_side(core::kMaxGridSide);
  message.set_max_weight_rules(core::kMaxWeightRules);
  message.set_max_tree_segments(limits.tree.max_segments);
  message.set_max_tree_bytes(limits.tree.max_bytes);
  message.set_max_render_pixels(limits.max_render_pixels);
  message.set_max_render_passes(limits.max_render_passes);
  message.set_max_render_triangles(limits.max_render_triangles);
  message.set_render_bytes(limits.render_bytes);
  message.set_max_render_side(core::kMaxPictureSide);
  message.set_max_forest_trees(limits.max_forest_trees);
  message.set_max_forest_segments(limits.max_forest_segments);
  message.set_max_flower_prototype_bytes(limits.flower.max_prototype_bytes);
  message.set_max_flower_instances(limits.flower.max_instances);
  return message;
}

template <typename Preset>
void AddSummaries(const std::map<std::string, Preset>& presets,
                  const char* generator, v1::GetServerInfoResponse* info) {
  for (const auto& [name, preset] : presets) {
    v1::PresetSummary* summary = info->add_presets();
    summary->set_name(name);
    summary->set_title(preset.title());
    summary->set_generator(generator);
  }
}

v1::GetServerInfoResponse TerrainActor::GetServerInfo() {
  v1::GetServerInfoResponse info;
  info.set_version(TERRANE_VERSION);
  info.set_terrain_revision(core::kTerrainRevision);
  info.set_simd_target(core::SimdTargetName());
  info.set_workers(workers_);
  *info.mutable_limits() = WriteLimits(limits_);
  info.set_surface_revision(core::kSurfaceRevision);
  info.set_tree_revision(core::kTreeRevision);
  info.set_flower_revision(core::kFlowerRevision);
  AddSummaries(Presets(), "terrain", &info);
  AddSummaries(SurfacePresets(), "surface", &info);
  AddSummaries(TreePresets(), "tree", &info);
  AddSummaries(FlowerPresets(), "flower", &info);
  std::sort(info.mutable_presets()->begin(), info.mutable_presets()->end(),
            [](const v1::PresetSummary& a, const v1::PresetSummary& b) {
              return a.name() < b.name();
            });
  return info;
}

}  // namespace

std::unique_ptr<Actor> MakeActor(const Limits& limits, int workers) {
  return std::make_unique<TerrainActor>(limits, workers);
}

}  // namespace terrane::server
