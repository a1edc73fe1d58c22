// From the options that say which surface, to the recipe that is asked for.
#ifndef TERRANE_CLIENT_CHOSEN_SURFACE_H_
#define TERRANE_CLIENT_CHOSEN_SURFACE_H_

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/backend.h"

namespace terrane::client {

// Exactly one of preset, recipe_file and net_file. What is set further down
// takes the place of what the recipe says.
struct SurfaceOptions {
  std::string preset;
  std::string recipe_file;
  // Control points, row by row: a CSV with columns x, y, z, or the v lines of
  // an OBJ file.
  std::string net_file;
  int net_columns = 0;  // 0: as many as rows
  std::optional<v1::SplineBasis> basis;
  std::optional<int> degree;
  std::optional<v1::SurfaceMethod> method;
  std::optional<std::int64_t> seed;
};

struct ChosenSurface {
  v1::SurfaceRecipe recipe;
  // How a preset wants to be looked at; empty otherwise.
  v1::SurfaceView view;
};

// Whether a preset of that name is a surface.
bool IsSurfacePreset(const std::string& name);

// Reads files and asks for the preset. Errors: none or several of the three, an
// unreadable file, a recipe that is no JSON of a SurfaceRecipe, a net whose
// points make no rectangle, and those of the backend.
absl::StatusOr<ChosenSurface> ChooseSurface(const SurfaceOptions& options,
                                            Backend* backend,
                                            std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHOSEN_SURFACE_H_
