#include "core/terrain/spec_checks.h"

#include <string>

namespace terrane::core {

bool SpecChecks::Coordinates(const Path& point, const Point2& value) {
  bool good = Number(point.Field("x"), value.x, kCoordinates);
  if (dimensions_ == 2) {
    good &= Number(point.Field("y"), value.y, kCoordinates);
  }
  return good;
}

bool SpecChecks::Vertices(const Path& path, std::span<const Point2> vertices,
                          std::size_t least) {
  bool good = Count(path.Field("vertices"), vertices.size(), least,
                    static_cast<std::size_t>(limits_.max_vertices));
  if (!SpendVertices(path.Field("vertices"), vertices.size())) return false;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    good &= Coordinates(path.Element("vertices", i), vertices[i]);
  }
  return good;
}

bool SpecChecks::SpendVertices(const Path& path, std::size_t count) {
  const std::size_t most = static_cast<std::size_t>(limits_.max_vertices);
  const bool was_within = vertices_ <= most;
  vertices_ += count;
  if (vertices_ <= most) return true;
  // Named once, at the list that goes over the limit.
  if (was_within) {
    Violate(path, "the vertices of a whole recipe must be at most " +
                      std::to_string(most) + ", got " +
                      std::to_string(vertices_) + " up to here");
  }
  return false;
}

}  // namespace terrane::core
