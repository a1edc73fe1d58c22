// A flower between the API and the core, both ways.
//
// As tree_convert.h: every violation is collected, by its path in the request,
// and writing what was read gives a recipe in which every field says what it
// means. Reading is in read_flower.cc, writing in write_flower.cc. Threads:
// any.
#ifndef TERRANE_SERVER_CONVERT_FLOWER_CONVERT_H_
#define TERRANE_SERVER_CONVERT_FLOWER_CONVERT_H_

#include <cstddef>
#include <string>

#include "core/base/violations.h"
#include "core/flower/flower_spec.h"
#include "core/flower/instance_block.h"
#include "core/flower/prototypes.h"
#include "core/flower/validate_flower.h"
#include "terrane/v1/flower.pb.h"
#include "terrane/v1/flower_recipe.pb.h"

namespace terrane::server {

// Converts and checks (core::ValidateFlowerSpec) a recipe. `prefix` stands
// before the path of each field, such as "flower.recipe.".
core::FlowerSpec ReadFlowerRecipe(const v1::FlowerRecipe& recipe,
                                  const core::FlowerLimits& limits,
                                  const std::string& prefix,
                                  core::Violations* violations);

// The recipe of a valid spec with every default filled in.
v1::FlowerRecipe WriteFlowerRecipe(const core::FlowerSpec& spec);

// Vertices and indices of one part of a prototype.
inline constexpr std::size_t kPartVertices = 8'192;
inline constexpr std::size_t kPartIndices = 49'152;

// Parts that a mesh is sent in, at least 1.
std::size_t PartsOfMesh(std::size_t vertices, std::size_t indices);

// Part `run` of a prototype, checksum included; all but `part` and `prototype`.
void WritePrototypePart(const core::FlowerPrototype& prototype, std::size_t run,
                        v1::PrototypePart* part);

// A block, checksum included; all but `part`.
void WriteInstances(const core::InstanceBlock& block, v1::InstanceRows* rows);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_FLOWER_CONVERT_H_
