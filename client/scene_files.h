// Scenes into the files of other programs: GLB, and OBJ with its MTL.
#ifndef TERRANE_CLIENT_SCENE_FILES_H_
#define TERRANE_CLIENT_SCENE_FILES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/codec/gltf.h"
#include "core/mesh/scene.h"

namespace terrane::client {

// Writes the scene by the extension of `path`, .glb or .obj, and adds what was
// written to `files`. Errors: those of the codecs and of the disk.
absl::Status WriteScene(const std::string& path, const core::Scene& scene,
                        const core::GlbOptions& options,
                        std::vector<std::string>* files);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SCENE_FILES_H_
