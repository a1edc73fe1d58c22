#include "core/mesh/leaf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "core/base/det_math.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

// How much a blade's edge rises above its midrib, as a share of the distance.
constexpr float kFold = 0.35f;

// A place along a blade, and half its width there as a share of the widest.
struct Station {
  float along;
  float half_width;
};
constexpr std::array<Station, 2> kStations = {{{0.3f, 0.45f}, {0.62f, 0.42f}}};

// Adds one blade to a mesh, turned in the plane of the leaf.
class BladeWriter {
 public:
  BladeWriter(float width, double turn_deg, Mesh* mesh)
      : width_(width), mesh_(*mesh) {
    const double turn = turn_deg * std::numbers::pi / 180;
    cosine_ = static_cast<float>(DetCos(turn));
    sine_ = static_cast<float>(DetSin(turn));
  }

  void Write() {
    const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
    Vertex({0, 0}, 0);
    for (const Station& station : kStations) {
      for (const float side : {1.0f, 0.0f, -1.0f}) Vertex(station, side);
    }
    Vertex({1, 0}, 0);
    // Left, midrib and right of the two stations, between base and tip.
    constexpr std::array<std::uint32_t, 24> kTriangles = {
        0, 2, 1, 0, 3, 2, 1, 2, 5, 1, 5, 4, 2, 3, 6, 2, 6, 5, 4, 5, 7, 5, 6, 7};
    for (const std::uint32_t corner : kTriangles) {
      mesh_.indices.push_back(base + corner);
    }
  }

 private:
  // `side`: 1 the left edge, 0 the midrib, -1 the right edge.
  void Vertex(const Station& station, float side) {
    const float across = side * station.half_width * width_;
    const Float3 position = {station.along, across, kFold * std::fabs(across)};
    const Float3 normal = Normalized({0, -side * kFold, 1});
    mesh_.positions.push_back(Turned(position));
    mesh_.normals.push_back(Turned(normal));
    mesh_.uvs.push_back({0.5f - side * station.half_width, station.along});
  }

  Float3 Turned(const Float3& p) const {
    return {cosine_ * p.x - sine_ * p.y, sine_ * p.x + cosine_ * p.y, p.z};
  }

  const float width_;
  Mesh& mesh_;
  float cosine_;
  float sine_;
};

}  // namespace

Mesh MakeLeafMesh(const LeafShape& shape) {
  Mesh mesh;
  const int gaps = std::max(shape.blades - 1, 1);
  for (int blade = 0; blade < shape.blades; ++blade) {
    const double turn_deg =
        shape.blades == 1
            ? 0
            : shape.spread_deg * (static_cast<double>(blade) / gaps - 0.5);
    BladeWriter(static_cast<float>(shape.width), turn_deg, &mesh).Write();
  }
  return mesh;
}

Quaternion LeafRotation(Float3 direction, Float3 normal) {
  // The columns of the rotation's matrix; from the largest of the quaternion's
  // parts, whose square is at least a quarter.
  const Float3 x = direction;
  const Float3 z = normal;
  const Float3 y = Cross(z, x);
  const std::array<float, 4> squares = {
      1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z,
      1 + x.x + y.y + z.z};
  const auto largest = static_cast<std::size_t>(
      std::max_element(squares.begin(), squares.end()) - squares.begin());
  const float twice = std::sqrt(squares[largest]);
  const float part = 0.5f * twice;
  const float rest = 0.5f / twice;
  switch (largest) {
    case 0:
      return {part, rest * (x.y + y.x), rest * (z.x + x.z), rest * (y.z - z.y)};
    case 1:
      return {rest * (x.y + y.x), part, rest * (y.z + z.y), rest * (z.x - x.z)};
    case 2:
      return {rest * (z.x + x.z), rest * (y.z + z.y), part, rest * (x.y - y.x)};
    default:
      return {rest * (y.z - z.y), rest * (z.x - x.z), rest * (x.y - y.x), part};
  }
}

}  // namespace terrane::core
