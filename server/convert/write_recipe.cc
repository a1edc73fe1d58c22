// The writing half of terrain_convert.h.
#include <string>
#include <variant>

#include "server/convert/enum_table.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

void WritePoint(const core::Point2& point, v1::Point* message) {
  message->set_x(point.x);
  message->set_y(point.y);
}

template <typename Vertices>
void WritePoints(const std::vector<core::Point2>& points, Vertices* vertices) {
  for (const core::Point2& point : points) WritePoint(point, vertices->Add());
}

// Writes the shape of one part, whichever it is.
class PartWriter {
 public:
  PartWriter(const ReadRecipe& read, v1::MacroPart* part)
      : read_(read), part_(part) {}

  void operator()(const std::monostate&) const {}

  void operator()(const core::Plane& plane) const {
    v1::Plane* message = part_->mutable_plane();
    WritePoint(plane.point, message->mutable_point());
    message->set_height(plane.height);
    message->set_slope_x(plane.slope_x);
    message->set_slope_y(plane.slope_y);
  }

  void operator()(const core::Cone& cone) const {
    v1::Cone* message = part_->mutable_cone();
    WritePoint(cone.centre, message->mutable_centre());
    message->set_radius(cone.radius);
    message->set_height(cone.height);
  }

  void operator()(const core::GaussianHill& hill) const {
    v1::GaussianHill* message = part_->mutable_gaussian_hill();
    WritePoint(hill.centre, message->mutable_centre());
    message->set_sigma_x(hill.sigma_x);
    message->set_sigma_y(hill.sigma_y);
    message->set_height(hill.height);
  }

  void operator()(const core::Ridge& ridge) const {
    v1::Ridge* message = part_->mutable_ridge();
    WritePoints(ridge.crest, message->mutable_crest()->mutable_vertices());
    message->set_half_width(ridge.half_width);
    message->set_height(ridge.height);
  }

  void operator()(const core::Boss& boss) const {
    v1::Boss* message = part_->mutable_boss();
    WritePoints(boss.outline, message->mutable_outline()->mutable_vertices());
    message->set_flank_width(boss.flank_width);
    message->set_height(boss.height);
  }

  void operator()(const core::ControlNet& net) const {
    v1::ControlNet* message = part_->mutable_control_net();
    message->set_basis(WriteEnum(kSplineBases, net.basis));
    message->set_degree(net.degree);
    message->set_columns(net.columns);
    message->set_rows(net.rows);
    message->mutable_heights()->Add(net.heights.begin(), net.heights.end());
    WritePoint(net.minimum, message->mutable_minimum());
    WritePoint(net.maximum, message->mutable_maximum());
  }

  void operator()(const core::RasterShape& shape) const {
    v1::RasterShape* message = part_->mutable_raster();
    message->set_raster_id(read_.raster_ids.at(shape.raster.get()));
    message->set_interpolation(
        WriteEnum(kRasterInterpolations, shape.interpolation));
  }

  void operator()(const core::Profile& profile) const {
    v1::Profile* message = part_->mutable_profile();
    message->mutable_x()->Add(profile.x.begin(), profile.x.end());
    message->mutable_heights()->Add(profile.heights.begin(),
                                    profile.heights.end());
    message->set_first_x(profile.first_x);
    message->set_step_x(profile.step_x);
    message->set_interpolation(
        WriteEnum(kProfileInterpolations, profile.interpolation));
  }

 private:
  const ReadRecipe& read_;
  v1::MacroPart* const part_;
};

void WriteMacro(const core::MacroSpec& macro, const ReadRecipe& read,
                v1::MacroShape* message) {
  message->set_base(macro.base);
  for (const core::MacroPart& part : macro.parts) {
    v1::MacroPart* part_message = message->add_parts();
    part_message->set_combine(WriteEnum(kMacroCombines, part.combine));
    std::visit(PartWriter(read, part_message), part.shape);
  }
}

void WriteDiscrete(const core::DiscreteConstraint& constraint,
                   v1::DiscreteConstraint* message) {
  message->set_x(constraint.point.x);
  message->set_y(constraint.point.y);
  if (constraint.level) message->set_level(*constraint.level);
  if (constraint.radius) message->set_radius(*constraint.radius);
}

void WriteContinuous(const core::ContinuousConstraint& constraint,
                     v1::ContinuousConstraint* message) {
  message->set_quantity(WriteEnum(kConstraintQuantities, constraint.quantity));
  message->set_target(constraint.target);
  message->set_falloff(constraint.falloff);
  message->set_reach(constraint.reach);
  message->set_norm(WriteEnum(kDistanceNorms, constraint.norm));
  message->set_edge(WriteEnum(kReachEdges, constraint.edge));
  switch (constraint.kind) {
    case core::SourceKind::kPoint:
      WritePoint(constraint.vertices.front(), message->mutable_point());
      break;
    case core::SourceKind::kPolyline:
      WritePoints(constraint.vertices,
                  message->mutable_polyline()->mutable_vertices());
      break;
    case core::SourceKind::kPolygon:
      WritePoints(constraint.vertices,
                  message->mutable_polygon()->mutable_vertices());
      break;
  }
}

void WriteSpotLine(const core::SpotLine& line, v1::SpotLine* message) {
  WritePoints(line.vertices, message->mutable_vertices());
  message->mutable_heights()->Add(line.heights.begin(), line.heights.end());
  message->set_spacing(line.spacing);
  message->set_standard_error(line.standard_error);
  message->set_only_falls(line.only_falls);
}

void WriteSpots(const core::SpotHeights& spots, const std::string& table_id,
                v1::SpotHeights* message) {
  for (const core::SpotHeight& spot : spots.points) {
    v1::SpotHeight* point = message->add_points();
    point->set_x(spot.point.x);
    point->set_y(spot.point.y);
    point->set_height(spot.height);
    point->set_standard_error(spot.standard_error);
  }
  message->set_table_id(table_id);
  for (const core::SpotLine& line : spots.lines) {
    WriteSpotLine(line, message->add_lines());
  }
  if (spots.level) message->set_level(*spots.level);
}

}  // namespace

void WriteFrame(const core::Frame& frame, const std::string& crs,
                v1::Frame* message) {
  message->set_origin_x(frame.origin_x);
  message->set_origin_y(frame.origin_y);
  message->set_spacing_x(frame.spacing_x);
  message->set_spacing_y(frame.spacing_y);
  message->set_crs(crs);
}

v1::TerrainRecipe WriteTerrainRecipe(const core::TerrainSpec& resolved,
                                     const ReadRecipe& read) {
  v1::TerrainRecipe recipe;
  recipe.set_dimensions(resolved.dimensions);
  recipe.set_seed(resolved.seed);
  recipe.set_source(WriteEnum(kFractalSources, resolved.source));
  recipe.set_mapping(WriteEnum(kHeightMappings, resolved.mapping));
  if (resolved.roughness) recipe.set_roughness(*resolved.roughness);
  if (resolved.fidelity) recipe.set_fidelity(*resolved.fidelity);
  if (resolved.sigma) recipe.set_sigma(*resolved.sigma);
  if (resolved.delta) recipe.set_delta(*resolved.delta);
  if (resolved.soft_limit) recipe.set_soft_limit(*resolved.soft_limit);
  if (resolved.domain) {
    recipe.mutable_domain()->set_cells_x(resolved.domain->cells_x);
    recipe.mutable_domain()->set_cells_y(resolved.domain->cells_y);
  }
  if (resolved.frame) {
    WriteFrame(*resolved.frame, read.crs, recipe.mutable_frame());
  }
  WriteMacro(resolved.macro, read, recipe.mutable_macro());
  if (resolved.refinement) {
    recipe.mutable_refinement()->set_uniform_amplitude(
        resolved.refinement->uniform_amplitude);
  }
  for (const core::DiscreteConstraint& one : resolved.discrete_constraints) {
    WriteDiscrete(one, recipe.add_discrete_constraints());
  }
  for (const core::ContinuousConstraint& one :
       resolved.continuous_constraints) {
    WriteContinuous(one, recipe.add_continuous_constraints());
  }
  if (resolved.discrete_method) {
    recipe.set_discrete_method(
        WriteEnum(kDiscreteMethods, *resolved.discrete_method));
  }
  if (!resolved.spots.empty()) {
    WriteSpots(resolved.spots, read.spot_table_id, recipe.mutable_spots());
  }
  return recipe;
}

v1::SpotReport WriteSpotReport(const core::SpotReport& report) {
  v1::SpotReport message;
  message.set_spots(report.spots);
  message.set_level(report.level);
  message.set_largest_move(report.largest_move);
  message.set_merged(report.merged);
  return message;
}

}  // namespace terrane::server
