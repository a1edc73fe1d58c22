// Scenes to Wavefront OBJ text, and their materials to the text of the MTL file
// beside it.
//
// An object a scene's object: v lines (with a colour behind the place where the
// mesh has colours), vt and vn lines where it has them, f lines. OBJ knows no
// instances, so they are written out, all of one object in one object. The z
// axis points up and lengths are the scene's, as in the scene.
//
// Threads: any. The same scene gives the same bytes; numbers are the shortest
// that read back as the same float. Errors: as EncodeGlb's
// (core/codec/scene_checks.h).
#ifndef TERRANE_CORE_CODEC_OBJ_H_
#define TERRANE_CORE_CODEC_OBJ_H_

#include <string>

#include "absl/status/statusor.h"
#include "core/mesh/scene.h"

namespace terrane::core {

// `material_library` is the name of the MTL file; empty: nothing is said of
// materials.
absl::StatusOr<std::string> EncodeObj(const Scene& scene,
                                      const std::string& material_library);

// Blinn and Phong's terms (Kd, Ks, Ns), with the refraction (Ni) and the
// physically based roughness (Pr) that many readers take.
std::string EncodeMtl(const Scene& scene);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_OBJ_H_
