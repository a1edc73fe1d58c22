// Scenes to the bytes of a glTF 2.0 binary file (GLB).
//
// A scene's z axis points up, glTF's y axis: the root node turns it and brings
// it to metres, the vertices stay as they are. One buffer holds every column,
// each in a view of its own; a mesh that several objects show is there once.
// The same scene and options give the same bytes.
//
// Materials: glTF's metallic-roughness model with no metal. The lobe of
// exponent alpha = 8192^g is nearest to GGX's with
//   roughness = (2 / (alpha + 2))^(1/4),
// and reflectance r0 is that of ior = (1 + sqrt r0) / (1 - sqrt r0)
// (KHR_materials_ior). The paper's own numbers, {Bc, Rn, g, r0}, are in the
// material's extras.
//
// Threads: any. Errors: INVALID_ARGUMENT that names the field of a scene or of
// the options which is not well (core/codec/scene_checks.h), or for more than
// 4 GiB.
#ifndef TERRANE_CORE_CODEC_GLTF_H_
#define TERRANE_CORE_CODEC_GLTF_H_

#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "core/mesh/scene.h"

namespace terrane::core {

// kExtension: EXT_mesh_gpu_instancing, 40 bytes an instance; the file requires
// it, for a reader that passed over it would show one instance of many. kNodes:
// a node an instance, which every reader knows.
enum class GltfInstancing { kExtension, kNodes };

struct GlbOptions {
  GltfInstancing instancing = GltfInstancing::kExtension;
  // What one unit of the scene is; finite and above 0.
  double metres_per_unit = 1;
  // JSON text for asset.extras, such as the recipe and revision; empty: none.
  std::string extras;
};

absl::StatusOr<std::string> EncodeGlb(const Scene& scene,
                                      const GlbOptions& options = {});

// Levels of detail of one scene, the finest first, one at least. A reader of
// MSFT_lod takes the level that suits, any other shows the finest.
absl::StatusOr<std::string> EncodeGlb(std::span<const Scene> levels,
                                      const GlbOptions& options = {});

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_GLTF_H_
