#include "server/actor/tile_job.h"

#include <chrono>
#include <span>
#include <string>
#include <utility>

#include "server/actor/height_tile.h"
#include "server/convert/enum_table.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

// The range that 16-bit tiles are encoded over; a terrain of one height gets a
// range around it, since a range has an extent.
EncodingRange RangeFor(const core::Terrain& terrain, const TilePlan& plan) {
  if (plan.range.has_value()) return *plan.range;
  const core::HeightRange likely = terrain.LikelyRange();
  if (likely.minimum < likely.maximum) return {likely.minimum, likely.maximum};
  return {likely.minimum - 1.0, likely.minimum + 1.0};
}

class TileJobImpl : public TileJob {
 public:
  TileJobImpl(std::shared_ptr<const PreparedTerrain> prepared,
              const TilePlan& plan, std::shared_ptr<CostMeter> meter)
      : prepared_(std::move(prepared)),
        plan_(plan),
        range_(RangeFor(*prepared_->terrain, plan)),
        meter_(std::move(meter)) {
    WriteHeader();
  }

  const v1::StreamHeader& header() const override { return header_; }
  std::int64_t total() const override { return plan_.total(); }
  std::int64_t first() const override { return plan_.first_tile; }
  double EstimatedSeconds() const override {
    return meter_->Seconds(WorkOf(*prepared_->terrain, plan_).points);
  }

  absl::Status MakeTile(std::int64_t index, std::stop_token stop,
                        core::TileScratch* scratch,
                        v1::HeightTile* tile) const override;

 private:
  void WriteHeader();
  absl::Status Generate(const core::TileRequest& request, std::stop_token stop,
                        core::TileScratch* scratch,
                        std::span<float> heights) const;

  const std::shared_ptr<const PreparedTerrain> prepared_;
  const TilePlan plan_;
  const EncodingRange range_;
  const std::shared_ptr<CostMeter> meter_;
  v1::StreamHeader header_;
};

void TileJobImpl::WriteHeader() {
  const core::Terrain& terrain = *prepared_->terrain;
  *header_.mutable_recipe() = prepared_->recipe;
  header_.set_recipe_hash(prepared_->recipe_hash);
  header_.set_revision(core::kTerrainRevision);
  header_.set_level(plan_.level);
  header_.set_sampling(WriteEnum(kSamplings, plan_.sampling));
  header_.set_encoding(plan_.encoding);
  if (plan_.encoding == v1::HEIGHT_ENCODING_UINT16_LE) {
    header_.mutable_range()->set_minimum(range_.minimum);
    header_.mutable_range()->set_maximum(range_.maximum);
  }
  WriteWindow(plan_.whole, header_.mutable_window());
  WriteFrame(SampleFrame(terrain.spec().frame.value_or(core::Frame{}),
                         plan_.level, plan_.sampling),
             prepared_->recipe.frame().crs(), header_.mutable_frame());
  header_.set_tile_columns(plan_.columns);
  header_.set_tile_rows(plan_.rows);
  header_.set_tile_size(plan_.tile_size);
  if (const auto bound = terrain.DeviationBound()) {
    header_.set_deviation_bound(*bound);
  }
  if (const auto spots = terrain.spots()) {
    *header_.mutable_spots() = WriteSpotReport(*spots);
  }
}

absl::Status TileJobImpl::Generate(const core::TileRequest& request,
                                   std::stop_token stop,
                                   core::TileScratch* scratch,
                                   std::span<float> heights) const {
  const auto start = std::chrono::steady_clock::now();
  const absl::Status status =
      prepared_->terrain->Generate(request, std::move(stop), scratch, heights);
  if (status.ok()) {
    meter_->Add(std::chrono::steady_clock::now() - start,
                prepared_->terrain->GeneratedPoints(request));
  }
  return status;
}

absl::Status TileJobImpl::MakeTile(std::int64_t index, std::stop_token stop,
                                   core::TileScratch* scratch,
                                   v1::HeightTile* tile) const {
  if (index < first() || index >= total()) {
    return absl::OutOfRangeError("there is no tile " + std::to_string(index));
  }
  const std::int64_t column = index % plan_.columns;
  const std::int64_t row = index / plan_.columns;
  const core::TileRequest request{plan_.level, plan_.sampling,
                                  plan_.TileWindow(column, row)};
  const absl::Status status = FillHeightTile(
      plan_.encoding, range_, request.window,
      [&](std::span<float> heights) {
        return Generate(request, std::move(stop), scratch, heights);
      },
      tile);
  if (!status.ok()) return status;
  tile->set_index(index);
  tile->set_total(total());
  tile->set_tile_x(plan_.tile_x + column);
  tile->set_tile_y(plan_.tile_y + row);
  tile->set_level(plan_.level);
  tile->set_sampling(header_.sampling());
  return absl::OkStatus();
}

}  // namespace

TileWork WorkOf(const core::Terrain& terrain, const TilePlan& plan) {
  TileWork work;
  for (const TileKind& kind : RemainingTiles(plan)) {
    const std::int64_t points =
        terrain.GeneratedPoints({plan.level, plan.sampling, kind.example});
    work.samples += kind.count * kind.example.width * kind.example.height;
    work.points += kind.count * points;
    work.largest = std::max(work.largest, points);
  }
  return work;
}

std::shared_ptr<const TileJob> MakeTileJob(
    std::shared_ptr<const PreparedTerrain> prepared, const TilePlan& plan,
    std::shared_ptr<CostMeter> meter) {
  return std::make_shared<TileJobImpl>(std::move(prepared), plan,
                                       std::move(meter));
}

}  // namespace terrane::server
