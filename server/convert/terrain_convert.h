// A terrain between the API and the core, both ways.
//
// Reading never stops at the first fault: every violation is collected, by its
// path in the request, before anything is allocated that is larger than the
// request itself. Writing what was read from a resolved recipe gives the same
// recipe.
//
// Threads: any. Errors: violations, and content that is not kept (ReadRecipe).
#ifndef TERRANE_SERVER_CONVERT_TERRAIN_CONVERT_H_
#define TERRANE_SERVER_CONVERT_TERRAIN_CONVERT_H_

#include <cstddef>
#include <map>
#include <string>

#include "core/base/violations.h"
#include "core/terrain/spec_checks.h"
#include "core/terrain/terrain.h"
#include "core/terrain/terrain_spec.h"
#include "server/convert/raster_source.h"
#include "server/convert/spot_table_source.h"
#include "terrane/v1/terrain.pb.h"
#include "terrane/v1/terrain_recipe.pb.h"

namespace terrane::server {

// Largest text of a coordinate reference system.
inline constexpr std::size_t kMaxCrsBytes = 16 * 1024;

// Where the content that a recipe names by id comes from.
struct ContentSources {
  RasterSource* rasters = nullptr;
  SpotTableSource* spot_tables = nullptr;
};

// A recipe for the core, and what the core does not need to know of it.
struct ReadRecipe {
  core::TerrainSpec spec;
  // The frame's, or that of a refined raster when the recipe has no frame.
  std::string crs;
  // The id of each raster that the spec holds.
  std::map<const core::Raster*, std::string> raster_ids;
  // The first raster, and the spot table, that the sources do not keep: no
  // violations, as they can be uploaded. The spec has none in their places; all
  // else in it is checked.
  std::string missing_raster;
  std::string missing_spot_table;
  // The id of the spec's spot table.
  std::string spot_table_id;
};

// Converts and checks (core::ValidateSpec) a recipe. `prefix` stands before the
// path of each field, such as "terrain.recipe.".
ReadRecipe ReadTerrainRecipe(const v1::TerrainRecipe& recipe,
                             const ContentSources& sources,
                             const core::SpecLimits& limits,
                             const std::string& prefix,
                             core::Violations* violations);

// A frame with its defaults: a spacing of 0 means 1. Adds a violation when the
// reference system's text is too long; the numbers are the core's to check.
core::Frame ReadFrame(const v1::Frame& frame, const core::Path& path,
                      core::Violations* violations);

// The resolved spec of a Terrain made from `read`, as a message in which every
// field says what it means.
v1::TerrainRecipe WriteTerrainRecipe(const core::TerrainSpec& resolved,
                                     const ReadRecipe& read);

void WriteFrame(const core::Frame& frame, const std::string& crs,
                v1::Frame* message);

// What became of a terrain's spot heights.
v1::SpotReport WriteSpotReport(const core::SpotReport& report);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_TERRAIN_CONVERT_H_
