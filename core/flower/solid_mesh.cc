#include "core/flower/solid_mesh.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/flower/rotation.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

// Sines and cosines of equal parts of `degrees`, ends included.
std::vector<SineCosine64> Arc(int parts, double degrees) {
  std::vector<SineCosine64> arc;
  for (int i = 0; i <= parts; ++i) {
    arc.push_back(SineCosineOf(degrees * i / parts));
  }
  return arc;
}

// The circle closes exactly: its last place is its first.
std::vector<SineCosine64> Circle(int sides) {
  std::vector<SineCosine64> circle = Arc(sides, 360);
  circle.back() = circle.front();
  return circle;
}

class SolidWriter {
 public:
  SolidWriter(int sides, Mesh* mesh) : circle_(Circle(sides)), mesh_(*mesh) {}

  std::uint32_t Add(Float3 position, Float3 normal, Float2 uv) {
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
    mesh_.uvs.push_back(uv);
    return static_cast<std::uint32_t>(mesh_.positions.size()) - 1;
  }

  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.indices.push_back(a);
    mesh_.indices.push_back(b);
    mesh_.indices.push_back(c);
  }

  // A ring about y; its normals lean by `lean` (of the sine and cosine).
  std::uint32_t AddRing(double radius, double y, Vector normal, double v) {
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (std::size_t k = 0; k < circle_.size(); ++k) {
      const SineCosine64 at = circle_[k];
      Add(ToFloat3({radius * at.cosine, y, -radius * at.sine}),
          ToFloat3({normal.x * at.cosine, normal.y, -normal.x * at.sine}),
          {static_cast<float>(k) / static_cast<float>(circle_.size() - 1),
           static_cast<float>(v)});
    }
    return first;
  }

  // The band between two rings.
  void Connect(std::uint32_t low, std::uint32_t high) {
    for (std::uint32_t k = 0; k + 1 < circle_.size(); ++k) {
      AddTriangle(low + k, low + k + 1, high + k);
      AddTriangle(low + k + 1, high + k + 1, high + k);
    }
  }

  // A flat end at `y`, seen from above or from below.
  void AddCap(double radius, double y, bool above) {
    const double up = above ? 1 : -1;
    const std::uint32_t ring = AddRing(radius, y, {0, up, 0}, above ? 1 : 0);
    const std::uint32_t middle =
        Add(ToFloat3({0, y, 0}), ToFloat3({0, up, 0}), {0.5f, 0.5f});
    for (std::uint32_t k = ring; k + 1 < middle; ++k) {
      if (above) {
        AddTriangle(k, k + 1, middle);
      } else {
        AddTriangle(k + 1, k, middle);
      }
    }
  }

  void AddCylinder(double radius, double length) {
    AddCap(radius, 0, false);
    const std::uint32_t low = AddRing(radius, 0, {1, 0, 0}, 0);
    Connect(low, AddRing(radius, length, {1, 0, 0}, 1));
    AddCap(radius, length, true);
  }

  void AddEllipsoid(double radius, double half_length, double middle,
                    int rings) {
    const std::vector<SineCosine64> meridian = Arc(rings, 180);
    const std::uint32_t bottom =
        Add(ToFloat3({0, middle - half_length, 0}), {0, -1, 0}, {0.5f, 0});
    std::uint32_t before = 0;
    for (int i = 1; i < rings; ++i) {
      const SineCosine64 at = meridian[static_cast<std::size_t>(i)];
      const Vector normal =
          UnitOf({at.sine / radius, -at.cosine / half_length, 0});
      const std::uint32_t ring =
          AddRing(radius * at.sine, middle - half_length * at.cosine, normal,
                  static_cast<double>(i) / rings);
      if (i == 1) {
        for (std::uint32_t k = ring; k + 1 < ring + circle_.size(); ++k) {
          AddTriangle(k + 1, k, bottom);
        }
      } else {
        Connect(before, ring);
      }
      before = ring;
    }
    const std::uint32_t top =
        Add(ToFloat3({0, middle + half_length, 0}), {0, 1, 0}, {0.5f, 1});
    for (std::uint32_t k = before; k + 1 < top; ++k) AddTriangle(k, k + 1, top);
  }

 private:
  const std::vector<SineCosine64> circle_;
  Mesh& mesh_;
};

int RingsOf(int sides) { return std::max(3, sides / 2); }

Float3 ToColor(const Tint& tint) { return {tint[0], tint[1], tint[2]}; }

}  // namespace

bool HasFilament(const SolidGroup& solid) {
  return solid.filament_length > 0 && solid.filament_radius > 0;
}
bool HasHead(const SolidGroup& solid) {
  return solid.head_length > 0 && solid.head_radius > 0;
}

Mesh MakeCylinder(int sides) {
  Mesh mesh;
  SolidWriter(sides, &mesh).AddCylinder(1, 1);
  return mesh;
}

MeshSize CylinderSize(int sides) {
  return {4 * (std::int64_t{sides} + 1) + 2, 4 * std::int64_t{sides}};
}

bool HasColors(const SolidGroup& solid) {
  constexpr Tint kWhite = {1, 1, 1};
  return solid.filament_tint != kWhite || solid.head_tint != kWhite;
}

Mesh MakeSolid(const SolidGroup& solid) {
  Mesh mesh;
  SolidWriter writer(solid.sides, &mesh);
  if (HasFilament(solid)) {
    writer.AddCylinder(solid.filament_radius, solid.filament_length);
  }
  const std::size_t of_filament = mesh.positions.size();
  if (HasHead(solid)) {
    writer.AddEllipsoid(solid.head_radius, solid.head_length / 2,
                        solid.filament_length, RingsOf(solid.sides));
  }
  if (HasColors(solid)) {
    mesh.colors.assign(mesh.positions.size(), ToColor(solid.head_tint));
    std::fill_n(mesh.colors.begin(), of_filament, ToColor(solid.filament_tint));
  }
  return mesh;
}

MeshSize SolidSize(const SolidGroup& solid) {
  MeshSize size;
  if (HasFilament(solid)) size = CylinderSize(solid.sides);
  if (HasHead(solid)) {
    const std::int64_t sides = solid.sides;
    const std::int64_t rings = RingsOf(solid.sides);
    size.vertices += (rings - 1) * (sides + 1) + 2;
    size.triangles += 2 * sides * (rings - 1);
  }
  return size;
}

}  // namespace terrane::core
