#include "core/codec/gltf.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/status/status.h"

namespace terrane::core {
namespace {

static_assert(std::endian::native == std::endian::little,
              "columns are copied as they lie in memory");

using Json = nlohmann::ordered_json;

// Constants of the glTF 2.0 specification.
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

absl::Status Bad(const std::string& field, const std::string& what) {
  return absl::InvalidArgumentError(field + ": " + what);
}

bool IsShare(float value) { return value >= 0.0f && value <= 1.0f; }

absl::Status CheckMaterial(const GltfMaterial& material,
                           const std::string& field) {
  if (!std::all_of(material.base_color.begin(), material.base_color.end(),
                   IsShare)) {
    return Bad(field + ".base_color", "must be in [0, 1]");
  }
  if (!IsShare(material.metallic) || !IsShare(material.roughness)) {
    return Bad(field, "metallic and roughness must be in [0, 1]");
  }
  return absl::OkStatus();
}

absl::Status CheckMesh(const Mesh& mesh, const std::string& field) {
  const std::size_t vertices = mesh.positions.size();
  if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) {
    return Bad(field + ".indices",
               "must be three a triangle and one triangle at least, got " +
                   std::to_string(mesh.indices.size()));
  }
  if (!mesh.normals.empty() && mesh.normals.size() != vertices) {
    return Bad(field + ".normals", "must be one a vertex, got " +
                                       std::to_string(mesh.normals.size()));
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) {
    return Bad(field + ".uvs",
               "must be one a vertex, got " + std::to_string(mesh.uvs.size()));
  }
  const std::uint32_t largest =
      *std::max_element(mesh.indices.begin(), mesh.indices.end());
  if (largest >= vertices) {
    return Bad(field + ".indices", "must be below the number of vertices, " +
                                       std::to_string(vertices) + ", got " +
                                       std::to_string(largest));
  }
  return absl::OkStatus();
}

absl::Status CheckScene(const GltfScene& scene) {
  if (scene.objects.empty()) return Bad("objects", "must not be empty");
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    const absl::Status status = CheckMaterial(
        scene.materials[k], "materials[" + std::to_string(k) + "]");
    if (!status.ok()) return status;
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const std::string field = "objects[" + std::to_string(k) + "]";
    if (scene.objects[k].material >= scene.materials.size()) {
      return Bad(field + ".material", "is not there");
    }
    const absl::Status status =
        CheckMesh(*scene.objects[k].mesh, field + ".mesh");
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Builds the JSON and the binary chunk side by side.
class GlbWriter {
 public:
  explicit GlbWriter(const GltfScene& scene) : scene_(scene) {}

  absl::StatusOr<std::string> Write() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Terrane"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
    AddNodes();
    for (const GltfObject& object : scene_.objects) AddMesh(object);
    for (const GltfMaterial& material : scene_.materials) {
      AddMaterial(material);
    }
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    return Assemble();
  }

 private:
  // The root turns z up into y up: -90 degrees about x.
  void AddNodes() {
    constexpr double kHalfRoot = 0.70710678118654752;
    Json children = Json::array();
    for (std::size_t k = 0; k < scene_.objects.size(); ++k) {
      children.push_back(k + 1);
    }
    json_["nodes"].push_back({{"name", "root"},
                              {"rotation", {-kHalfRoot, 0, 0, kHalfRoot}},
                              {"children", std::move(children)}});
    for (std::size_t k = 0; k < scene_.objects.size(); ++k) {
      json_["nodes"].push_back({{"name", scene_.objects[k].name}, {"mesh", k}});
    }
  }

  void AddMesh(const GltfObject& object) {
    const Mesh& mesh = *object.mesh;
    Json attributes;
    attributes["POSITION"] =
        AddColumn(mesh.positions, kFloat, "VEC3", kArrayBuffer);
    AddBounds(mesh);
    if (!mesh.normals.empty()) {
      attributes["NORMAL"] =
          AddColumn(mesh.normals, kFloat, "VEC3", kArrayBuffer);
    }
    if (!mesh.uvs.empty()) {
      attributes["TEXCOORD_0"] =
          AddColumn(mesh.uvs, kFloat, "VEC2", kArrayBuffer);
    }
    const std::size_t indices =
        AddColumn(mesh.indices, kUnsignedInt, "SCALAR", kElementArrayBuffer);
    json_["meshes"].push_back(
        {{"name", object.name},
         {"primitives", Json::array({{{"attributes", std::move(attributes)},
                                      {"indices", indices},
                                      {"material", object.material}}})}});
  }

  // Appends a column to the buffer; returns its accessor.
  template <typename Value>
  std::size_t AddColumn(const std::vector<Value>& column, int component_type,
                        const char* type, int target) {
    const std::size_t offset = binary_.size();
    const std::size_t bytes = column.size() * sizeof(Value);
    binary_.append(reinterpret_cast<const char*>(column.data()), bytes);
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", offset},
                                    {"byteLength", bytes},
                                    {"target", target}});
    json_["accessors"].push_back(
        {{"bufferView", json_["bufferViews"].size() - 1},
         {"componentType", component_type},
         {"count", column.size()},
         {"type", type}});
    return json_["accessors"].size() - 1;
  }

  // The bounds that positions must have, of the accessor added last.
  void AddBounds(const Mesh& mesh) {
    Float3 low = mesh.positions.front();
    Float3 high = low;
    for (const Float3& p : mesh.positions) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y),
              std::max(high.z, p.z)};
    }
    Json& accessor = json_["accessors"].back();
    accessor["min"] = {low.x, low.y, low.z};
    accessor["max"] = {high.x, high.y, high.z};
  }

  void AddMaterial(const GltfMaterial& material) {
    json_["materials"].push_back({{"name", material.name},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", material.base_color},
                                    {"metallicFactor", material.metallic},
                                    {"roughnessFactor", material.roughness}}},
                                  {"doubleSided", material.double_sided}});
  }

  static void AppendWord(std::uint32_t word, std::string* bytes) {
    char text[sizeof(word)];
    std::memcpy(text, &word, sizeof(word));
    bytes->append(text, sizeof(word));
  }

  absl::StatusOr<std::string> Assemble() {
    std::string text = json_.dump();
    // Chunks are whole words: spaces fill the JSON. Columns are whole words.
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + binary_.size();
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      return Bad("objects", "must fit into 4 GiB, got " +
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
    AppendWord(static_cast<std::uint32_t>(binary_.size()), &glb);
    AppendWord(kBinaryChunk, &glb);
    glb += binary_;
    return glb;
  }

  const GltfScene& scene_;
  Json json_;
  std::string binary_;
};

}  // namespace

absl::StatusOr<std::string> EncodeGlb(const GltfScene& scene) {
  const absl::Status checked = CheckScene(scene);
  if (!checked.ok()) return checked;
  return GlbWriter(scene).Write();
}

}  // namespace terrane::core
