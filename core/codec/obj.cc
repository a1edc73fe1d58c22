#include "core/codec/obj.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/codec/material_model.h"
#include "core/codec/number_text.h"
#include "core/codec/scene_checks.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

// The format's largest exponent of a highlight.
constexpr double kLargestNs = 1000;

template <typename Number>
void AppendLine(const char* keyword, std::span<const Number> numbers,
                std::string* text) {
  *text += keyword;
  for (const Number number : numbers) AppendNumber(' ', number, text);
  *text += '\n';
}

void AppendLine(const char* keyword, const Float3& v, std::string* text) {
  const float numbers[] = {v.x, v.y, v.z};
  AppendLine<float>(keyword, numbers, text);
}

void AppendLine(const char* keyword, double number, std::string* text) {
  const float numbers[] = {static_cast<float>(number)};
  AppendLine<float>(keyword, numbers, text);
}

std::string MaterialName(const Scene& scene, std::size_t index) {
  const std::string& name = scene.materials[index].name;
  return name.empty() ? "material-" + std::to_string(index) : name;
}

// Where one instance of a mesh stands.
class Place {
 public:
  Place() = default;
  Place(const Instances& instances, std::size_t index)
      : translation_(instances.translations[index]),
        rotation_(instances.rotations[index]),
        scale_(instances.scales[index]) {}

  Float3 Point(const Float3& p) const {
    return translation_ +
           Rotated({scale_.x * p.x, scale_.y * p.y, scale_.z * p.z});
  }

  Float3 Normal(const Float3& n) const {
    return Normalized(
        Rotated({n.x / scale_.x, n.y / scale_.y, n.z / scale_.z}));
  }

 private:
  Float3 Rotated(const Float3& v) const {
    const Float3 axis = {rotation_.x, rotation_.y, rotation_.z};
    const Float3 across = 2.0f * Cross(axis, v);
    return v + rotation_.w * across + Cross(axis, across);
  }

  Float3 translation_;
  Quaternion rotation_;
  Float3 scale_ = {1, 1, 1};
};

class ObjWriter {
 public:
  ObjWriter(const Scene& scene, const std::string& material_library)
      : scene_(scene), names_materials_(!material_library.empty()) {
    if (names_materials_) text_ = "mtllib " + material_library + "\n";
  }

  std::string Write() {
    for (const SceneObject& object : scene_.objects) {
      text_ += "o " + object.name + "\n";
      if (names_materials_) {
        text_ += "usemtl " + MaterialName(scene_, object.material) + "\n";
      }
      if (object.instances == nullptr) {
        AddVertices(*object.mesh, nullptr);
        AddFaces(*object.mesh);
        continue;
      }
      for (std::size_t k = 0; k < object.instances->count(); ++k) {
        const Place place(*object.instances, k);
        AddVertices(*object.mesh, &place);
        AddFaces(*object.mesh);
      }
    }
    return std::move(text_);
  }

 private:
  void AddVertices(const Mesh& mesh, const Place* place) {
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
      const Float3 p = place == nullptr ? mesh.positions[k]
                                        : place->Point(mesh.positions[k]);
      if (mesh.colors.empty()) {
        AppendLine("v", p, &text_);
        continue;
      }
      const Float3& c = mesh.colors[k];
      const float numbers[] = {p.x, p.y, p.z, c.x, c.y, c.z};
      AppendLine<float>("v", numbers, &text_);
    }
    for (const Float2& uv : mesh.uvs) {
      const float numbers[] = {uv.x, uv.y};
      AppendLine<float>("vt", numbers, &text_);
    }
    for (const Float3& n : mesh.normals) {
      AppendLine("vn", place == nullptr ? n : place->Normal(n), &text_);
    }
  }

  void AddFaces(const Mesh& mesh) {
    for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
      text_ += 'f';
      for (std::size_t corner = k; corner < k + 3; ++corner) {
        AddCorner(mesh, mesh.indices[corner]);
      }
      text_ += '\n';
    }
    places_ += mesh.positions.size();
    uvs_ += mesh.uvs.size();
    normals_ += mesh.normals.size();
  }

  // v, v/vt, v//vn or v/vt/vn; each kind is counted from 1, through all
  // objects.
  void AddCorner(const Mesh& mesh, std::uint32_t index) {
    AppendNumber(' ', places_ + index + 1, &text_);
    if (mesh.uvs.empty() && mesh.normals.empty()) return;
    text_ += '/';
    if (!mesh.uvs.empty()) AppendNumber(uvs_ + index + 1, &text_);
    if (mesh.normals.empty()) return;
    AppendNumber('/', normals_ + index + 1, &text_);
  }

  const Scene& scene_;
  const bool names_materials_;
  // Lines written so far.
  std::size_t places_ = 0;
  std::size_t uvs_ = 0;
  std::size_t normals_ = 0;
  std::string text_;
};

}  // namespace

absl::StatusOr<std::string> EncodeObj(const Scene& scene,
                                      const std::string& material_library) {
  const absl::Status checked = CheckScene(scene);
  if (!checked.ok()) return checked;
  return ObjWriter(scene, material_library).Write();
}

std::string EncodeMtl(const Scene& scene) {
  std::string text;
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    const Material& material = scene.materials[k];
    const float specular[] = {material.specular, material.specular,
                              material.specular};
    text += "newmtl " + MaterialName(scene, k) + "\n";
    AppendLine<float>("Kd", material.base_color, &text);
    AppendLine<float>("Ks", specular, &text);
    AppendLine("Ns", std::min(LobeExponent(material), kLargestNs), &text);
    AppendLine("Ni", IndexOfRefraction(material), &text);
    AppendLine("Pr", GgxRoughness(material), &text);
    text += "illum 2\n";
  }
  return text;
}

}  // namespace terrane::core
