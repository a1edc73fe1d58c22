#include "tests/property/random_terrain.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

namespace terrane::core {
namespace {

// Where the window lies in the world, and how far it reaches.
struct Neighbourhood {
  Point2 centre;
  double radius = 0;
};

// Beyond this many units from the origin a recipe takes no coordinates.
constexpr double kFarthest = 1e14;
constexpr double kLargestFalloff = 1e12;

class CaseMaker {
 public:
  CaseMaker(std::uint64_t seed, std::int64_t largest)
      : draw_(seed), largest_(largest) {}

  RandomCase Make() {
    PickBasics();
    PickRequest();
    FindNeighbourhood();
    // Too far out for constraints: the lattice alone.
    if (std::fabs(near_.centre.x) > kFarthest ||
        std::fabs(near_.centre.y) > kFarthest) {
      return std::move(case_);
    }
    if (!case_.spec.refinement && !draw_.OneIn(4)) PickMacro();
    if (draw_.OneIn(2)) PickContinuousConstraints();
    if (draw_.OneIn(2) && !case_.spec.refinement) PickDiscreteConstraints();
    if (draw_.OneIn(2)) PickSpots();
    return std::move(case_);
  }

 private:
  bool plane() const { return case_.spec.dimensions == 2; }

  void PickBasics() {
    TerrainSpec& spec = case_.spec;
    spec.dimensions = draw_.OneIn(6) ? 1 : 2;
    spec.seed = draw_.Integer(std::numeric_limits<std::int64_t>::min(),
                              std::numeric_limits<std::int64_t>::max());
    spec.roughness = draw_.Real(0.05, 0.99);
    spec.fidelity = draw_.Of(0.0, 0.3, 2500.0);
    spec.frame = draw_.Of(Frame(), Frame{-1000.1, 77.7, 1.0 / 3, 1.0 / 3},
                          Frame{250000, 4000000, 30, -30},
                          Frame{-84.4, 36.7, 1e-3, -1.1e-3});
    if (plane() && draw_.OneIn(5)) {
      PickRefinement();
      return;
    }
    spec.source = draw_.Of(FractalSource::kMidpoint, FractalSource::kSuccessive,
                           FractalSource::kSubdivision);
    spec.mapping = draw_.Of(HeightMapping::kBoltzmann, HeightMapping::kLinear);
    if (draw_.OneIn(3)) spec.soft_limit = 1.5;
    if (draw_.OneIn(2)) {
      spec.domain = Domain{draw_.Integer(1, 6), draw_.Integer(1, 6)};
    }
  }

  void PickRefinement() {
    TerrainSpec& spec = case_.spec;
    const std::int64_t width = draw_.Integer(13, 24);
    const std::int64_t height = draw_.Integer(13, 24);
    spec.refinement = Refinement{draw_.OneIn(2)};
    spec.domain = Domain{width - 1, height - 1};
    spec.macro.parts.push_back(
        {MacroCombine::kAdd,
         RasterShape{
             MakeRaster(width, height, *spec.frame, draw_.OneIn(2)),
             draw_.Of(Interpolation::kBilinear, Interpolation::kCatmullRom)}});
  }

  void PickRequest() {
    TileRequest& request = case_.request;
    request.level = static_cast<int>(draw_.OneIn(4) ? draw_.Integer(0, 3)
                                                    : draw_.Integer(0, 30));
    request.sampling = draw_.OneIn(3) ? Sampling::kArea : Sampling::kPoint;
    const Domain domain = case_.spec.domain.value_or(Domain());
    std::tie(request.window.x, request.window.width) = PickSpan(domain.cells_x);
    if (plane()) {
      std::tie(request.window.y, request.window.height) =
          PickSpan(domain.cells_y);
    } else {
      request.window.height = 1;
    }
  }

  // First sample and count along an axis; `cells` 0: endless.
  std::pair<std::int64_t, std::int64_t> PickSpan(std::int64_t cells) {
    const int level = case_.request.level;
    std::int64_t count = draw_.Integer(3, largest_);
    if (cells == 0) {
      const std::int64_t around = draw_.Of(
          std::int64_t{0}, std::int64_t{1} << 20, -(std::int64_t{1} << 35),
          std::int64_t{1} << 50, -(std::int64_t{1} << 50));
      return {around + draw_.Integer(-100, 100), count};
    }
    const std::int64_t end =
        (cells << level) + (case_.request.sampling == Sampling::kPoint ? 1 : 0);
    count = std::min(count, end);
    // At one of the borders, or anywhere.
    return {
        draw_.Of(std::int64_t{0}, end - count, draw_.Integer(0, end - count)),
        count};
  }

  void FindNeighbourhood() {
    const Frame& frame = *case_.spec.frame;
    const Window& window = case_.request.window;
    const int level = case_.request.level;
    const auto middle = [&](std::int64_t first, std::int64_t count) {
      return std::ldexp(static_cast<double>(first + count / 2), -level);
    };
    near_.centre = {
        frame.origin_x + middle(window.x, window.width) * frame.spacing_x,
        frame.origin_y + middle(window.y, window.height) * frame.spacing_y};
    near_.radius =
        std::ldexp(static_cast<double>(std::max(window.width, window.height)) *
                       std::fabs(frame.spacing_x) / 2,
                   -level);
  }

  // A length in the world, from a tenth of the window's to a hundred times it.
  double Length() {
    const double scale = draw_.Of(0.1, 0.6, 3.0, 100.0);
    return near_.radius * scale * draw_.Real(0.5, 1.5);
  }

  // A point in or about the window.
  Point2 Place() {
    return {near_.centre.x + near_.radius * draw_.Real(-1.3, 1.3),
            near_.centre.y + near_.radius * draw_.Real(-1.3, 1.3)};
  }

  std::vector<Point2> Places(std::int64_t count) {
    std::vector<Point2> places;
    for (std::int64_t k = 0; k < count; ++k) places.push_back(Place());
    return places;
  }

  void PickMacro() {
    MacroSpec& macro = case_.spec.macro;
    macro.base = draw_.Of(0.0, -17.25, 812.5);
    const std::int64_t count = draw_.Integer(0, 3);
    for (std::int64_t k = 0; k < count; ++k) {
      MacroPart part;
      part.combine = draw_.Of(MacroCombine::kAdd, MacroCombine::kMaximum,
                              MacroCombine::kMinimum);
      PickShape(&part);
      macro.parts.push_back(std::move(part));
    }
  }

  void PickShape(MacroPart* part) {
    const double height = draw_.Real(-50, 50);
    switch (draw_.Integer(0, plane() ? 7 : 5)) {
      case 0:
        part->shape = Plane{Place(), height, draw_.Real(-1, 1), 0.3};
        return;
      case 1:
        part->shape = Cone{Place(), Length(), height};
        return;
      case 2:
        part->shape = GaussianHill{Place(), Length(), Length(), height};
        return;
      case 3:
        part->shape = Ridge{Places(plane() ? 4 : 2), Length(), height};
        return;
      case 4:
        part->shape = Boss{Places(plane() ? 5 : 3), Length(), height};
        return;
      case 5:
        part->shape = MakeProfile();
        return;
      case 6:
        part->shape = MakeNet();
        return;
      default:
        part->shape = MakePlacedRaster();
    }
  }

  Profile MakeProfile() {
    Profile profile;
    profile.first_x = near_.centre.x - near_.radius;
    profile.step_x = near_.radius / 3;
    profile.interpolation =
        draw_.Of(Interpolation::kBilinear, Interpolation::kCatmullRom);
    for (int k = 0; k < 7; ++k) profile.heights.push_back(draw_.Real(-9, 9));
    return profile;
  }

  ControlNet MakeNet() {
    ControlNet net;
    net.basis = draw_.Of(SplineBasis::kBezier, SplineBasis::kBSplineUniform,
                         SplineBasis::kBSplineClamped);
    net.columns = 5;
    net.rows = 4;
    for (int k = 0; k < 20; ++k) net.heights.push_back(draw_.Real(-9, 9));
    net.minimum = {near_.centre.x - near_.radius,
                   near_.centre.y + near_.radius};
    net.maximum = {near_.centre.x + near_.radius,
                   near_.centre.y - near_.radius};
    return net;
  }

  RasterShape MakePlacedRaster() {
    const double spacing = near_.radius / draw_.Real(4, 12);
    const Frame frame = {near_.centre.x - near_.radius,
                         near_.centre.y + near_.radius, spacing, -spacing};
    return {MakeRaster(14, 11, frame, draw_.OneIn(2)),
            draw_.Of(Interpolation::kBilinear, Interpolation::kCatmullRom,
                     Interpolation::kBSpline)};
  }

  void PickContinuousConstraints() {
    const std::int64_t count = draw_.Integer(1, 8);
    for (std::int64_t k = 0; k < count; ++k) {
      ContinuousConstraint c;
      const bool roughness = draw_.OneIn(2);
      c.quantity = roughness ? ConstraintQuantity::kRoughness
                             : ConstraintQuantity::kFidelity;
      c.target = roughness ? draw_.Real(0.1, 0.99) : draw_.Real(0, 5);
      c.reach = Length();
      c.falloff = std::min(draw_.Of(0.0, 1.0, 20.0) / (c.reach * c.reach),
                           kLargestFalloff);
      c.norm = draw_.Of(DistanceNorm::kL1, DistanceNorm::kL2);
      c.edge = draw_.Of(ReachEdge::kStep, ReachEdge::kSmooth);
      c.kind = draw_.Of(SourceKind::kPoint, SourceKind::kPolyline,
                        plane() ? SourceKind::kPolygon : SourceKind::kPoint);
      c.vertices = Places(c.kind == SourceKind::kPoint     ? 1
                          : c.kind == SourceKind::kPolygon ? 5
                          : plane()                        ? 4
                                                           : 2);
      case_.spec.continuous_constraints.push_back(std::move(c));
    }
  }

  void PickDiscreteConstraints() {
    const std::int64_t count = draw_.Integer(1, 12);
    for (std::int64_t k = 0; k < count; ++k) {
      DiscreteConstraint c;
      c.point = InsideDomain(Place());
      c.level = static_cast<int>(std::max(
          std::int64_t{0}, case_.request.level - draw_.Integer(-1, 6)));
      case_.spec.discrete_constraints.push_back(c);
    }
    if (draw_.OneIn(3)) case_.spec.discrete_method = DiscreteMethod::kCondition;
  }

  // Up to 20 heights on lattice points around the window, each near enough to
  // the macro shape for every mapping to reach it.
  void PickSpots() {
    TerrainSpec& spec = case_.spec;
    constexpr double kFarthestSpot = 1e9;
    bool faithful = spec.fidelity == 0;
    for (const ContinuousConstraint& c : spec.continuous_constraints) {
      faithful |= c.quantity == ConstraintQuantity::kFidelity;
    }
    if (faithful || std::fabs(near_.centre.x) > kFarthestSpot ||
        std::fabs(near_.centre.y) > kFarthestSpot) {
      return;
    }
    TerrainSpec bare = spec;
    bare.discrete_constraints.clear();
    const auto macro = *Terrain::Create(bare);
    const Frame& frame = *macro->spec().frame;
    // No larger than what the smoothest ground makes over such a distance: a
    // hundred metres between neighbours of level 30 are rightly refused.
    const double cells = near_.radius / std::fabs(frame.spacing_x);
    const double deviation = std::min(1.0, std::sqrt(*macro->spec().fidelity)) *
                             std::min(1.0, std::pow(cells, 0.99));
    spec.spots.level = static_cast<int>(std::clamp<std::int64_t>(
        case_.request.level + draw_.Integer(-3, 1), 1, 30));
    for (DiscreteConstraint& c : spec.discrete_constraints) {
      c.level = std::min(*c.level, *spec.spots.level - 1);  // never on a spot
    }
    std::set<std::pair<std::int64_t, std::int64_t>> taken;
    TileScratch scratch;
    for (std::int64_t k = draw_.Integer(1, 20); k > 0; --k) {
      const Point2 place = InsideDomain(Place());
      const auto index = [&](double at, double origin, double spacing) {
        // Odd: not a post of a refined model, nor a point of another level.
        return static_cast<std::int64_t>(std::floor(
                   std::ldexp((at - origin) / spacing, *spec.spots.level) /
                   2)) *
                   2 +
               1;
      };
      const std::int64_t x = index(place.x, frame.origin_x, frame.spacing_x);
      const std::int64_t y =
          plane() ? index(place.y, frame.origin_y, frame.spacing_y) : 0;
      const TileRequest request = {
          *spec.spots.level, Sampling::kPoint, {x, y, 1, 1}};
      float height = 0;
      // Farther out, world coordinates in double cannot name a lattice point.
      constexpr std::int64_t kLargestIndex = std::int64_t{1} << 40;
      if (std::abs(x) > kLargestIndex || std::abs(y) > kLargestIndex ||
          !macro->CheckRequest(request).ok() || !taken.insert({x, y}).second ||
          !macro->GenerateMacro(request, &scratch, {&height, 1}).ok() ||
          std::isnan(height)) {
        continue;
      }
      SpotHeight spot;
      spot.point = {frame.origin_x +
                        std::ldexp(static_cast<double>(x), -*spec.spots.level) *
                            frame.spacing_x,
                    frame.origin_y +
                        std::ldexp(static_cast<double>(y), -*spec.spots.level) *
                            frame.spacing_y};
      spot.height = static_cast<double>(height) + deviation * draw_.Real(-1, 1);
      if (draw_.OneIn(4)) spot.standard_error = deviation / 10;
      spec.spots.points.push_back(spot);
    }
  }

  Point2 InsideDomain(Point2 point) const {
    if (!case_.spec.domain) return point;
    const Frame& frame = *case_.spec.frame;
    const auto clamped = [](double value, double origin, double spacing,
                            std::int64_t cells) {
      const double end = origin + static_cast<double>(cells) * spacing;
      return std::clamp(value, std::min(origin, end), std::max(origin, end));
    };
    return {clamped(point.x, frame.origin_x, frame.spacing_x,
                    case_.spec.domain->cells_x),
            clamped(point.y, frame.origin_y, frame.spacing_y,
                    case_.spec.domain->cells_y)};
  }

  Draw draw_;
  std::int64_t largest_;
  RandomCase case_;
  Neighbourhood near_;
};

}  // namespace

std::int64_t Draw::Integer(std::int64_t low, std::int64_t high) {
  // The slight bias of the modulus does no harm here. Span 0: all 64 bits.
  const std::uint64_t span =
      static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
  const std::uint64_t bits = engine_();
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) +
                                   (span == 0 ? bits : bits % span));
}

double Draw::Real(double low, double high) {
  return low +
         (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
}

std::shared_ptr<const Raster> MakeRaster(std::int64_t width,
                                         std::int64_t height,
                                         const Frame& frame, bool with_lake) {
  auto raster = std::make_shared<Raster>();
  raster->width = width;
  raster->height = height;
  raster->frame = frame;
  for (std::int64_t j = 0; j < height; ++j) {
    for (std::int64_t i = 0; i < width; ++i) {
      const bool in_lake = with_lake && i >= 1 && i <= 4 && j >= 1 && j <= 3;
      const std::int64_t rolling = (7 * i * i + 3 * i * j + 11 * j * j) % 41;
      const std::int64_t step = 2 * i + 3 * j > width + height ? 60 : 0;
      raster->values.push_back(in_lake ? std::numeric_limits<float>::quiet_NaN()
                                       : static_cast<float>(rolling + step) +
                                             0.25f);
    }
  }
  return raster;
}

std::string RandomCase::Text() const {
  std::ostringstream text;
  text << spec.dimensions << "-D source " << static_cast<int>(spec.source)
       << " mapping " << static_cast<int>(spec.mapping) << " seed " << spec.seed
       << (spec.domain ? " bounded" : " endless")
       << (spec.refinement ? " refinement" : "") << " parts "
       << spec.macro.parts.size() << " discrete "
       << spec.discrete_constraints.size() << " spots "
       << spec.spots.points.size() << " continuous "
       << spec.continuous_constraints.size() << ", level " << request.level
       << (request.sampling == Sampling::kPoint ? " POINT " : " AREA ")
       << request.window.width << " x " << request.window.height << " at ("
       << request.window.x << ", " << request.window.y << ")";
  return text.str();
}

RandomCase MakeRandomCase(std::uint64_t seed, std::int64_t largest) {
  return CaseMaker(seed, largest).Make();
}

}  // namespace terrane::core
