// Meshes to the bytes of a glTF 2.0 binary file (GLB).
//
// A scene is objects (a mesh and a material each) and the materials they name.
// The scene's z axis points up, glTF's y axis: the root node turns it, the
// vertices stay as they are. One buffer holds every column, each in a view of
// its own. The same scene gives the same bytes.
//
// Threads: any. Errors: INVALID_ARGUMENT for a scene without an object, a mesh
// without a triangle, columns of different sizes, an index without a vertex, a
// material that is not there or out of range, or more than 4 GiB.
#ifndef TERRANE_CORE_CODEC_GLTF_H_
#define TERRANE_CORE_CODEC_GLTF_H_

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/mesh/mesh.h"

namespace terrane::core {

// A metallic-roughness material without textures.
struct GltfMaterial {
  std::string name;
  // Linear red, green, blue and opacity, each in [0, 1].
  std::array<float, 4> base_color = {0.8f, 0.8f, 0.8f, 1.0f};
  float metallic = 0;   // [0, 1]
  float roughness = 1;  // [0, 1]
  bool double_sided = false;
};

struct GltfObject {
  std::string name;
  const Mesh* mesh = nullptr;  // outlives the call
  std::size_t material = 0;    // in GltfScene::materials
};

struct GltfScene {
  std::vector<GltfMaterial> materials;
  std::vector<GltfObject> objects;
};

absl::StatusOr<std::string> EncodeGlb(const GltfScene& scene);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_GLTF_H_
