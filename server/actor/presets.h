// The presets that ship with the server: protobuf-JSON presets of
// server/presets, embedded when it is built. Those below surface/ are
// SurfacePresets, those below tree/ TreePresets, those below flower/
// FlowerPresets, all others TerrainPresets.
//
// Threads: immutable; any. Errors: NOT_FOUND with the reason
// "PRESET_NOT_FOUND". An embedded preset that does not parse is a fault of the
// build and ends the process at the first use; the tests load them all.
#ifndef TERRANE_SERVER_ACTOR_PRESETS_H_
#define TERRANE_SERVER_ACTOR_PRESETS_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "terrane/v1/flower_recipe.pb.h"
#include "terrane/v1/surface_recipe.pb.h"
#include "terrane/v1/terrain_recipe.pb.h"
#include "terrane/v1/tree_recipe.pb.h"

namespace terrane::server {

// By name, and so sorted.
const std::map<std::string, v1::TerrainPreset>& Presets();
const std::map<std::string, v1::SurfacePreset>& SurfacePresets();
const std::map<std::string, v1::TreePreset>& TreePresets();
const std::map<std::string, v1::FlowerPreset>& FlowerPresets();

absl::StatusOr<const v1::TerrainPreset*> FindPreset(const std::string& name);
absl::StatusOr<const v1::SurfacePreset*> FindSurfacePreset(
    const std::string& name);
absl::StatusOr<const v1::TreePreset*> FindTreePreset(const std::string& name);
absl::StatusOr<const v1::FlowerPreset*> FindFlowerPreset(
    const std::string& name);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_PRESETS_H_
