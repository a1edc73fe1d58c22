#include "core/codec/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/codec/number_text.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

// How far the square of a unit vector's length may be from 1.
constexpr float kUnitTolerance = 1e-3f;

bool IsShare(float value) { return value >= 0.0f && value <= 1.0f; }
bool IsUnit(float square) { return std::fabs(square - 1) <= kUnitTolerance; }
bool IsFinite(const Float3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::string Element(const std::string& field, std::size_t index) {
  return field + "[" + std::to_string(index) + "]";
}

std::string TextOf(const Float3& p) {
  std::string text = "(";
  AppendNumber(p.x, &text);
  text += ", ";
  AppendNumber(p.y, &text);
  text += ", ";
  AppendNumber(p.z, &text);
  text += ")";
  return text;
}

absl::Status CheckShare(const std::string& field, float value, bool below_one) {
  if (IsShare(value) && !(below_one && value >= 1)) return absl::OkStatus();
  std::string what =
      below_one ? "must be in [0, 1), got " : "must be in [0, 1], got ";
  AppendNumber(value, &what);
  return SceneError(field, what);
}

absl::Status CheckMaterial(const Material& material, const std::string& field) {
  absl::Status status = absl::OkStatus();
  for (const float part : material.base_color) {
    if (status.ok()) status = CheckShare(field + ".base_color", part, false);
  }
  if (status.ok()) {
    status = CheckShare(field + ".roughness", material.roughness, false);
  }
  if (status.ok()) {
    status = CheckShare(field + ".specular", material.specular, true);
  }
  if (status.ok())
    status = CheckShare(field + ".gloss", material.Gloss(), false);
  return status;
}

// Every element of a column is as `is_well` has it.
template <typename IsWell>
absl::Status CheckEach(const std::vector<Float3>& column,
                       const std::string& field, const char* rule,
                       IsWell is_well) {
  const auto bad = std::find_if_not(column.begin(), column.end(), is_well);
  if (bad == column.end()) return absl::OkStatus();
  const auto index = static_cast<std::size_t>(bad - column.begin());
  return SceneError(Element(field, index), rule + (", got " + TextOf(*bad)));
}

absl::Status CheckCount(const std::string& field, std::size_t count,
                        std::size_t vertices) {
  if (count == 0 || count == vertices) return absl::OkStatus();
  return SceneError(field, "must be one a vertex, got " +
                               std::to_string(count) + " of " +
                               std::to_string(vertices));
}

absl::Status CheckIndices(const Mesh& mesh, const std::string& field) {
  if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) {
    return SceneError(
        field, "must be three a triangle and one triangle at least, got " +
                   std::to_string(mesh.indices.size()));
  }
  const std::uint32_t largest =
      *std::max_element(mesh.indices.begin(), mesh.indices.end());
  if (largest < mesh.positions.size()) return absl::OkStatus();
  return SceneError(field, "must be below the number of vertices, " +
                               std::to_string(mesh.positions.size()) +
                               ", got " + std::to_string(largest));
}

absl::Status CheckMesh(const Mesh& mesh, const std::string& field) {
  const std::size_t vertices = mesh.positions.size();
  absl::Status status = CheckIndices(mesh, field + ".indices");
  if (status.ok()) {
    status = CheckCount(field + ".normals", mesh.normals.size(), vertices);
  }
  if (status.ok()) {
    status = CheckCount(field + ".uvs", mesh.uvs.size(), vertices);
  }
  if (status.ok()) {
    status = CheckCount(field + ".colors", mesh.colors.size(), vertices);
  }
  if (status.ok()) {
    status = CheckEach(mesh.positions, field + ".positions", "must be finite",
                       IsFinite);
  }
  if (status.ok()) {
    status =
        CheckEach(mesh.normals, field + ".normals", "must be a unit vector",
                  [](const Float3& n) { return IsUnit(Dot(n, n)); });
  }
  if (status.ok()) {
    status = CheckEach(mesh.colors, field + ".colors", "must be in [0, 1]",
                       [](const Float3& c) {
                         return IsShare(c.x) && IsShare(c.y) && IsShare(c.z);
                       });
  }
  return status;
}

absl::Status CheckInstances(const Instances& instances,
                            const std::string& field) {
  const std::size_t count = instances.count();
  if (count == 0 || instances.rotations.size() != count ||
      instances.scales.size() != count) {
    return SceneError(field, "must be columns of one length above 0, got " +
                                 std::to_string(count) + ", " +
                                 std::to_string(instances.rotations.size()) +
                                 " and " +
                                 std::to_string(instances.scales.size()));
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Quaternion& q = instances.rotations[k];
    if (!IsUnit(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)) {
      return SceneError(Element(field + ".rotations", k),
                        "must be a unit quaternion");
    }
  }
  absl::Status status =
      CheckEach(instances.translations, field + ".translations",
                "must be finite", IsFinite);
  if (!status.ok()) return status;
  return CheckEach(instances.scales, field + ".scales",
                   "must be finite and above 0", [](const Float3& s) {
                     return IsFinite(s) && s.x > 0 && s.y > 0 && s.z > 0;
                   });
}

}  // namespace

absl::Status SceneError(const std::string& field, const std::string& what) {
  return absl::InvalidArgumentError(field + ": " + what);
}

absl::Status CheckScene(const Scene& scene) {
  if (scene.objects.empty()) return SceneError("objects", "must not be empty");
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    const absl::Status status =
        CheckMaterial(scene.materials[k], Element("materials", k));
    if (!status.ok()) return status;
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const SceneObject& object = scene.objects[k];
    const std::string field = Element("objects", k);
    if (object.material >= scene.materials.size()) {
      return SceneError(field + ".material",
                        "must be below the number of materials, " +
                            std::to_string(scene.materials.size()) + ", got " +
                            std::to_string(object.material));
    }
    absl::Status status = CheckMesh(*object.mesh, field + ".mesh");
    if (status.ok() && object.instances != nullptr) {
      status = CheckInstances(*object.instances, field + ".instances");
    }
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace terrane::core
