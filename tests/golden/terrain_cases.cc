#include "tests/golden/terrain_cases.h"

#include <limits>
#include <memory>
#include <sstream>
#include <utility>

namespace terrane::core {
namespace {

constexpr TileRequest kTile = {6, Sampling::kPoint, {-20, 10, 64, 48}};
constexpr TileRequest kArea = {6, Sampling::kArea, {-20, 10, 64, 48}};
constexpr TileRequest kLine = {9, Sampling::kPoint, {-100, 0, 400, 1}};
constexpr Domain kDomain = {3, 2};
constexpr TileRequest kWhole = {5, Sampling::kPoint, {0, 0, 97, 65}};

std::string Name(FractalSource source) {
  switch (source) {
    case FractalSource::kMidpoint:
      return "midpoint";
    case FractalSource::kSuccessive:
      return "successive";
    case FractalSource::kSubdivision:
      return "subdivision";
  }
  return "";
}

std::string Name(HeightMapping mapping) {
  return mapping == HeightMapping::kLinear ? "linear" : "boltzmann";
}

class CaseList {
 public:
  void Add(std::string name, TerrainSpec spec, const TileRequest& request) {
    // Every case a world of its own.
    spec.seed = 1'000'003 * static_cast<std::int64_t>(cases_.size()) - 7;
    cases_.push_back({std::move(name), std::move(spec), request});
  }
  std::vector<GoldenCase> Take() { return std::move(cases_); }

 private:
  std::vector<GoldenCase> cases_;
};

// Rolling ground; a lake without data in a corner if asked for.
std::shared_ptr<const Raster> MakeRaster(const Frame& frame, bool with_lake) {
  auto raster = std::make_shared<Raster>();
  raster->width = 17;
  raster->height = 15;
  raster->frame = frame;
  for (int j = 0; j < 15; ++j) {
    for (int i = 0; i < 17; ++i) {
      const bool in_lake = with_lake && i < 4 && j > 0 && j < 4;
      raster->values.push_back(
          in_lake ? std::numeric_limits<float>::quiet_NaN()
                  : static_cast<float>((5 * i * i + 7 * i * j + 3 * j) % 37));
    }
  }
  return raster;
}

void AddSources(CaseList* list) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSuccessive,
        FractalSource::kSubdivision}) {
    for (const HeightMapping mapping :
         {HeightMapping::kBoltzmann, HeightMapping::kLinear}) {
      TerrainSpec spec;
      spec.source = source;
      spec.mapping = mapping;
      spec.fidelity = 25;
      const std::string name = Name(source) + "_" + Name(mapping);
      list->Add(name, spec, kTile);
      spec.domain = kDomain;
      list->Add(name + "_bounded", spec, kWhole);
    }
    TerrainSpec spec;
    spec.source = source;
    list->Add(Name(source) + "_area", spec, kArea);
    spec.dimensions = 1;
    list->Add(Name(source) + "_line", spec, kLine);
    spec.domain = Domain{3, 0};
    list->Add(Name(source) + "_line_bounded", spec,
              {7, Sampling::kPoint, {0, 0, 385, 1}});
    list->Add(Name(source) + "_line_area", spec,
              {7, Sampling::kArea, {0, 0, 384, 1}});
  }
}

void AddScales(CaseList* list) {
  const TerrainSpec spec;
  for (const int level : {0, 1, 20, 30, 40}) {
    list->Add("level_" + std::to_string(level), spec,
              {level, Sampling::kPoint, {1000, -2000, 40, 30}});
  }
  constexpr std::int64_t kFar = std::int64_t{1} << 50;
  list->Add("far_away", spec, {30, Sampling::kPoint, {kFar, -kFar, 40, 30}});
  list->Add("several_blocks", spec, {12, Sampling::kPoint, {0, 0, 700, 300}});
  for (const double roughness : {0.05, 0.5, 0.95, 0.999}) {
    TerrainSpec rough;
    rough.roughness = roughness;
    std::ostringstream name;
    name << "roughness_" << roughness;
    list->Add(name.str(), rough, kTile);
  }
  TerrainSpec scaled;
  scaled.sigma = 3.7;
  scaled.delta = 0.2;
  scaled.mapping = HeightMapping::kBoltzmann;
  scaled.source = FractalSource::kMidpoint;
  list->Add("sigma_and_delta", scaled, kTile);
  TerrainSpec limited;
  limited.fidelity = 400;
  limited.soft_limit = 15;
  limited.frame = Frame{1000.5, -20, 1.0 / 3, -0.7};
  list->Add("soft_limit_and_frame", limited, kTile);
}

void AddShape(const std::string& name, decltype(MacroPart::shape) shape,
              CaseList* list) {
  TerrainSpec spec;
  spec.fidelity = 0.01;
  spec.macro.base = 2;
  spec.macro.parts.push_back({MacroCombine::kAdd, std::move(shape)});
  list->Add("macro_" + name, spec, kTile);
}

void AddMacroShapes(CaseList* list) {
  AddShape("plane", Plane{{0.1, 0.2}, 5, 0.5, -0.25}, list);
  AddShape("cone", Cone{{0.2, 0.4}, 0.3, 4}, list);
  AddShape("hill", GaussianHill{{0.2, 0.4}, 0.2, 0.1, 4}, list);
  AddShape("ridge", Ridge{{{-0.3, 0.2}, {0.2, 0.4}, {0.6, 0.8}}, 0.1, 3}, list);
  AddShape("boss", Boss{{{0, 0.2}, {0.4, 0.3}, {0.2, 0.7}}, 0.1, 6}, list);
  for (const SplineBasis basis :
       {SplineBasis::kBezier, SplineBasis::kBSplineUniform,
        SplineBasis::kBSplineClamped}) {
    AddShape("net_" + std::to_string(static_cast<int>(basis)),
             ControlNet{basis,
                        3,
                        4,
                        4,
                        {0, 1, 5, 2, 3, 9, 1, 0, 4, 4, 4, 2, 8, 0, 1, 3},
                        {-0.3, 0.2},
                        {0.6, 0.8}},
             list);
  }
  for (const Interpolation interpolation :
       {Interpolation::kBilinear, Interpolation::kCatmullRom,
        Interpolation::kBSpline}) {
    AddShape(
        "raster_" + std::to_string(static_cast<int>(interpolation)),
        RasterShape{MakeRaster({-0.3, 0.9, 0.06, -0.05}, true), interpolation},
        list);
  }
  AddShape("profile",
           Profile{{}, {1, 5, 2, 7, 3}, -0.3, 0.2, Interpolation::kCatmullRom},
           list);
  AddShape("polyline",
           Profile{{-0.3, 0, 0.5}, {1, 5, 2}, 0, 0, Interpolation::kBilinear},
           list);
  TerrainSpec spec;
  spec.macro.parts = {
      {MacroCombine::kAdd, Plane{{0, 0}, 1, 3, 0}},
      {MacroCombine::kMaximum, Cone{{0.2, 0.4}, 0.5, 4}},
      {MacroCombine::kMinimum, GaussianHill{{0.3, 0.4}, 0.3, 0.3, 2.5}}};
  list->Add("macro_combined", spec, kTile);
}

void AddContinuousConstraints(CaseList* list) {
  const std::vector<Point2> vertices = {
      {0.1, 0.3}, {0.5, 0.4}, {0.3, 0.7}, {0.2, 0.4}};
  for (const ConstraintQuantity quantity :
       {ConstraintQuantity::kRoughness, ConstraintQuantity::kFidelity}) {
    TerrainSpec all;
    for (const SourceKind kind :
         {SourceKind::kPoint, SourceKind::kPolyline, SourceKind::kPolygon}) {
      const bool point = kind == SourceKind::kPoint;
      ContinuousConstraint c = {
          quantity,
          0.4,
          30,
          0.3,
          DistanceNorm::kL1,
          ReachEdge::kStep,
          kind,
          point ? std::vector<Point2>{{0.2, 0.4}} : vertices};
      all.continuous_constraints.push_back(c);
      c.norm = DistanceNorm::kL2;
      c.edge = ReachEdge::kSmooth;
      TerrainSpec one;
      one.continuous_constraints.push_back(c);
      const std::string name =
          std::string(quantity == ConstraintQuantity::kRoughness ? "roughness"
                                                                 : "fidelity") +
          "_source_" + std::to_string(static_cast<int>(kind));
      list->Add(name, one, kTile);
    }
    list->Add(quantity == ConstraintQuantity::kRoughness
                  ? "roughness_sources_overlapping"
                  : "fidelity_sources_overlapping",
              all, kTile);
  }
}

void AddDiscreteConstraints(CaseList* list) {
  TerrainSpec spec;
  spec.source = FractalSource::kMidpoint;
  spec.mapping = HeightMapping::kBoltzmann;
  for (const int level : {0, 2, 3, 5, 7}) {
    spec.discrete_constraints.push_back({{0.3, 0.45}, level, {}});
  }
  spec.discrete_constraints.push_back({{0.1, 0.2}, {}, 0.1});
  list->Add("discrete", spec, kTile);
  list->Add("discrete_area", spec, kArea);
  spec.domain = kDomain;
  spec.discrete_constraints.push_back({{0, 0.4}, 4, {}});
  list->Add("discrete_bounded", spec, kWhole);
  spec.domain.reset();
  spec.dimensions = 1;
  list->Add("discrete_line", spec, kLine);
}

void AddRefinements(CaseList* list) {
  const Frame frame = {250000, 4000000, 90, -90};
  const TileRequest whole = {3, Sampling::kPoint, {0, 0, 129, 113}};
  TerrainSpec spec;
  spec.refinement = Refinement{};
  spec.macro.parts.push_back(
      {MacroCombine::kAdd,
       RasterShape{MakeRaster(frame, false), Interpolation::kCatmullRom}});
  list->Add("refinement", spec, whole);
  list->Add("refinement_area", spec, {3, Sampling::kArea, {0, 0, 128, 112}});
  TerrainSpec uniform = spec;
  uniform.refinement->uniform_amplitude = true;
  list->Add("refinement_uniform", uniform, whole);
  TerrainSpec chosen = spec;
  chosen.roughness = 0.6;
  chosen.fidelity = 30;
  chosen.continuous_constraints.push_back({ConstraintQuantity::kRoughness,
                                           0.9,
                                           0,
                                           400,
                                           DistanceNorm::kL2,
                                           ReachEdge::kSmooth,
                                           SourceKind::kPoint,
                                           {{250500, 3999500}}});
  list->Add("refinement_chosen", chosen, whole);
  TerrainSpec lake;
  lake.refinement = Refinement{};
  lake.macro.parts.push_back(
      {MacroCombine::kAdd,
       RasterShape{MakeRaster(frame, true), Interpolation::kBilinear}});
  list->Add("refinement_no_data", lake, whole);
}

void AddSpotHeights(CaseList* list) {
  TerrainSpec spec;
  spec.macro.base = 0.5;
  spec.spots.level = 6;
  spec.spots.points = {{{0.25, 0.5}, 1.75, 0},
                       {{0.265625, 0.5}, 1.5, 0},
                       {{-0.125, 0.75}, -0.5, 0},
                       {{0.40625, 0.296875}, 0.25, 0.2}};
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSuccessive,
        FractalSource::kSubdivision}) {
    spec.source = source;
    list->Add("spots_" + Name(source), spec, kTile);
    list->Add("spots_" + Name(source) + "_area", spec, kArea);
  }
  TerrainSpec line = spec;
  line.dimensions = 1;
  list->Add("spots_line", line, kLine);
  TerrainSpec boltzmann = spec;
  boltzmann.mapping = HeightMapping::kBoltzmann;
  boltzmann.domain = kDomain;
  boltzmann.spots.points[2].point = {2.984375, 0};
  list->Add("spots_boltzmann_bounded", boltzmann, kWhole);
  TerrainSpec river = spec;
  river.spots.lines = {
      {{{0.0, 0.25}, {0.3, 0.3}, {0.6, 0.8}}, {1, 0.5, -0.5}, 0, 0, true}};
  river.discrete_constraints = {{{0.1, 0.8}, 4, {}}};
  river.continuous_constraints.push_back({ConstraintQuantity::kRoughness,
                                          0.95,
                                          0,
                                          0.3,
                                          DistanceNorm::kL2,
                                          ReachEdge::kSmooth,
                                          SourceKind::kPoint,
                                          {{0.25, 0.5}}});
  list->Add("spots_river", river, kTile);
}

}  // namespace

std::string GoldenCase::Parameters() const {
  std::ostringstream text;
  text << spec.dimensions << "-D " << Name(spec.source) << " "
       << Name(spec.mapping) << " seed " << spec.seed;
  if (spec.roughness) text << " H " << *spec.roughness;
  if (spec.fidelity) text << " T " << *spec.fidelity;
  text << " level " << request.level
       << (request.sampling == Sampling::kPoint ? " POINT " : " AREA ")
       << request.window.width << "x" << request.window.height << " at "
       << request.window.x << "," << request.window.y;
  return text.str();
}

std::vector<GoldenCase> GoldenCases() {
  CaseList list;
  AddSources(&list);
  AddScales(&list);
  AddMacroShapes(&list);
  AddContinuousConstraints(&list);
  AddDiscreteConstraints(&list);
  AddRefinements(&list);
  AddSpotHeights(&list);
  return list.Take();
}

}  // namespace terrane::core
