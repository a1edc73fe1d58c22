// The reading half of terrain_convert.h.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/convert/enum_table.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

using core::Path;

core::Point2 ReadPoint(const v1::Point& point) {
  return {point.x(), point.y()};
}

template <typename Points>
std::vector<core::Point2> ReadPoints(const Points& points) {
  std::vector<core::Point2> result;
  result.reserve(static_cast<std::size_t>(points.size()));
  for (const v1::Point& point : points) result.push_back(ReadPoint(point));
  return result;
}

template <typename Numbers>
std::vector<double> ReadNumbers(const Numbers& numbers) {
  return {numbers.begin(), numbers.end()};
}

// One recipe being read.
class RecipeReader {
 public:
  RecipeReader(const ContentSources& sources, const core::SpecLimits& limits,
               core::Violations* violations)
      : sources_(sources), limits_(limits), violations_(violations) {}

  void Read(const v1::TerrainRecipe& recipe, const Path& root);
  // core::ValidateSpec of what was read.
  void Validate(const std::string& prefix);
  ReadRecipe Take() { return std::move(read_); }

 private:
  // False, with a violation, when there are more elements than the limit:
  // they would take far more memory than their message did.
  template <typename Repeated>
  bool FewEnough(const Repeated& repeated, int limit, const Path& path);

  void ReadMacro(const v1::MacroShape& macro, const Path& path);
  core::MacroPart ReadPart(const v1::MacroPart& part, const Path& path);
  core::ControlNet ReadNet(const v1::ControlNet& net, const Path& path);
  core::RasterShape ReadRaster(const v1::RasterShape& shape, const Path& path);
  core::Profile ReadProfile(const v1::Profile& profile, const Path& path);
  core::ContinuousConstraint ReadContinuous(
      const v1::ContinuousConstraint& constraint, const Path& path);
  void ReadConstraints(const v1::TerrainRecipe& recipe, const Path& root);
  void ReadSpots(const v1::SpotHeights& spots, const Path& path);

  template <typename Proto, typename Core, std::size_t kSize>
  Core Enum(const EnumTable<Proto, Core, kSize>& table, Proto value,
            const Path& path) {
    return ReadEnum(table, value, path, violations_);
  }

  const ContentSources sources_;
  const core::SpecLimits& limits_;
  core::Violations* const violations_;
  std::string raster_crs_;
  // The fields of the rasters that are not kept.
  std::set<std::string> missing_rasters_;
  ReadRecipe read_;
};

template <typename Repeated>
bool RecipeReader::FewEnough(const Repeated& repeated, int limit,
                             const Path& path) {
  if (repeated.size() <= limit) return true;
  violations_->Add(path.Text(), "must have at most " + std::to_string(limit) +
                                    " elements, got " +
                                    std::to_string(repeated.size()));
  return false;
}

core::ControlNet RecipeReader::ReadNet(const v1::ControlNet& net,
                                       const Path& path) {
  return {.basis = Enum(kSplineBases, net.basis(), path.Field("basis")),
          .degree = net.degree() == 0 ? 3 : net.degree(),
          .columns = net.columns(),
          .rows = net.rows(),
          .heights = ReadNumbers(net.heights()),
          .minimum = ReadPoint(net.minimum()),
          .maximum = ReadPoint(net.maximum())};
}

core::RasterShape RecipeReader::ReadRaster(const v1::RasterShape& shape,
                                           const Path& path) {
  PlacedRaster placed;
  if (!shape.raster_id().empty()) {
    placed = sources_.rasters->Find(shape.raster_id());
    if (placed.raster != nullptr) {
      read_.raster_ids[placed.raster.get()] = shape.raster_id();
      raster_crs_ = placed.crs;
    } else {
      missing_rasters_.insert(path.Field("raster_id").Text());
      if (read_.missing_raster.empty()) {
        read_.missing_raster = shape.raster_id();
      }
    }
  }
  return {.raster = std::move(placed.raster),
          .interpolation = Enum(kRasterInterpolations, shape.interpolation(),
                                path.Field("interpolation"))};
}

core::Profile RecipeReader::ReadProfile(const v1::Profile& profile,
                                        const Path& path) {
  return {.x = ReadNumbers(profile.x()),
          .heights = ReadNumbers(profile.heights()),
          .first_x = profile.first_x(),
          .step_x = profile.step_x(),
          .interpolation = Enum(kProfileInterpolations, profile.interpolation(),
                                path.Field("interpolation"))};
}

core::MacroPart RecipeReader::ReadPart(const v1::MacroPart& part,
                                       const Path& path) {
  core::MacroPart result;
  result.combine = Enum(kMacroCombines, part.combine(), path.Field("combine"));
  switch (part.shape_case()) {
    case v1::MacroPart::kPlane:
      result.shape =
          core::Plane{ReadPoint(part.plane().point()), part.plane().height(),
                      part.plane().slope_x(), part.plane().slope_y()};
      break;
    case v1::MacroPart::kCone:
      result.shape = core::Cone{ReadPoint(part.cone().centre()),
                                part.cone().radius(), part.cone().height()};
      break;
    case v1::MacroPart::kGaussianHill: {
      const v1::GaussianHill& hill = part.gaussian_hill();
      result.shape = core::GaussianHill{
          ReadPoint(hill.centre()), hill.sigma_x(),
          hill.sigma_y() == 0 ? hill.sigma_x() : hill.sigma_y(), hill.height()};
      break;
    }
    case v1::MacroPart::kRidge:
      result.shape =
          core::Ridge{ReadPoints(part.ridge().crest().vertices()),
                      part.ridge().half_width(), part.ridge().height()};
      break;
    case v1::MacroPart::kBoss:
      result.shape =
          core::Boss{ReadPoints(part.boss().outline().vertices()),
                     part.boss().flank_width(), part.boss().height()};
      break;
    case v1::MacroPart::kControlNet:
      result.shape = ReadNet(part.control_net(), path.Field("control_net"));
      break;
    case v1::MacroPart::kRaster:
      result.shape = ReadRaster(part.raster(), path.Field("raster"));
      break;
    case v1::MacroPart::kProfile:
      result.shape = ReadProfile(part.profile(), path.Field("profile"));
      break;
    case v1::MacroPart::SHAPE_NOT_SET:
      break;  // stays monostate, which core::ValidateSpec reports
  }
  return result;
}

void RecipeReader::ReadMacro(const v1::MacroShape& macro, const Path& path) {
  read_.spec.macro.base = macro.base();
  if (!FewEnough(macro.parts(), limits_.max_macro_parts, path.Field("parts"))) {
    return;
  }
  for (int i = 0; i < macro.parts_size(); ++i) {
    read_.spec.macro.parts.push_back(ReadPart(
        macro.parts(i), path.Element("parts", static_cast<std::size_t>(i))));
  }
}

core::ContinuousConstraint RecipeReader::ReadContinuous(
    const v1::ContinuousConstraint& constraint, const Path& path) {
  core::ContinuousConstraint result;
  const Path quantity = path.Field("quantity");
  if (constraint.quantity() == v1::CONSTRAINT_QUANTITY_UNSPECIFIED) {
    violations_->Add(quantity.Text(),
                     "must be ROUGHNESS or FIDELITY, got none");
  }
  result.quantity =
      Enum(kConstraintQuantities, constraint.quantity(), quantity);
  result.target = constraint.target();
  result.falloff = constraint.falloff();
  result.reach = constraint.reach();
  result.norm = Enum(kDistanceNorms, constraint.norm(), path.Field("norm"));
  result.edge = Enum(kReachEdges, constraint.edge(), path.Field("edge"));
  switch (constraint.source_case()) {
    case v1::ContinuousConstraint::kPoint:
      result.vertices = {ReadPoint(constraint.point())};
      break;
    case v1::ContinuousConstraint::kPolyline:
      result.kind = core::SourceKind::kPolyline;
      result.vertices = ReadPoints(constraint.polyline().vertices());
      break;
    case v1::ContinuousConstraint::kPolygon:
      result.kind = core::SourceKind::kPolygon;
      result.vertices = ReadPoints(constraint.polygon().vertices());
      break;
    case v1::ContinuousConstraint::SOURCE_NOT_SET:
      break;  // a point without vertices, which core::ValidateSpec reports
  }
  return result;
}

template <typename Optional>
std::optional<double> OptionalNumber(bool has, Optional value) {
  return has ? std::optional<double>(value) : std::nullopt;
}

core::DiscreteConstraint ReadDiscrete(const v1::DiscreteConstraint& message) {
  core::DiscreteConstraint result;
  result.point = {message.x(), message.y()};
  if (message.has_level()) result.level = message.level();
  result.radius = OptionalNumber(message.has_radius(), message.radius());
  return result;
}

void RecipeReader::ReadConstraints(const v1::TerrainRecipe& recipe,
                                   const Path& root) {
  if (FewEnough(recipe.discrete_constraints(), limits_.max_discrete_constraints,
                root.Field("discrete_constraints"))) {
    for (const v1::DiscreteConstraint& one : recipe.discrete_constraints()) {
      read_.spec.discrete_constraints.push_back(ReadDiscrete(one));
    }
  }
  if (recipe.discrete_method() != v1::DISCRETE_METHOD_UNSPECIFIED) {
    read_.spec.discrete_method =
        Enum(kDiscreteMethods, recipe.discrete_method(),
             root.Field("discrete_method"));
  }
  if (FewEnough(recipe.continuous_constraints(),
                limits_.max_continuous_constraints,
                root.Field("continuous_constraints"))) {
    for (int i = 0; i < recipe.continuous_constraints_size(); ++i) {
      read_.spec.continuous_constraints.push_back(ReadContinuous(
          recipe.continuous_constraints(i),
          root.Element("continuous_constraints", static_cast<std::size_t>(i))));
    }
  }
}

core::SpotLine ReadSpotLine(const v1::SpotLine& line) {
  return {.vertices = ReadPoints(line.vertices()),
          .heights = ReadNumbers(line.heights()),
          .spacing = line.spacing(),
          .standard_error = line.standard_error(),
          .only_falls = line.only_falls()};
}

void RecipeReader::ReadSpots(const v1::SpotHeights& spots, const Path& path) {
  core::SpotHeights& result = read_.spec.spots;
  if (spots.has_level()) result.level = spots.level();
  if (FewEnough(spots.points(), limits_.max_inline_spots,
                path.Field("points"))) {
    result.points.reserve(static_cast<std::size_t>(spots.points_size()));
    for (const v1::SpotHeight& one : spots.points()) {
      result.points.push_back(
          {{one.x(), one.y()}, one.height(), one.standard_error()});
    }
  }
  if (FewEnough(spots.lines(), limits_.max_inline_spots, path.Field("lines"))) {
    for (const v1::SpotLine& line : spots.lines()) {
      result.lines.push_back(ReadSpotLine(line));
    }
  }
  if (spots.table_id().empty()) return;
  result.table = sources_.spot_tables->FindTable(spots.table_id());
  (result.table != nullptr ? read_.spot_table_id : read_.missing_spot_table) =
      spots.table_id();
}

void RecipeReader::Read(const v1::TerrainRecipe& recipe, const Path& root) {
  core::TerrainSpec& spec = read_.spec;
  spec.dimensions = recipe.dimensions() == 0 ? 2 : recipe.dimensions();
  spec.seed = recipe.seed();
  spec.source = Enum(kFractalSources, recipe.source(), root.Field("source"));
  spec.mapping = Enum(kHeightMappings, recipe.mapping(), root.Field("mapping"));
  spec.roughness = OptionalNumber(recipe.has_roughness(), recipe.roughness());
  spec.fidelity = OptionalNumber(recipe.has_fidelity(), recipe.fidelity());
  spec.sigma = OptionalNumber(recipe.has_sigma(), recipe.sigma());
  spec.delta = OptionalNumber(recipe.has_delta(), recipe.delta());
  spec.soft_limit =
      OptionalNumber(recipe.has_soft_limit(), recipe.soft_limit());
  if (recipe.has_domain()) {
    spec.domain = {recipe.domain().cells_x(), recipe.domain().cells_y()};
  }
  if (recipe.has_frame()) {
    spec.frame = ReadFrame(recipe.frame(), root.Field("frame"), violations_);
  }
  ReadMacro(recipe.macro(), root.Field("macro"));
  if (recipe.has_refinement()) {
    spec.refinement = {recipe.refinement().uniform_amplitude()};
  }
  ReadConstraints(recipe, root);
  ReadSpots(recipe.spots(), root.Field("spots"));
  read_.crs = recipe.has_frame() ? recipe.frame().crs()
              : spec.refinement  ? raster_crs_
                                 : "";
}

void RecipeReader::Validate(const std::string& prefix) {
  if (missing_rasters_.empty()) {
    core::ValidateSpec(read_.spec, limits_, prefix, violations_);
    return;
  }
  core::Violations found;
  core::ValidateSpec(read_.spec, limits_, prefix, &found);
  for (const core::Violation& one : found.kept()) {
    if (missing_rasters_.contains(one.field)) continue;
    violations_->Add(one.field, one.description);
  }
}

}  // namespace

core::Frame ReadFrame(const v1::Frame& frame, const core::Path& path,
                      core::Violations* violations) {
  if (frame.crs().size() > kMaxCrsBytes) {
    violations->Add(path.Field("crs").Text(),
                    "must have at most " + std::to_string(kMaxCrsBytes) +
                        " bytes, got " + std::to_string(frame.crs().size()));
  }
  return {.origin_x = frame.origin_x(),
          .origin_y = frame.origin_y(),
          .spacing_x = frame.spacing_x() == 0 ? 1.0 : frame.spacing_x(),
          .spacing_y = frame.spacing_y() == 0 ? 1.0 : frame.spacing_y()};
}

ReadRecipe ReadTerrainRecipe(const v1::TerrainRecipe& recipe,
                             const ContentSources& sources,
                             const core::SpecLimits& limits,
                             const std::string& prefix,
                             core::Violations* violations) {
  const Path root(&prefix);
  RecipeReader reader(sources, limits, violations);
  reader.Read(recipe, root);
  reader.Validate(prefix);
  return reader.Take();
}

}  // namespace terrane::server
