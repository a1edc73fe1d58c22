#include "server/convert/request_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/terrain/spec_checks.h"
#include "core/terrain/spot_heights.h"
#include "server/convert/axis_checks.h"
#include "server/convert/enum_table.h"

namespace terrane::server {
namespace {

using core::FieldChecks;
using core::kMaxIndex;
using core::NumberText;
using core::Path;
using core::Violations;

constexpr int kDefaultTileSize = 256;

// The domain that requests are checked against; a refinement's is its model's
// posts even before Terrain::Create says so.
std::optional<core::Domain> DomainOf(const core::TerrainSpec& spec) {
  const core::Raster* const raster = core::RefinedRaster(spec);
  if (spec.domain.has_value() || raster == nullptr) return spec.domain;
  return core::Domain{raster->width - 1, raster->height - 1};
}

// Samples along an axis of `cells` level-0 cells: at most 2^60 + 1.
std::int64_t AxisSamples(std::int64_t cells, int level,
                         core::Sampling sampling) {
  return (cells << level) + (sampling == core::Sampling::kPoint ? 1 : 0);
}

// Samples of a domain at a level and sampling.
struct Extent {
  std::int64_t width = 0;
  std::int64_t height = 0;
};

std::optional<Extent> ExtentOf(const core::TerrainSpec* spec, int level,
                               core::Sampling sampling) {
  if (spec == nullptr) return std::nullopt;
  const std::optional<core::Domain> domain = DomainOf(*spec);
  if (!domain.has_value()) return std::nullopt;
  const bool line = spec->dimensions == 1;
  return Extent{AxisSamples(domain->cells_x, level, sampling),
                line ? 1 : AxisSamples(domain->cells_y, level, sampling)};
}

Axis SampleAxis(std::optional<std::int64_t> extent) {
  if (extent.has_value()) return {0, std::min(*extent, kMaxIndex)};
  return {-kMaxIndex, kMaxIndex};
}

// One StreamTiles request being checked.
class TilePlanner {
 public:
  TilePlanner(const v1::StreamTilesRequest& request,
              const core::TerrainSpec* spec, const Limits& limits,
              const Path& root, Violations* violations)
      : request_(request),
        spec_(spec),
        limits_(limits),
        root_(root),
        violations_(violations),
        checks_(violations) {}

  TilePlan Plan();

 private:
  void PlanSamples();
  // These are true when the number of tiles is known.
  bool PlanExtent();
  bool PlanWindow(const v1::Window& window);
  bool PlanTileRange(const v1::TileRange& tiles);
  bool PlanWholeDomain();
  bool CheckTotals(const Path& path) const;
  void CutWindow();
  // Of the samples that may be asked for.
  Axis SamplesX() const;
  Axis SamplesY() const;
  // Whole tiles that fit from sample 0 on, and before it in an endless world.
  Axis TilesOn(const Axis& samples) const;

  const v1::StreamTilesRequest& request_;
  const core::TerrainSpec* const spec_;
  const Limits& limits_;
  const Path& root_;
  Violations* const violations_;
  FieldChecks checks_;
  std::optional<Extent> extent_;
  TilePlan plan_;
};

void TilePlanner::PlanSamples() {
  plan_.level = request_.level();
  const bool level_good =
      checks_.Integer(root_.Field("level"), plan_.level, 0, limits_.max_level);
  plan_.sampling = ReadEnum(kSamplings, request_.sampling(),
                            root_.Field("sampling"), violations_);
  plan_.tile_size =
      request_.tile_size() == 0 ? kDefaultTileSize : request_.tile_size();
  const bool shares_edges =
      request_.has_tiles() && plan_.sampling == core::Sampling::kPoint;
  const int least_size = shares_edges ? 2 : 1;
  if (!checks_.Integer(root_.Field("tile_size"), plan_.tile_size, least_size,
                       limits_.max_tile_size)) {
    // What is wrong with the tiles now is wrong whatever their size.
    plan_.tile_size = least_size;
  }
  plan_.stride = plan_.tile_size - (shares_edges ? 1 : 0);
  if (level_good) extent_ = ExtentOf(spec_, plan_.level, plan_.sampling);
}

Axis TilePlanner::SamplesX() const {
  return SampleAxis(extent_ ? std::optional(extent_->width) : std::nullopt);
}

Axis TilePlanner::SamplesY() const {
  return SampleAxis(extent_ ? std::optional(extent_->height) : std::nullopt);
}

Axis TilePlanner::TilesOn(const Axis& samples) const {
  const std::int64_t shared = plan_.tile_size - plan_.stride;
  return {samples.low / plan_.stride, (samples.end - shared) / plan_.stride};
}

void TilePlanner::CutWindow() {
  plan_.columns = (plan_.whole.width + plan_.tile_size - 1) / plan_.tile_size;
  plan_.rows = (plan_.whole.height + plan_.tile_size - 1) / plan_.tile_size;
}

bool TilePlanner::PlanWindow(const v1::Window& window) {
  const Path path = root_.Field("window");
  plan_.whole = {window.x(), window.y(), window.width(), window.height()};
  const bool columns_good =
      CheckOnAxis(SamplesX(), path.Field("x"), window.x(), path.Field("width"),
                  window.width(), &checks_);
  const bool rows_good =
      CheckOnAxis(SamplesY(), path.Field("y"), window.y(), path.Field("height"),
                  window.height(), &checks_);
  if (!columns_good || !rows_good) return false;
  CutWindow();
  return CheckTotals(path);
}

bool TilePlanner::PlanTileRange(const v1::TileRange& tiles) {
  const Path path = root_.Field("tiles");
  const std::int64_t shared = plan_.tile_size - plan_.stride;
  const Axis columns = TilesOn(SamplesX());
  const Axis rows = TilesOn(SamplesY());
  if (columns.end == 0 || rows.end == 0) {  // a domain smaller than a tile
    checks_.Integer(root_.Field("tile_size"), plan_.tile_size, 1 + shared,
                    std::min(SamplesX().end, SamplesY().end));
    return false;
  }
  const bool columns_good =
      CheckOnAxis(columns, path.Field("x"), tiles.x(), path.Field("columns"),
                  tiles.columns(), &checks_);
  const bool rows_good =
      CheckOnAxis(rows, path.Field("y"), tiles.y(), path.Field("rows"),
                  tiles.rows(), &checks_);
  if (!columns_good || !rows_good) return false;
  plan_.tile_x = tiles.x();
  plan_.tile_y = tiles.y();
  plan_.columns = tiles.columns();
  plan_.rows = tiles.rows();
  plan_.whole = {tiles.x() * plan_.stride, tiles.y() * plan_.stride,
                 tiles.columns() * plan_.stride + shared,
                 tiles.rows() * plan_.stride + shared};
  return CheckTotals(path);
}

bool TilePlanner::PlanWholeDomain() {
  if (spec_ == nullptr) return false;  // nothing is known of its domain
  if (!extent_.has_value()) {
    if (!DomainOf(*spec_).has_value()) {
      violations_->Add(root_.Field("window").Text(),
                       "must be set, or tiles, when the terrain is endless");
    }
    return false;
  }
  if (std::max(extent_->width, extent_->height) > kMaxIndex) {
    violations_->Add(root_.Field("level").Text(),
                     "must leave at most 2^52 samples a side of the domain, "
                     "got " +
                         std::to_string(plan_.level));
    return false;
  }
  plan_.whole = {0, 0, extent_->width, extent_->height};
  CutWindow();
  return CheckTotals(root_.Field("window"));
}

bool TilePlanner::PlanExtent() {
  switch (request_.extent_case()) {
    case v1::StreamTilesRequest::kWindow:
      return PlanWindow(request_.window());
    case v1::StreamTilesRequest::kTiles:
      return PlanTileRange(request_.tiles());
    case v1::StreamTilesRequest::EXTENT_NOT_SET:
      return PlanWholeDomain();
  }
  return false;
}

bool TilePlanner::CheckTotals(const Path& path) const {
  // Samples sent: those of shared edges count in every tile that has them.
  const bool ranges = request_.has_tiles();
  std::int64_t columns = ranges ? 0 : plan_.whole.width;
  std::int64_t rows = ranges ? 0 : plan_.whole.height;
  std::int64_t samples = 0;
  const bool overflow =
      (ranges &&
       (__builtin_mul_overflow(plan_.columns, plan_.tile_size, &columns) ||
        __builtin_mul_overflow(plan_.rows, plan_.tile_size, &rows))) ||
      __builtin_mul_overflow(columns, rows, &samples);
  if (!overflow && samples <= limits_.max_stream_samples) return true;
  violations_->Add(path.Text(),
                   "must have at most " +
                       std::to_string(limits_.max_stream_samples) +
                       " samples, got " +
                       (overflow ? "more than 2^63" : std::to_string(samples)));
  return false;
}

TilePlan TilePlanner::Plan() {
  if (spec_ != nullptr && spec_->dimensions != 2) {
    violations_->Add(root_.Field("terrain").Text(),
                     "must have 2 dimensions, got 1");
  }
  plan_.first_tile = request_.first_tile();
  PlanSamples();
  const std::int64_t most_first_tile =
      PlanExtent() ? plan_.total() : std::numeric_limits<std::int64_t>::max();
  checks_.Integer(root_.Field("first_tile"), plan_.first_tile, 0,
                  most_first_tile);
  PlanEncoding(request_.encoding(),
               request_.has_range() ? &request_.range() : nullptr, root_,
               violations_, &plan_);
  return plan_;
}

}  // namespace

void PlanEncoding(v1::HeightEncoding encoding, const v1::HeightRange* range,
                  const core::Path& root, core::Violations* violations,
                  TilePlan* plan) {
  switch (encoding) {
    case v1::HEIGHT_ENCODING_UNSPECIFIED:
    case v1::HEIGHT_ENCODING_FLOAT32_LE:
      return;
    case v1::HEIGHT_ENCODING_UINT16_LE:
      plan->encoding = encoding;
      break;
    default:
      violations->Add(root.Field("encoding").Text(),
                      "must be a value that the API knows, got " +
                          std::to_string(encoding));
  }
  if (range == nullptr) return;
  const Path path = root.Field("range");
  const EncodingRange asked{range->minimum(), range->maximum()};
  FieldChecks checks(violations);
  constexpr core::Range kRangeEnds{-1e12, 1e12};
  const bool minimum_good =
      checks.Number(path.Field("minimum"), asked.minimum, kRangeEnds);
  const bool maximum_good =
      checks.Number(path.Field("maximum"), asked.maximum, kRangeEnds);
  if (minimum_good && maximum_good && asked.minimum >= asked.maximum) {
    violations->Add(path.Field("maximum").Text(),
                    "must be above minimum " + NumberText(asked.minimum) +
                        ", got " + NumberText(asked.maximum));
  }
  plan->range = asked;
}

core::Window TilePlan::TileWindow(std::int64_t column, std::int64_t row) const {
  const std::int64_t x = column * stride;
  const std::int64_t y = row * stride;
  return {whole.x + x, whole.y + y,
          std::min<std::int64_t>(tile_size, whole.width - x),
          std::min<std::int64_t>(tile_size, whole.height - y)};
}

TilePlan PlanTiles(const v1::StreamTilesRequest& request,
                   const core::TerrainSpec* spec, const Limits& limits,
                   const std::string& prefix, core::Violations* violations) {
  const Path root(&prefix);
  return TilePlanner(request, spec, limits, root, violations).Plan();
}

std::vector<TileKind> RemainingTiles(const TilePlan& plan) {
  std::vector<TileKind> kinds;
  // Tiles of `rows` rows from `row` on, from `column` on: all but the last
  // column have one size, and so have all but the last row.
  const auto add = [&](std::int64_t column, std::int64_t row,
                       std::int64_t rows) {
    if (rows <= 0) return;
    const std::int64_t inner = plan.columns - 1 - column;
    if (inner > 0) {
      kinds.push_back({plan.TileWindow(column, row), inner * rows});
    }
    kinds.push_back({plan.TileWindow(plan.columns - 1, row), rows});
  };
  std::int64_t row = plan.first_tile / plan.columns;
  const std::int64_t column = plan.first_tile % plan.columns;
  if (column > 0) add(column, row++, 1);
  add(0, row, plan.rows - 1 - row);
  if (row < plan.rows) add(0, plan.rows - 1, 1);
  return kinds;
}

core::TileRequest PlanProfile(const v1::GetProfileRequest& request,
                              const core::TerrainSpec* spec,
                              const Limits& limits, const std::string& prefix,
                              core::Violations* violations) {
  const Path root(&prefix);
  FieldChecks checks(violations);
  core::TileRequest plan;
  if (spec != nullptr && spec->dimensions != 1) {
    violations->Add(root.Field("terrain").Text(),
                    "must have 1 dimension, got 2");
  }
  plan.level = request.level();
  const bool level_good =
      checks.Integer(root.Field("level"), plan.level, 0, limits.max_level);
  plan.sampling = ReadEnum(kSamplings, request.sampling(),
                           root.Field("sampling"), violations);
  plan.window = {request.first(), 0, request.count(), 1};
  const Path count = root.Field("count");
  std::optional<std::int64_t> width;  // of the domain, where it is known
  if (level_good) {
    const auto extent = ExtentOf(spec, plan.level, plan.sampling);
    if (extent.has_value()) width = extent->width;
  }
  if (request.count() == 0) {
    if (width.has_value()) {
      plan.window = {0, 0, *width, 1};
    } else if (spec == nullptr || DomainOf(*spec).has_value()) {
      return plan;  // nothing is known of its domain, or of the level
    } else {
      violations->Add(count.Text(), "must be set when the terrain is endless");
      return plan;
    }
  }
  const bool count_good =
      checks.Integer(count, plan.window.width, 1, limits.max_profile_samples);
  CheckOnAxis(SampleAxis(width), root.Field("first"), plan.window.x, count,
              count_good ? plan.window.width : 1, &checks);
  return plan;
}

std::vector<core::Point2> PlanHeights(const v1::GetHeightsRequest& request,
                                      const core::TerrainSpec* spec,
                                      const Limits& limits,
                                      const std::string& prefix,
                                      core::Violations* violations) {
  const Path root(&prefix);
  if (spec != nullptr && spec->dimensions != 2) {
    violations->Add(root.Field("terrain").Text(),
                    "must have 2 dimensions, got 1");
  }
  core::SpecChecks checks(limits.recipe, 2, violations);
  checks.Integer(root.Field("level"), request.level(), 0, limits.max_level);
  std::vector<core::Point2> points;
  if (request.points_size() > limits.max_points) {
    violations->Add(root.Field("points").Text(),
                    "must have at most " + std::to_string(limits.max_points) +
                        " elements, got " +
                        std::to_string(request.points_size()));
    return points;
  }
  points.reserve(static_cast<std::size_t>(request.points_size()));
  for (const v1::Point& point : request.points()) {
    const core::Point2 place{point.x(), point.y()};
    checks.Coordinates(root.Element("points", points.size()), place);
    points.push_back(place);
  }
  return points;
}

core::Frame SampleFrame(const core::Frame& frame, int level,
                        core::Sampling sampling) {
  const double step_x = std::ldexp(frame.spacing_x, -level);
  const double step_y = std::ldexp(frame.spacing_y, -level);
  if (sampling == core::Sampling::kPoint) {
    return {frame.origin_x, frame.origin_y, step_x, step_y};
  }
  return {frame.origin_x + step_x / 2, frame.origin_y + step_y / 2, step_x,
          step_y};
}

}  // namespace terrane::server
