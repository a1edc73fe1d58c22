#include "core/codec/gltf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/codec/gltf_columns.h"
#include "core/codec/material_model.h"
#include "core/codec/scene_checks.h"

namespace terrane::core {
namespace {

using Json = GltfColumns::Json;

// Constants of the glTF 2.0 specification.
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

constexpr char kInstancing[] = "EXT_mesh_gpu_instancing";
constexpr char kIor[] = "KHR_materials_ior";
constexpr char kLod[] = "MSFT_lod";

Json JsonOf(const Material& material) {
  const auto& [red, green, blue] = material.base_color;
  // In float32, as glTF's readers hold them.
  const auto roughness = static_cast<float>(GgxRoughness(material));
  const auto ior = static_cast<float>(IndexOfRefraction(material));
  return {{"name", material.name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {red, green, blue, 1.0f}},
            {"metallicFactor", 0},
            {"roughnessFactor", roughness}}},
          {"doubleSided", material.double_sided},
          {"extensions", {{kIor, {{"ior", ior}}}}},
          {"extras",
           {{"Bc", material.base_color},
            {"Rn", material.roughness},
            {"g", material.Gloss()},
            {"r0", material.specular}}}};
}

// Builds the JSON and lists the columns side by side.
class GlbWriter {
 public:
  GlbWriter(std::span<const Scene> levels, const GlbOptions& options)
      : levels_(levels), options_(options) {}

  absl::StatusOr<std::string> Write(Json extras) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Terrane"}};
    if (!extras.is_null()) json_["asset"]["extras"] = std::move(extras);
    for (const Scene& level : levels_) AddLevel(level);
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", Json::array({roots_[0]})}}});
    if (roots_.size() > 1) {
      const std::vector<std::size_t> coarser(roots_.begin() + 1, roots_.end());
      nodes_[roots_[0]]["extensions"][kLod] = {{"ids", coarser}};
      used_.push_back(kLod);
    }
    if (instances_by_extension_) {
      used_.push_back(kInstancing);
      json_["extensionsRequired"] = {kInstancing};
    }
    used_.push_back(kIor);
    json_["extensionsUsed"] = used_;
    json_["nodes"] = std::move(nodes_);
    json_["meshes"] = std::move(meshes_);
    for (const Material& material : materials_) {
      json_["materials"].push_back(JsonOf(material));
    }
    json_["bufferViews"] = columns_.views();
    json_["accessors"] = columns_.accessors();
    json_["buffers"] = Json::array({{{"byteLength", columns_.bytes()}}});
    return Assemble();
  }

 private:
  std::size_t AddNode(Json node) {
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }

  // A root that turns z up into y up, -90 degrees about x, and its objects.
  void AddLevel(const Scene& level) {
    constexpr double kHalfRoot = 0.70710678118654752;
    const double scale = options_.metres_per_unit;
    const std::size_t root =
        AddNode({{"name", "root"},
                 {"rotation", {-kHalfRoot, 0, 0, kHalfRoot}},
                 {"scale", {scale, scale, scale}}});
    roots_.push_back(root);
    Json children = Json::array();
    for (const SceneObject& object : level.objects) {
      const std::size_t mesh =
          AddMesh(object, AddMaterial(level.materials[object.material]));
      children.push_back(AddObject(object, mesh));
    }
    nodes_[root]["children"] = std::move(children);
  }

  // Levels share the materials that they have in common.
  std::size_t AddMaterial(const Material& material) {
    const auto found =
        std::find(materials_.begin(), materials_.end(), material);
    const auto index = static_cast<std::size_t>(found - materials_.begin());
    if (found == materials_.end()) materials_.push_back(material);
    return index;
  }

  std::size_t AddObject(const SceneObject& object, std::size_t mesh) {
    if (object.instances == nullptr) {
      return AddNode({{"name", object.name}, {"mesh", mesh}});
    }
    const Instances& instances = *object.instances;
    if (options_.instancing == GltfInstancing::kExtension) {
      instances_by_extension_ = true;
      const Json attributes = {
          {"TRANSLATION", columns_.AddOfInstances(instances.translations)},
          {"ROTATION", columns_.AddOfInstances(instances.rotations)},
          {"SCALE", columns_.AddOfInstances(instances.scales)}};
      return AddNode(
          {{"name", object.name},
           {"mesh", mesh},
           {"extensions", {{kInstancing, {{"attributes", attributes}}}}}});
    }
    const std::size_t group = AddNode({{"name", object.name}});
    Json children = Json::array();
    for (std::size_t k = 0; k < instances.count(); ++k) {
      const Float3& at = instances.translations[k];
      const Quaternion& turn = instances.rotations[k];
      const Float3& scale = instances.scales[k];
      children.push_back(
          AddNode({{"mesh", mesh},
                   {"translation", {at.x, at.y, at.z}},
                   {"rotation", {turn.x, turn.y, turn.z, turn.w}},
                   {"scale", {scale.x, scale.y, scale.z}}}));
    }
    nodes_[group]["children"] = std::move(children);
    return group;
  }

  std::size_t AddMesh(const SceneObject& object, std::size_t material) {
    const auto [found, is_new] =
        mesh_of_.try_emplace({object.mesh, material}, meshes_.size());
    if (!is_new) return found->second;
    const Mesh& mesh = *object.mesh;
    Json attributes;
    attributes["POSITION"] = columns_.AddPositions(mesh.positions);
    if (!mesh.normals.empty()) {
      attributes["NORMAL"] = columns_.AddVertices(mesh.normals);
    }
    if (!mesh.uvs.empty()) {
      attributes["TEXCOORD_0"] = columns_.AddVertices(mesh.uvs);
    }
    if (!mesh.colors.empty()) {
      attributes["COLOR_0"] = columns_.AddVertices(mesh.colors);
    }
    const std::size_t indices =
        columns_.AddIndices(mesh.indices, mesh.positions.size());
    meshes_.push_back(
        {{"name", object.name},
         {"primitives", Json::array({{{"attributes", std::move(attributes)},
                                      {"indices", indices},
                                      {"material", material}}})}});
    return found->second;
  }

  static void AppendWord(std::uint32_t word, std::string* bytes) {
    char text[sizeof(word)];
    std::memcpy(text, &word, sizeof(word));
    bytes->append(text, sizeof(word));
  }

  absl::StatusOr<std::string> Assemble() const {
    // A name that is no UTF-8 does not stop the file.
    std::string text =
        json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    // Chunks are whole words: spaces fill the JSON. Columns are whole words.
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + columns_.bytes();
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      return SceneError("objects", "must fit into 4 GiB, got " +
                                       std::to_string(total) + " bytes");
    }
    std::string glb;
    glb.reserve(total);
    AppendWord(kMagic, &glb);
    AppendWord(kVersion, &glb);
    AppendWord(static_cast<std::uint32_t>(total), &glb);
    AppendWord(static_cast<std::uint32_t>(text.size()), &glb);
    AppendWord(kJsonChunk, &glb);
    glb += text;
    AppendWord(static_cast<std::uint32_t>(columns_.bytes()), &glb);
    AppendWord(kBinaryChunk, &glb);
    columns_.AppendTo(&glb);
    return glb;
  }

  const std::span<const Scene> levels_;
  const GlbOptions& options_;
  Json json_;
  Json nodes_ = Json::array();
  Json meshes_ = Json::array();
  GltfColumns columns_;
  std::vector<std::size_t> roots_;  // of the levels
  std::vector<Material> materials_;
  std::map<std::pair<const Mesh*, std::size_t>, std::size_t> mesh_of_;
  std::vector<std::string> used_;  // extensions
  bool instances_by_extension_ = false;
};

}  // namespace

absl::StatusOr<std::string> EncodeGlb(const Scene& scene,
                                      const GlbOptions& options) {
  return EncodeGlb(std::span(&scene, 1), options);
}

absl::StatusOr<std::string> EncodeGlb(std::span<const Scene> levels,
                                      const GlbOptions& options) {
  if (levels.empty()) return SceneError("levels", "must not be empty");
  for (const Scene& level : levels) {
    const absl::Status checked = CheckScene(level);
    if (!checked.ok()) return checked;
  }
  const double scale = options.metres_per_unit;
  if (!(scale > 0 && std::isfinite(scale))) {
    return SceneError("metres_per_unit", "must be finite and above 0, got " +
                                             std::to_string(scale));
  }
  Json extras;
  if (!options.extras.empty()) {
    extras = Json::parse(options.extras, nullptr, false);
    if (extras.is_discarded()) return SceneError("extras", "must be JSON");
  }
  return GlbWriter(levels, options).Write(std::move(extras));
}

}  // namespace terrane::core
