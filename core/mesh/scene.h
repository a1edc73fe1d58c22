// Scene: meshes, what they are made of, and where they stand.
//
// What a plant is, apart from its numbers: few prototype meshes, many
// instances of them. Written to files by core/codec, drawn by core/raytrace.
// z is up. Plain data; belongs to one thread at a time. A scene refers to its
// meshes and instances, whoever made them keeps them alive.
#ifndef TERRANE_CORE_MESH_SCENE_H_
#define TERRANE_CORE_MESH_SCENE_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/mesh.h"

namespace terrane::core {

// The parameters of the shading model of Wang, Zhang & Yang 2019, section 2:
// the paper's Bc, Rn, r0 and g.
struct Material {
  std::string name;
  // Bc: linear red, green and blue, each in [0, 1]; a mesh's colours multiply
  // it.
  std::array<float, 3> base_color = {0.8f, 0.8f, 0.8f};
  // Rn, of the diffuse part, [0, 1].
  float roughness = 0.9f;
  // r0, reflectance at normal incidence, [0, 1).
  float specular = 0.04f;
  // g, of the specular part, [0, 1]: the lobe's exponent is 8192^g. Default: 1
  // - Rn.
  std::optional<float> gloss;
  // Whether the side that normals point away from is seen.
  bool double_sided = false;

  float Gloss() const { return gloss.value_or(1 - roughness); }
  bool operator==(const Material&) const = default;
};

// A rotation as a unit quaternion.
struct Quaternion {
  float x = 0;
  float y = 0;
  float z = 0;
  float w = 1;

  bool operator==(const Quaternion&) const = default;
};

// Where the instances of a mesh stand, as columns of one length: a vertex p
// goes to translation + rotation * (scale * p).
struct Instances {
  std::vector<Float3> translations;
  std::vector<Quaternion> rotations;
  std::vector<Float3> scales;  // above 0

  std::size_t count() const { return translations.size(); }
};

struct SceneObject {
  std::string name;
  const Mesh* mesh = nullptr;
  std::size_t material = 0;  // in Scene::materials
  // Default: once, where its vertices are. Not empty.
  const Instances* instances = nullptr;
};

struct Scene {
  std::vector<Material> materials;
  std::vector<SceneObject> objects;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_SCENE_H_
