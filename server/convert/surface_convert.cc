#include "server/convert/surface_convert.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/base/field_checks.h"
#include "core/surface/validate_surface.h"
#include "server/convert/axis_checks.h"
#include "server/convert/enum_table.h"

namespace terrane::server {
namespace {

using core::FieldChecks;
using core::Path;

// Every net that is not too large has at most so many points.
constexpr int kMaxPoints = core::Basis::kMaxCount * core::Basis::kMaxCount;
constexpr int kDefaultTileSize = 256;

// To itself: read for the check alone.
constexpr EnumTable<v1::SurfaceOutput, v1::SurfaceOutput, 2> kOutputs{{
    {v1::SURFACE_OUTPUT_MESH, v1::SURFACE_OUTPUT_MESH},
    {v1::SURFACE_OUTPUT_HEIGHTS, v1::SURFACE_OUTPUT_HEIGHTS},
}};

core::Point3 ReadVector(const v1::Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

core::PointNet ReadNet(const v1::SurfaceNet& net, const Path& path,
                       core::Violations* violations) {
  core::PointNet result;
  result.basis =
      ReadEnum(kSplineBases, net.basis(), path.Field("basis"), violations);
  result.degree = net.degree() == 0 ? 3 : net.degree();
  result.columns = net.columns();
  result.rows = net.rows();
  // More cannot belong to a net; the one more makes the core say so.
  const int points = std::min(net.points_size(), kMaxPoints + 1);
  result.points.reserve(static_cast<std::size_t>(points));
  for (int k = 0; k < points; ++k) {
    result.points.push_back(ReadVector(net.points(k)));
  }
  return result;
}

core::WeightRule ReadRule(const v1::WeightRule& rule) {
  core::WeightRule result;
  if (rule.has_i()) result.i = rule.i();
  if (rule.has_j()) result.j = rule.j();
  result.offset = rule.offset();
  result.slope_i = rule.slope_i();
  result.slope_j = rule.slope_j();
  result.random = rule.random();
  result.redraw = rule.redraw();
  return result;
}

core::Network ReadNetwork(const v1::SurfaceNetwork& network) {
  core::Network result;
  const int rules = std::min(network.weights_size(), core::kMaxWeightRules + 1);
  result.weights.reserve(static_cast<std::size_t>(rules));
  for (int k = 0; k < rules; ++k) {
    result.weights.push_back(ReadRule(network.weights(k)));
  }
  if (network.has_desired()) result.desired = network.desired();
  result.desired_random = network.desired_random();
  return result;
}

void WriteVector(const core::Point3& point, v1::Vector3* vector) {
  vector->set_x(point.x);
  vector->set_y(point.y);
  vector->set_z(point.z);
}

void WriteNetwork(const core::Network& network, v1::SurfaceNetwork* message) {
  for (const core::WeightRule& rule : network.weights) {
    v1::WeightRule* const written = message->add_weights();
    if (rule.i.has_value()) written->set_i(*rule.i);
    if (rule.j.has_value()) written->set_j(*rule.j);
    written->set_offset(rule.offset);
    written->set_slope_i(rule.slope_i);
    written->set_slope_j(rule.slope_j);
    written->set_random(rule.random);
    written->set_redraw(rule.redraw);
  }
  message->set_desired(network.desired);
  message->set_desired_random(network.desired_random);
}

// One StreamSurface request being checked.
class SurfacePlanner {
 public:
  SurfacePlanner(const v1::StreamSurfaceRequest& request,
                 const core::SurfaceSpec* spec, const Limits& limits,
                 const Path& root, core::Violations* violations)
      : request_(request),
        spec_(spec),
        limits_(limits),
        root_(root),
        violations_(violations),
        checks_(violations) {}

  SurfacePlan Plan(const std::string& recipe_prefix) {
    plan_.uvs = request_.uvs();
    plan_.share_edges = request_.share_edges();
    const bool grid_good = PlanGrid();
    const bool size_good = PlanTileSize();
    PlanOutput(recipe_prefix);
    const bool window_good = PlanWindow(grid_good) && CutWindow();
    plan_.tiles.first_tile = request_.first_tile();
    checks_.Integer(root_.Field("first_tile"), plan_.tiles.first_tile, 0,
                    size_good && window_good
                        ? plan_.tiles.total()
                        : std::numeric_limits<std::int64_t>::max());
    return plan_;
  }

 private:
  bool PlanGrid() {
    plan_.grid = {request_.columns(), request_.rows()};
    const bool columns_good = checks_.Integer(
        root_.Field("columns"), plan_.grid.columns, 2, core::kMaxGridSide);
    const bool rows_good = checks_.Integer(root_.Field("rows"), plan_.grid.rows,
                                           2, core::kMaxGridSide);
    // What is not on the largest grid is on none.
    if (!columns_good) plan_.grid.columns = core::kMaxGridSide;
    if (!rows_good) plan_.grid.rows = core::kMaxGridSide;
    return columns_good && rows_good;
  }

  bool PlanTileSize() {
    TilePlan& tiles = plan_.tiles;
    tiles.tile_size =
        request_.tile_size() == 0 ? kDefaultTileSize : request_.tile_size();
    const int least = plan_.share_edges ? 2 : 1;
    const bool good = checks_.Integer(root_.Field("tile_size"), tiles.tile_size,
                                      least, limits_.max_tile_size);
    // The largest tiles share the fewest samples.
    if (!good) tiles.tile_size = std::max(least, limits_.max_tile_size);
    tiles.stride = tiles.tile_size - (plan_.share_edges ? 1 : 0);
    return good;
  }

  void PlanOutput(const std::string& recipe_prefix) {
    plan_.heights = ReadEnum(kOutputs, request_.output(), root_.Field("output"),
                             violations_) == v1::SURFACE_OUTPUT_HEIGHTS;
    PlanEncoding(request_.encoding(),
                 request_.has_range() ? &request_.range() : nullptr, root_,
                 violations_, &plan_.tiles);
    if (!plan_.heights) return;
    if (plan_.tiles.encoding == v1::HEIGHT_ENCODING_UINT16_LE &&
        !request_.has_range()) {
      violations_->Add(root_.Field("range").Text(),
                       "must be set with UINT16_LE: a surface has no range "
                       "before it is generated");
    }
    if (spec_ != nullptr) {
      core::ValidateHeightField(*spec_, recipe_prefix, violations_);
    }
  }

  bool PlanWindow(bool grid_good) {
    core::Window& whole = plan_.tiles.whole;
    if (!request_.has_window()) {
      whole = {0, 0, plan_.grid.columns, plan_.grid.rows};
      return grid_good;
    }
    const v1::Window& window = request_.window();
    whole = {window.x(), window.y(), window.width(), window.height()};
    const Path path = root_.Field("window");
    const bool columns_good =
        CheckOnAxis({0, plan_.grid.columns}, path.Field("x"), whole.x,
                    path.Field("width"), whole.width, &checks_);
    const bool rows_good =
        CheckOnAxis({0, plan_.grid.rows}, path.Field("y"), whole.y,
                    path.Field("height"), whole.height, &checks_);
    return columns_good && rows_good;
  }

  // Tiles that cover `count` samples, the last of which has one at least that
  // the tile before does not.
  static std::int64_t TilesAcross(std::int64_t count, const TilePlan& tiles) {
    const std::int64_t shared = tiles.tile_size - tiles.stride;
    return std::max<std::int64_t>(
        1, (count - shared + tiles.stride - 1) / tiles.stride);
  }

  // Whether the tiles are not too many.
  bool CutWindow() {
    TilePlan& tiles = plan_.tiles;
    tiles.columns = TilesAcross(tiles.whole.width, tiles);
    tiles.rows = TilesAcross(tiles.whole.height, tiles);
    // Sides are at most 2^20, tiles at least one sample wide: no overflow.
    // Edges that are shared count in every tile that has them.
    const std::int64_t samples =
        (tiles.whole.width +
         (tiles.columns - 1) * (tiles.tile_size - tiles.stride)) *
        (tiles.whole.height +
         (tiles.rows - 1) * (tiles.tile_size - tiles.stride));
    if (samples <= limits_.max_stream_samples) return true;
    violations_->Add(root_.Field("window").Text(),
                     "must have at most " +
                         std::to_string(limits_.max_stream_samples) +
                         " samples, got " + std::to_string(samples));
    return false;
  }

  const v1::StreamSurfaceRequest& request_;
  const core::SurfaceSpec* const spec_;
  const Limits& limits_;
  const Path& root_;
  core::Violations* const violations_;
  FieldChecks checks_;
  SurfacePlan plan_;
};

}  // namespace

core::SurfaceSpec ReadSurfaceRecipe(const v1::SurfaceRecipe& recipe,
                                    const std::string& prefix,
                                    core::Violations* violations) {
  const Path root(&prefix);
  core::SurfaceSpec spec;
  spec.seed = recipe.seed();
  spec.net = ReadNet(recipe.net(), root.Field("net"), violations);
  spec.method = ReadEnum(kSurfaceMethods, recipe.method(), root.Field("method"),
                         violations);
  spec.network = ReadNetwork(recipe.network());
  if (core::HasNetworkU(spec.method)) {
    spec.network_u = ReadNetwork(recipe.network_u());
  }
  if (recipe.has_training()) {
    spec.training = core::Training{recipe.training().learning_rate(),
                                   recipe.training().iterations()};
  }
  spec.carry_over = recipe.carry_over();
  if (recipe.has_direction()) spec.direction = ReadVector(recipe.direction());
  if (recipe.has_hole_level()) spec.hole_level = recipe.hole_level();
  core::ValidateSurface(spec, prefix, violations);
  return spec;
}

v1::SurfaceRecipe WriteSurfaceRecipe(const core::SurfaceSpec& spec) {
  v1::SurfaceRecipe recipe;
  recipe.set_seed(spec.seed);
  v1::SurfaceNet* const net = recipe.mutable_net();
  net->set_basis(WriteEnum(kSplineBases, spec.net.basis));
  if (core::HasDegree(spec.net.basis)) net->set_degree(spec.net.degree);
  net->set_columns(spec.net.columns);
  net->set_rows(spec.net.rows);
  for (const core::Point3& point : spec.net.points) {
    WriteVector(point, net->add_points());
  }
  recipe.set_method(WriteEnum(kSurfaceMethods, spec.method));
  WriteNetwork(spec.network, recipe.mutable_network());
  if (core::HasNetworkU(spec.method)) {
    WriteNetwork(spec.network_u, recipe.mutable_network_u());
  }
  if (spec.training.has_value()) {
    recipe.mutable_training()->set_learning_rate(spec.training->learning_rate);
    recipe.mutable_training()->set_iterations(spec.training->iterations);
  }
  recipe.set_carry_over(spec.carry_over);
  WriteVector(spec.direction, recipe.mutable_direction());
  if (spec.hole_level.has_value()) recipe.set_hole_level(*spec.hole_level);
  return recipe;
}

SurfacePlan PlanSurface(const v1::StreamSurfaceRequest& request,
                        const core::SurfaceSpec* spec, const Limits& limits,
                        const std::string& prefix,
                        const std::string& recipe_prefix,
                        core::Violations* violations) {
  const Path root(&prefix);
  return SurfacePlanner(request, spec, limits, root, violations)
      .Plan(recipe_prefix);
}

}  // namespace terrane::server
