#include "tests/core/mesh_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/mesh/float3.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

// Triangles of less shape do not show which way they face.
constexpr double kSliver = 0.05;

using Corners = std::array<Float3, 3>;

Corners CornersOf(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* corner = mesh.indices.data() + 3 * triangle;
  return {mesh.positions[corner[0]], mesh.positions[corner[1]],
          mesh.positions[corner[2]]};
}

Float3 DoubleArea(const Corners& p) { return Cross(p[1] - p[0], p[2] - p[0]); }

// (2 area) / (longest edge)^2.
double ShapeOf(const Corners& p) {
  const double area = static_cast<double>(Length(DoubleArea(p)));
  const double edge = static_cast<double>(std::max(
      {Length(p[1] - p[0]), Length(p[2] - p[1]), Length(p[0] - p[2])}));
  return edge > 0 ? area / (edge * edge) : 0;
}

bool IsFinite(Float3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

void ExpectGoodVertices(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  if (!mesh.colors.empty()) {
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  }
  for (const Float3& p : mesh.positions) ASSERT_TRUE(IsFinite(p));
  for (const Float3& n : mesh.normals) ASSERT_NEAR(Length(n), 1, 1e-3);
  for (const Float3& c : mesh.colors) {
    for (const float value : {c.x, c.y, c.z}) {
      ASSERT_GE(value, 0);
      ASSERT_LE(value, 1);
    }
  }
}

}  // namespace

std::size_t OpenEdges(const Mesh& mesh) {
  // Values, so that -0 and 0 are one place.
  std::map<std::tuple<float, float, float>, std::uint32_t> places;
  std::vector<std::uint32_t> place;
  for (const Float3& p : mesh.positions) {
    const auto next = static_cast<std::uint32_t>(places.size());
    place.push_back(
        places.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, next)
            .first->second);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = place[mesh.indices[i + k]];
      const std::uint32_t to = place[mesh.indices[i + (k + 1) % 3]];
      EXPECT_EQ(++edges[std::make_pair(from, to)], 1) << from << " " << to;
    }
  }
  return static_cast<std::size_t>(
      std::count_if(edges.begin(), edges.end(), [&](const auto& edge) {
        return edges.count({edge.first.second, edge.first.first}) == 0;
      }));
}

double LeastShape(const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) {
    least = std::min(least, ShapeOf(CornersOf(mesh, i)));
  }
  return least;
}

void ExpectGoodMesh(const Mesh& mesh, double least_facing) {
  ExpectGoodVertices(mesh);
  ASSERT_EQ(mesh.indices.size() % 3, 0u);
  for (const std::uint32_t index : mesh.indices) {
    ASSERT_LT(index, mesh.positions.size());
  }
  EXPECT_GT(LeastShape(mesh), 1e-5);
  for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) {
    if (ShapeOf(CornersOf(mesh, i)) < kSliver) continue;
    const Float3 facing = Normalized(DoubleArea(CornersOf(mesh, i)));
    Float3 normal;
    for (std::size_t k = 0; k < 3; ++k) {
      normal = normal + mesh.normals[mesh.indices[3 * i + k]];
    }
    ASSERT_GT(Dot(facing, Normalized(normal)), least_facing)
        << "triangle " << i;
  }
}

}  // namespace terrane::core
