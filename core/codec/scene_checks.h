// What is wrong with a scene, before a byte of a file is written.
//
// Threads: any. Errors: INVALID_ARGUMENT that names the first field which is
// not well, such as "objects[1].mesh.indices", its range and the value that
// came.
#ifndef TERRANE_CORE_CODEC_SCENE_CHECKS_H_
#define TERRANE_CORE_CODEC_SCENE_CHECKS_H_

#include <string>

#include "absl/status/status.h"
#include "core/mesh/scene.h"

namespace terrane::core {

// There is an object; every mesh has a triangle, columns of one size, finite
// positions, unit normals and indices that have vertices; every object has a
// material and, where it is instanced, an instance; numbers are in the ranges
// of core/mesh/scene.h.
absl::Status CheckScene(const Scene& scene);

// "field: what" as an error.
absl::Status SceneError(const std::string& field, const std::string& what);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_SCENE_CHECKS_H_
