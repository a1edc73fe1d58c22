#include "core/terrain/spot_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <variant>

#include "core/base/violations.h"
#include "core/grid/z_curve.h"
#include "core/noise/counter_hash.h"
#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

constexpr int kFallbackLevel = 12;

// Off a lattice point by less than this share of the spacing is on it: what
// coordinates lose as decimal text.
constexpr double kOnLattice = 1e-6;

double IndexOf(double position, double origin, double spacing, int level) {
  return std::ldexp((position - origin) / spacing, level);
}

bool OnLattice(const Point2& point, const Frame& frame, int level,
               int dimensions) {
  const auto near = [](double index) {
    return std::fabs(index - std::nearbyint(index)) <= kOnLattice;
  };
  return near(IndexOf(point.x, frame.origin_x, frame.spacing_x, level)) &&
         (dimensions == 1 ||
          near(IndexOf(point.y, frame.origin_y, frame.spacing_y, level)));
}

double Distance(const Point2& a, const Point2& b, int dimensions) {
  const double dx = b.x - a.x;
  const double dy = dimensions == 1 ? 0 : b.y - a.y;
  return std::sqrt(dx * dx + dy * dy);
}

double SampleSpacing(const SpotLine& line, const Frame& frame, int level,
                     int dimensions) {
  if (line.spacing > 0) return line.spacing;
  const double x = std::fabs(frame.spacing_x);
  const double y = dimensions == 1 ? x : std::fabs(frame.spacing_y);
  return std::ldexp(std::min(x, y), -level);
}

// Equal steps that a segment is cut into, as a double: it may be huge.
double StepsOf(const Point2& a, const Point2& b, double spacing,
               int dimensions) {
  return std::max(1.0, std::ceil(Distance(a, b, dimensions) / spacing));
}

struct PointHash {
  std::size_t operator()(
      const std::pair<int, std::pair<std::int64_t, std::int64_t>>& key) const {
    const auto& [level, point] = key;
    return Mix64(Mix64(static_cast<std::uint64_t>(point.first) +
                       static_cast<std::uint64_t>(level)) ^
                 static_cast<std::uint64_t>(point.second));
  }
};

// Sorts spots along a Z curve: neighbours share ancestors, and what they share
// is in the cache when they follow each other.
void SortAlongCurve(std::vector<Spot>* spots) {
  double u0 = 0, v0 = 0, side = 0;
  for (std::size_t k = 0; k < spots->size(); ++k) {
    const Spot& spot = (*spots)[k];
    u0 = k == 0 ? spot.u : std::min(u0, spot.u);
    v0 = k == 0 ? spot.v : std::min(v0, spot.v);
  }
  for (const Spot& spot : *spots) {
    side = std::max({side, spot.u - u0, spot.v - v0});
  }
  const double scale = side > 0 ? 4294967295.0 / side : 0;
  const auto code = [&](const Spot& spot) {
    return ZCurveCode(static_cast<std::uint32_t>((spot.u - u0) * scale),
                      static_cast<std::uint32_t>((spot.v - v0) * scale));
  };
  std::stable_sort(
      spots->begin(), spots->end(),
      [&](const Spot& a, const Spot& b) { return code(a) < code(b); });
}

// Collects spots one after the other.
class SpotCollector {
 public:
  SpotCollector(const TerrainSpec& spec, const MacroShape& macro,
                const ConstraintField& fidelity, const HeightMap& map)
      : spec_(spec),
        frame_(*spec.frame),
        plane_(spec.dimensions == 2),
        macro_(macro),
        fidelity_(fidelity),
        map_(map) {}

  void AddRow(SpotRow row, const SpotHeight& spot);
  void AddDiscrete(std::size_t index, const DiscreteConstraint& constraint);
  void AddLine(std::size_t index, const SpotLine& line);
  absl::StatusOr<SnappedSpots> Finish();

 private:
  // A place snapped to the lattice.
  struct Snapped {
    Spot spot;
    double moved = 0;
  };
  // A sample of a line: where, and its height when the line has heights.
  struct LineSample {
    Point2 place;
    double height = 0;
  };

  std::optional<Snapped> Snap(SpotRow row, const Point2& place, int level);
  // True: a new lattice point. False: merged, or refused with a violation.
  bool Add(const Snapped& snapped);
  void Merge(const Spot& later, Spot* kept);
  double MacroAt(const Spot& spot) const;
  double FidelityAt(const Spot& spot) const;
  SampleGrid GridAt(const Spot& spot) const;
  std::vector<LineSample> SamplesOf(const SpotLine& line) const;
  void CheckFall(std::size_t index, const std::vector<std::size_t>& course);
  void FillFractal(Spot* spot);

  const TerrainSpec& spec_;
  const Frame& frame_;
  const bool plane_;
  const MacroShape& macro_;
  const ConstraintField& fidelity_;
  const HeightMap& map_;
  Violations violations_;
  SnappedSpots result_;
  std::unordered_map<std::pair<int, std::pair<std::int64_t, std::int64_t>>,
                     std::size_t, PointHash>
      by_point_;
};

// --- Snapping ---------------------------------------------------------------

std::optional<SpotCollector::Snapped> SpotCollector::Snap(SpotRow row,
                                                          const Point2& place,
                                                          int level) {
  const double x = std::nearbyint(
      IndexOf(place.x, frame_.origin_x, frame_.spacing_x, level));
  const double y = plane_ ? std::nearbyint(IndexOf(place.y, frame_.origin_y,
                                                   frame_.spacing_y, level))
                          : 0;
  const auto limit = static_cast<double>(kMaxIndex);
  if (!(std::fabs(x) <= limit && std::fabs(y) <= limit)) {
    violations_.Add(row.Path(),
                    "must lie within 2^52 lattice steps of index 0 at level " +
                        std::to_string(level));
    return std::nullopt;
  }
  Snapped snapped;
  Spot& spot = snapped.spot;
  spot.row = row;
  spot.level = level;
  spot.point = {static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)};
  if (spec_.domain) {
    const auto inside = [&](std::int64_t index, std::int64_t cells) {
      return index >= 0 && index <= cells << level;
    };
    if (!inside(spot.point.x, spec_.domain->cells_x) ||
        (plane_ && !inside(spot.point.y, spec_.domain->cells_y))) {
      violations_.Add(row.Path(), "must lie inside the domain, got (" +
                                      NumberText(place.x) + ", " +
                                      NumberText(place.y) + ")");
      return std::nullopt;
    }
  }
  spot.u = std::ldexp(x, -level);
  spot.v = std::ldexp(y, -level);
  const Point2 there = {frame_.origin_x + spot.u * frame_.spacing_x,
                        frame_.origin_y + spot.v * frame_.spacing_y};
  snapped.moved = Distance(place, there, spec_.dimensions);
  while (spot.level > 0 && (spot.point.x & 1) == 0 && (spot.point.y & 1) == 0) {
    spot.point = {spot.point.x / 2, spot.point.y / 2};
    --spot.level;
  }
  return snapped;
}

bool SpotCollector::Add(const Snapped& snapped) {
  const Spot& spot = snapped.spot;
  const auto [place, fresh] = by_point_.try_emplace(
      {spot.level, {spot.point.x, spot.point.y}}, result_.spots.size());
  if (!fresh) {
    Merge(spot, &result_.spots[place->second]);
    return false;
  }
  SpotReport& report = result_.report;
  report.largest_move = std::max(report.largest_move, snapped.moved);
  result_.spots.push_back(spot);
  return true;
}

void SpotCollector::Merge(const Spot& later, Spot* kept) {
  if (later.row.kind == SpotRow::Kind::kLine) return;
  ++result_.report.merged;
  const bool exact = later.standard_error == 0;
  if (kept->standard_error == 0 && exact) {
    const bool both_on_macro = later.row.kind == SpotRow::Kind::kDiscrete &&
                               kept->row.kind == SpotRow::Kind::kDiscrete;
    if (both_on_macro ||
        static_cast<float>(later.height) == static_cast<float>(kept->height)) {
      return;
    }
    violations_.Add(later.row.Path(),
                    "must have the height of " + kept->row.Path() +
                        ", which is at the same point of level " +
                        std::to_string(spec_.spots.level.value_or(0)) + ": " +
                        NumberText(kept->height) + ", got " +
                        NumberText(later.height) +
                        " (a finer spots.level tells near points apart)");
  } else if (exact) {
    *kept = later;
  } else if (kept->standard_error != 0) {
    const double a = 1 / (kept->standard_error * kept->standard_error);
    const double b = 1 / (later.standard_error * later.standard_error);
    kept->height = (a * kept->height + b * later.height) / (a + b);
    kept->standard_error = 1 / std::sqrt(a + b);
  }
}

// --- Rows -------------------------------------------------------------------

void SpotCollector::AddRow(SpotRow row, const SpotHeight& spot) {
  std::optional<Snapped> snapped = Snap(row, spot.point, *spec_.spots.level);
  if (!snapped) return;
  snapped->spot.height = spot.height;
  snapped->spot.standard_error = spot.standard_error;
  Add(*snapped);
}

void SpotCollector::AddDiscrete(std::size_t index,
                                const DiscreteConstraint& constraint) {
  const SpotRow row = {SpotRow::Kind::kDiscrete, index};
  const absl::StatusOr<int> level =
      DiscreteLevel(constraint, index, frame_, spec_.dimensions);
  if (!level.ok()) {
    for (const Violation& v : ViolationsOf(level.status())) {
      violations_.Add(v.field, v.description);
    }
    return;
  }
  std::optional<Snapped> snapped = Snap(row, constraint.point, *level);
  if (!snapped) return;
  snapped->moved = 0;  // what it says is a neighbourhood, not a survey
  snapped->spot.height = MacroAt(snapped->spot);
  Add(*snapped);
}

std::vector<SpotCollector::LineSample> SpotCollector::SamplesOf(
    const SpotLine& line) const {
  const double spacing =
      SampleSpacing(line, frame_, *spec_.spots.level, spec_.dimensions);
  std::vector<LineSample> samples;
  const auto height = [&](std::size_t k) {
    return line.heights.empty() ? 0.0 : line.heights[k];
  };
  for (std::size_t k = 0; k + 1 < line.vertices.size(); ++k) {
    const Point2& a = line.vertices[k];
    const Point2& b = line.vertices[k + 1];
    const auto steps =
        static_cast<int>(StepsOf(a, b, spacing, spec_.dimensions));
    for (int s = 0; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      samples.push_back({{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)},
                         height(k) + t * (height(k + 1) - height(k))});
    }
  }
  samples.push_back({line.vertices.back(), height(line.vertices.size() - 1)});
  return samples;
}

void SpotCollector::AddLine(std::size_t index, const SpotLine& line) {
  const SpotRow row = {SpotRow::Kind::kLine, index};
  double lowest = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> course;  // its spots, from the first vertex on
  for (const LineSample& sample : SamplesOf(line)) {
    std::optional<Snapped> snapped =
        Snap(row, sample.place, *spec_.spots.level);
    if (!snapped) return;
    Spot& spot = snapped->spot;
    spot.height = line.heights.empty() ? MacroAt(spot) : sample.height;
    if (line.only_falls) lowest = spot.height = std::min(lowest, spot.height);
    spot.standard_error = line.standard_error;
    Add(*snapped);
    course.push_back(by_point_.at({spot.level, {spot.point.x, spot.point.y}}));
  }
  if (line.only_falls) CheckFall(index, course);
}

// Spots of others on its course could make a river climb.
void SpotCollector::CheckFall(std::size_t index,
                              const std::vector<std::size_t>& course) {
  for (std::size_t k = 1; k < course.size(); ++k) {
    const Spot& above = result_.spots[course[k - 1]];
    const Spot& below = result_.spots[course[k]];
    if (below.height <= above.height) continue;
    violations_.Add(
        SpotRow{SpotRow::Kind::kLine, index}.Path(),
        "must only fall, but would rise from " + NumberText(above.height) +
            " to " + NumberText(below.height) + " where it meets " +
            (below.row.kind == SpotRow::Kind::kLine && below.row.index == index
                 ? above.row.Path()
                 : below.row.Path()));
    return;
  }
}

// --- Values of P_fbm --------------------------------------------------------

SampleGrid SpotCollector::GridAt(const Spot& spot) const {
  SampleGrid grid;
  FillSampleGrid(frame_, spot.level, spot.point.x, spot.point.y, 1, 1, 1,
                 &grid);
  return grid;
}

double SpotCollector::MacroAt(const Spot& spot) const {
  float height = 0;
  macro_.Evaluate(GridAt(spot), &height, 1);
  return static_cast<double>(height);
}

double SpotCollector::FidelityAt(const Spot& spot) const {
  float fidelity = 0;
  if (!fidelity_.Evaluate(GridAt(spot), &fidelity, 1)) {
    fidelity = fidelity_.background();
  }
  return static_cast<double>(fidelity);
}

void SpotCollector::FillFractal(Spot* spot) {
  const double macro = MacroAt(*spot);
  const double fidelity = FidelityAt(*spot);
  const double deviation = spot->height - macro;
  result_.largest_deviation =
      std::max(result_.largest_deviation, std::fabs(deviation));
  if (spot->row.kind == SpotRow::Kind::kDiscrete) {
    // P = 0, whatever d is; and where d is no data, so is D.
    spot->fractal = 0;
  } else if (std::isnan(macro)) {
    violations_.Add(spot->row.Path(),
                    "must lie where the macro shape has data");
  } else if (fidelity == 0 && spot->standard_error == 0 &&
             static_cast<float>(spot->height) != static_cast<float>(macro)) {
    violations_.Add(
        spot->row.Path(),
        "must have the height of the macro shape, " + NumberText(macro) +
            ", where the fidelity T is 0; got " + NumberText(spot->height));
  } else if (fidelity > 0) {
    const double most = LargestDeviation(map_, fidelity);
    if (!(std::fabs(deviation) < most)) {
      violations_.Add(spot->row.Path(),
                      "must have a height in (" + NumberText(macro - most) +
                          ", " + NumberText(macro + most) +
                          "), what the mapping reaches there; got " +
                          NumberText(spot->height));
      return;
    }
    const FractalValue fractal = FractalOfDeviation(map_, fidelity, deviation);
    spot->fractal = fractal.value;
    const double error = spot->standard_error * fractal.slope;
    spot->nugget = error * error;
  }
}

absl::StatusOr<SnappedSpots> SpotCollector::Finish() {
  for (Spot& spot : result_.spots) FillFractal(&spot);
  if (!violations_.empty()) return violations_.ToStatus();
  // Where T = 0 every height is d, whatever P is: nothing to condition.
  std::erase_if(result_.spots,
                [&](const Spot& spot) { return FidelityAt(spot) == 0; });
  SortAlongCurve(&result_.spots);
  result_.report.spots = static_cast<std::int64_t>(result_.spots.size());
  result_.report.level = spec_.spots.level.value_or(0);
  return std::move(result_);
}

}  // namespace

std::string SpotRow::Path() const {
  const char* list = "";
  switch (kind) {
    case Kind::kPoint:
      list = "spots.points[";
      break;
    case Kind::kTable:
      list = "spots.table[";
      break;
    case Kind::kDiscrete:
      list = "discrete_constraints[";
      break;
    case Kind::kLine:
      list = "spots.lines[";
      break;
  }
  std::string path = list;
  path += std::to_string(index);
  path += ']';
  return path;
}

bool ConditionsDiscrete(const TerrainSpec& spec) {
  if (spec.discrete_constraints.empty()) return false;
  if (spec.discrete_method) {
    return *spec.discrete_method == DiscreteMethod::kCondition;
  }
  return spec.source != FractalSource::kMidpoint || !spec.spots.empty();
}

const Raster* RefinedRaster(const TerrainSpec& spec) {
  if (!spec.refinement || spec.macro.parts.size() != 1) return nullptr;
  const auto* shape = std::get_if<RasterShape>(&spec.macro.parts.front().shape);
  return shape == nullptr ? nullptr : shape->raster.get();
}

Frame FrameOf(const TerrainSpec& spec) {
  const Raster* const raster = RefinedRaster(spec);
  return raster != nullptr ? raster->frame : spec.frame.value_or(Frame{});
}

int DefaultSpotLevel(const SpotHeights& spots, const Frame& frame,
                     int dimensions) {
  int level = 0;
  const auto hold = [&](const Point2& point) {
    while (level < kFallbackLevel &&
           !OnLattice(point, frame, level, dimensions)) {
      ++level;
    }
  };
  for (const SpotHeight& spot : spots.points) hold(spot.point);
  if (spots.table != nullptr) {
    for (const SpotHeight& spot : *spots.table) hold(spot.point);
  }
  for (const SpotLine& line : spots.lines) {
    for (const Point2& vertex : line.vertices) hold(vertex);
  }
  return level;
}

std::size_t CountLineSamples(const SpotHeights& spots, const Frame& frame,
                             int level, int dimensions, std::size_t most) {
  double count = 0;
  for (const SpotLine& line : spots.lines) {
    const double spacing = SampleSpacing(line, frame, level, dimensions);
    for (std::size_t k = 0; k + 1 < line.vertices.size(); ++k) {
      count +=
          StepsOf(line.vertices[k], line.vertices[k + 1], spacing, dimensions);
    }
    count += 1;
    if (count > static_cast<double>(most)) return most + 1;
  }
  return static_cast<std::size_t>(count);
}

absl::StatusOr<SnappedSpots> SnapSpots(const TerrainSpec& spec,
                                       const MacroShape& macro,
                                       const ConstraintField& fidelity,
                                       const HeightMap& map) {
  SpotCollector collector(spec, macro, fidelity, map);
  const auto add_rows = [&](SpotRow::Kind kind,
                            std::span<const SpotHeight> rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      collector.AddRow({kind, k}, rows[k]);
    }
  };
  add_rows(SpotRow::Kind::kPoint, spec.spots.points);
  if (spec.spots.table != nullptr) {
    add_rows(SpotRow::Kind::kTable, *spec.spots.table);
  }
  if (ConditionsDiscrete(spec)) {
    for (std::size_t k = 0; k < spec.discrete_constraints.size(); ++k) {
      collector.AddDiscrete(k, spec.discrete_constraints[k]);
    }
  }
  for (std::size_t k = 0; k < spec.spots.lines.size(); ++k) {
    collector.AddLine(k, spec.spots.lines[k]);
  }
  return collector.Finish();
}

}  // namespace terrane::core
