#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "core/terrain/spec_checks.h"
#include "core/terrain/spot_heights.h"

namespace terrane::core {
namespace {

constexpr Range kStandardErrors{0, 1e9};
constexpr Range kSampleSpacings{0, 1e12};

void ValidateRows(const Path& spots, const char* name,
                  std::span<const SpotHeight> rows, const TerrainSpec& spec,
                  SpecChecks* checks) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Path path = spots.Element(name, i);
    ValidatePlace(path, rows[i].point, spec, checks);
    checks->Number(path.Field("height"), rows[i].height, kHeights);
    checks->Number(path.Field("standard_error"), rows[i].standard_error,
                   kStandardErrors);
  }
}

// False: the line's samples cannot be counted.
bool ValidateLine(const Path& path, const SpotLine& line,
                  const TerrainSpec& spec, SpecChecks* checks) {
  const Path vertices = path.Field("vertices");
  const auto most = static_cast<std::size_t>(checks->limits().max_vertices);
  bool valid = checks->Count(vertices, line.vertices.size(), 2, most);
  const bool few = checks->SpendVertices(vertices, line.vertices.size());
  for (std::size_t k = 0; few && k < line.vertices.size(); ++k) {
    valid &= ValidatePlace(path.Element("vertices", k), line.vertices[k], spec,
                           checks);
  }
  valid &= few;
  valid &= checks->Number(path.Field("spacing"), line.spacing, kSampleSpacings);
  checks->Number(path.Field("standard_error"), line.standard_error,
                 kStandardErrors);
  if (line.heights.empty()) return valid;
  if (line.heights.size() != line.vertices.size()) {
    checks->Violate(path.Field("heights"),
                    "must have one element a vertex, " +
                        std::to_string(line.vertices.size()) +
                        ", or none, got " +
                        std::to_string(line.heights.size()));
    valid = false;
  }
  for (std::size_t k = 0; k < std::min(line.heights.size(), most); ++k) {
    const Path height = path.Element("heights", k);
    if (!checks->Number(height, line.heights[k], kHeights)) continue;
    if (line.only_falls && k > 0 && line.heights[k] > line.heights[k - 1]) {
      checks->Violate(height, "must not be above the height before it, " +
                                  NumberText(line.heights[k - 1]) +
                                  ", where the line only falls; got " +
                                  NumberText(line.heights[k]));
    }
  }
  return valid;
}

// All rows, table rows and samples of lines together; each is valid alone.
void ValidateTotal(const Path& path, const TerrainSpec& spec,
                   SpecChecks* checks) {
  // A refinement's lattice is that of its raster.
  if (spec.refinement.has_value() && RefinedRaster(spec) == nullptr) return;
  const SpotHeights& spots = spec.spots;
  const auto most = static_cast<std::size_t>(checks->limits().max_spots);
  const Frame frame = FrameOf(spec);
  const int level = spots.level.value_or(
      DefaultSpotLevel(spots, frame, checks->dimensions()));
  std::size_t rows = spots.points.size();
  if (spots.table != nullptr) rows += spots.table->size();
  rows += CountLineSamples(spots, frame, level, checks->dimensions(), most);
  if (rows > most) {
    checks->Violate(path, "must have at most " + std::to_string(most) +
                              " points, table rows and samples of lines "
                              "together, got more");
  }
}

}  // namespace

void ValidateSpots(const Path& root, const TerrainSpec& spec,
                   SpecChecks* checks) {
  const SpotHeights& spots = spec.spots;
  const Path path = root.Field("spots");
  const auto most = static_cast<std::size_t>(checks->limits().max_spots);
  const auto most_inline =
      static_cast<std::size_t>(checks->limits().max_inline_spots);
  const bool few_points =
      checks->Count(path.Field("points"), spots.points.size(), 0, most_inline);
  const bool few_lines =
      checks->Count(path.Field("lines"), spots.lines.size(), 0, most_inline);
  const bool few_rows =
      spots.table == nullptr ||
      checks->Count(path.Field("table"), spots.table->size(), 0, most);
  const bool level_good =
      !spots.level.has_value() ||
      checks->Integer(path.Field("level"), *spots.level, 0, kMaxSpotLevel);
  bool countable = few_points && few_lines && few_rows && level_good;
  // Of what is too many, nothing is looked at.
  if (few_points) ValidateRows(path, "points", spots.points, spec, checks);
  if (few_rows && spots.table != nullptr) {
    ValidateRows(path, "table", *spots.table, spec, checks);
  }
  for (std::size_t k = 0; few_lines && k < spots.lines.size(); ++k) {
    countable &=
        ValidateLine(path.Element("lines", k), spots.lines[k], spec, checks);
  }
  if (countable) ValidateTotal(path, spec, checks);
}

}  // namespace terrane::core
