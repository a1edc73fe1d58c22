// A surface between the API and the core, both ways, and what a request asks of
// it.
//
// As terrain_convert.h and request_plan.h: every violation is collected, by its
// path in the request, and writing what was read gives a recipe in which every
// field says what it means. Threads: any.
#ifndef TERRANE_SERVER_CONVERT_SURFACE_CONVERT_H_
#define TERRANE_SERVER_CONVERT_SURFACE_CONVERT_H_

#include <string>

#include "core/base/violations.h"
#include "core/surface/surface.h"
#include "server/actor/limits.h"
#include "server/convert/request_plan.h"
#include "terrane/v1/surface.pb.h"

namespace terrane::server {

// Converts and checks (core::ValidateSurface) a recipe. `prefix` stands before
// the path of each field, such as "surface.recipe.".
core::SurfaceSpec ReadSurfaceRecipe(const v1::SurfaceRecipe& recipe,
                                    const std::string& prefix,
                                    core::Violations* violations);

// The recipe of a valid spec with every default filled in.
v1::SurfaceRecipe WriteSurfaceRecipe(const core::SurfaceSpec& spec);

// The tiles of a StreamSurface request; `tiles` counts samples of the grid, or
// of the raster of a height field.
struct SurfacePlan {
  core::SurfaceGrid grid;
  bool heights = false;
  bool uvs = false;
  bool share_edges = false;
  TilePlan tiles;

  // Of positions, normals and texture coordinates, or heights.
  int bytes_per_sample() const {
    if (heights) return tiles.bytes_per_sample();
    return static_cast<int>((uvs ? 8 : 6) * sizeof(float));
  }
};

// `spec` is valid, or null when it is not: then only what does not depend on it
// is checked. Violations of a height field are those of the recipe, below
// `recipe_prefix`.
SurfacePlan PlanSurface(const v1::StreamSurfaceRequest& request,
                        const core::SurfaceSpec* spec, const Limits& limits,
                        const std::string& prefix,
                        const std::string& recipe_prefix,
                        core::Violations* violations);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_SURFACE_CONVERT_H_
