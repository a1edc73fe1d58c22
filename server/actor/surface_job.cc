#include "server/actor/surface_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/surface/height_field.h"
#include "core/surface/surface.h"
#include "server/actor/chosen_recipe.h"
#include "server/actor/height_tile.h"
#include "server/actor/presets.h"
#include "server/convert/column_checksum.h"
#include "server/convert/content_hash.h"
#include "server/convert/enum_table.h"
#include "server/convert/surface_convert.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

// An admitted request: a valid spec and its tiles.
struct PlannedSurface {
  std::shared_ptr<const core::Surface> surface;
  std::optional<core::HeightField> field;  // of a plan for heights
  SurfacePlan plan;

  core::SurfaceRequest TileRequest(std::int64_t index) const {
    const TilePlan& tiles = plan.tiles;
    return {plan.grid,
            tiles.TileWindow(index % tiles.columns, index / tiles.columns)};
  }
};

absl::StatusOr<PlannedSurface> PlanAll(const v1::StreamSurfaceRequest& request,
                                       const Limits& limits,
                                       const std::string& prefix) {
  core::Violations violations;
  const auto chosen = ChooseRecipe<v1::SurfaceRecipe>(
      request.surface(), FindSurfacePreset, prefix + "surface", &violations);
  core::SurfaceSpec spec;
  if (chosen.recipe.has_value()) {
    spec = ReadSurfaceRecipe(*chosen.recipe, chosen.prefix, &violations);
  }
  const bool spec_good = chosen.recipe.has_value() && violations.empty();
  PlannedSurface planned;
  planned.plan = PlanSurface(request, spec_good ? &spec : nullptr, limits,
                             prefix, chosen.prefix, &violations);
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  auto surface = core::Surface::Create(std::move(spec));
  if (!surface.ok()) return surface.status();
  planned.surface = *std::move(surface);
  if (planned.plan.heights) {
    auto field = core::HeightField::Create(planned.surface);
    if (!field.ok()) return field.status();
    planned.field = *std::move(field);
  }
  return planned;
}

// Room for `count` floats a sample in a bytes field, as floats.
std::span<float> Floats(std::size_t samples, std::size_t count,
                        std::string* bytes) {
  bytes->resize(samples * count * sizeof(float));
  return {reinterpret_cast<float*>(bytes->data()), samples * count};
}

// Samples that the tiles from first_tile on take, those before them in carried
// rows included. Tiles of a column cost alike.
std::int64_t GeneratedSamples(const PlannedSurface& planned) {
  const TilePlan& plan = planned.plan.tiles;
  std::int64_t samples = 0;
  for (std::int64_t column = 0; column < plan.columns; ++column) {
    const std::int64_t skipped =
        plan.first_tile / plan.columns +
        (column < plan.first_tile % plan.columns ? 1 : 0);
    for (std::int64_t row : {std::int64_t{0}, plan.rows - 1}) {
      const bool last = row == plan.rows - 1;
      const std::int64_t tiles =
          last ? (skipped < plan.rows ? 1 : 0)
               : std::max<std::int64_t>(plan.rows - 1 - skipped, 0);
      samples += tiles * planned.surface->GeneratedSamples(
                             planned.TileRequest(row * plan.columns + column));
      if (plan.rows == 1) break;
    }
  }
  return samples;
}

class SurfaceJobImpl : public SurfaceJob {
 public:
  SurfaceJobImpl(PlannedSurface planned, std::shared_ptr<CostMeter> meter)
      : planned_(std::move(planned)), meter_(std::move(meter)) {
    WriteHeader();
  }

  const v1::SurfaceHeader& header() const override { return header_; }
  std::int64_t total() const override { return planned_.plan.tiles.total(); }
  std::int64_t first() const override { return planned_.plan.tiles.first_tile; }
  double EstimatedSeconds() const override {
    return meter_->Seconds(GeneratedSamples(planned_));
  }

  absl::Status MakeTile(std::int64_t index, std::stop_token stop,
                        v1::StreamSurfaceResponse* message) const override {
    if (index < first() || index >= total()) {
      return absl::OutOfRangeError("there is no tile " + std::to_string(index));
    }
    const core::SurfaceRequest request = planned_.TileRequest(index);
    const auto start = std::chrono::steady_clock::now();
    const absl::Status status =
        planned_.plan.heights ? MakeHeights(index, request, std::move(stop),
                                            message->mutable_height_tile())
                              : MakeMesh(index, request, std::move(stop),
                                         message->mutable_mesh_tile());
    if (status.ok()) {
      meter_->Add(std::chrono::steady_clock::now() - start,
                  planned_.surface->GeneratedSamples(request));
    }
    return status;
  }

 private:
  void WriteHeader() {
    const SurfacePlan& plan = planned_.plan;
    *header_.mutable_recipe() = WriteSurfaceRecipe(planned_.surface->spec());
    header_.set_recipe_hash(RecipeHash(header_.recipe()));
    header_.set_revision(core::kSurfaceRevision);
    header_.set_columns(plan.grid.columns);
    header_.set_rows(plan.grid.rows);
    header_.set_output(plan.heights ? v1::SURFACE_OUTPUT_HEIGHTS
                                    : v1::SURFACE_OUTPUT_MESH);
    WriteWindow(plan.tiles.whole, header_.mutable_window());
    header_.set_tile_columns(plan.tiles.columns);
    header_.set_tile_rows(plan.tiles.rows);
    header_.set_tile_size(plan.tiles.tile_size);
    header_.set_share_edges(plan.share_edges);
    if (!plan.heights) return;
    header_.set_encoding(plan.tiles.encoding);
    if (plan.tiles.range.has_value()) {
      header_.mutable_range()->set_minimum(plan.tiles.range->minimum);
      header_.mutable_range()->set_maximum(plan.tiles.range->maximum);
    }
    WriteFrame(planned_.field->FrameOf(plan.grid), "", header_.mutable_frame());
  }

  absl::Status MakeMesh(std::int64_t index, const core::SurfaceRequest& request,
                        std::stop_token stop, v1::MeshTile* tile) const {
    const TilePlan& plan = planned_.plan.tiles;
    const auto samples =
        static_cast<std::size_t>(request.window.width * request.window.height);
    const std::span<float> positions =
        Floats(samples, 3, tile->mutable_positions());
    const std::span<float> normals =
        Floats(samples, 3, tile->mutable_normals());
    const std::span<float> uvs =
        Floats(planned_.plan.uvs ? samples : 0, 2, tile->mutable_uvs());
    const absl::Status status = planned_.surface->Generate(
        request, std::move(stop), {positions, normals, uvs});
    if (!status.ok()) return status;
    tile->set_index(index);
    tile->set_total(total());
    tile->set_tile_x(index % plan.columns);
    tile->set_tile_y(index / plan.columns);
    WriteWindow(request.window, tile->mutable_window());
    tile->set_checksum(
        ColumnChecksum({&tile->positions(), &tile->normals(), &tile->uvs()}));
    std::int64_t left_out = 0;
    for (std::size_t k = 0; k < positions.size(); k += 3) {
      left_out += std::isnan(positions[k]) ? 1 : 0;
    }
    tile->set_left_out_samples(left_out);
    return absl::OkStatus();
  }

  absl::Status MakeHeights(std::int64_t index,
                           const core::SurfaceRequest& request,
                           std::stop_token stop, v1::HeightTile* tile) const {
    const TilePlan& plan = planned_.plan.tiles;
    const absl::Status status = FillHeightTile(
        plan.encoding, plan.range.value_or(EncodingRange{}), request.window,
        [&](std::span<float> heights) {
          return planned_.field->Generate(request, std::move(stop), heights);
        },
        tile);
    if (!status.ok()) return status;
    tile->set_index(index);
    tile->set_total(total());
    tile->set_tile_x(index % plan.columns);
    tile->set_tile_y(index / plan.columns);
    tile->set_sampling(v1::SAMPLING_POINT);
    return absl::OkStatus();
  }

  const PlannedSurface planned_;
  const std::shared_ptr<CostMeter> meter_;
  v1::SurfaceHeader header_;
};

}  // namespace

absl::StatusOr<std::shared_ptr<const SurfaceJob>> SurfaceMaker::Open(
    const v1::StreamSurfaceRequest& request) const {
  auto planned = PlanAll(request, limits_, "");
  if (!planned.ok()) return planned.status();
  return std::make_shared<SurfaceJobImpl>(*std::move(planned), meter_);
}

absl::StatusOr<v1::EstimateSurfaceResponse> SurfaceMaker::Estimate(
    const v1::EstimateSurfaceRequest& request) const {
  const auto planned = PlanAll(request.request(), limits_, "request.");
  if (!planned.ok()) return planned.status();
  const SurfacePlan& plan = planned->plan;
  std::int64_t samples = 0;
  for (const TileKind& kind : RemainingTiles(plan.tiles)) {
    samples += kind.count * kind.example.width * kind.example.height;
  }
  const std::int64_t generated = GeneratedSamples(*planned);
  v1::EstimateSurfaceResponse estimate;
  estimate.set_tiles(plan.tiles.total() - plan.tiles.first_tile);
  estimate.set_samples(samples);
  estimate.set_data_bytes(samples * plan.bytes_per_sample());
  estimate.set_generated_samples(generated);
  estimate.set_cpu_seconds(meter_->Seconds(generated));
  // Two tiles in hand, and as much again while one is serialized.
  estimate.set_memory_bytes(3 * std::int64_t{plan.tiles.tile_size} *
                            plan.tiles.tile_size * plan.bytes_per_sample());
  return estimate;
}

absl::StatusOr<v1::GetSurfacePresetResponse> SurfaceMaker::GetPreset(
    const v1::GetSurfacePresetRequest& request) const {
  const auto preset = FindSurfacePreset(request.name());
  if (!preset.ok()) return preset.status();
  v1::GetSurfacePresetResponse response;
  *response.mutable_preset() = **preset;
  return response;
}

}  // namespace terrane::server
