// Meshes to Wavefront OBJ text.
//
// Threads: any. The same mesh gives the same bytes; numbers are the shortest
// that read back as the same float.
#ifndef TERRANE_CORE_CODEC_OBJ_H_
#define TERRANE_CORE_CODEC_OBJ_H_

#include <string>

#include "core/mesh/mesh.h"

namespace terrane::core {

// One object: v, vt and vn lines where the mesh has them, then f lines. The z
// axis points up, as in the mesh.
std::string EncodeObj(const Mesh& mesh, const std::string& name);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_OBJ_H_
