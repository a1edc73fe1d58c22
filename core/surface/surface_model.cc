#include "core/surface/surface_model.h"

#include <algorithm>
#include <cmath>

namespace terrane::core {
namespace {

Point3 UnitVector(const Point3& v) {
  // Scaled first, so that no square leaves the range of numbers.
  const double size =
      std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  const Point3 s = {v.x / size, v.y / size, v.z / size};
  const double length = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
  return {s.x / length, s.y / length, s.z / length};
}

}  // namespace

SurfaceModel::SurfaceModel(const SurfaceSpec& valid)
    : spec(valid),
      direction(UnitVector(valid.direction)),
      along_t(Basis::Of(valid.net.basis, valid.net.columns, valid.net.degree)),
      along_u(Basis::Of(valid.net.basis, valid.net.rows, valid.net.degree)),
      network(valid.network, valid.seed, 0, valid.net.columns,
              valid.method == SurfaceMethod::kProducts ? valid.net.rows : 1,
              false),
      network_u(valid.network_u, valid.seed, 1, valid.net.rows, 1, true) {
  for (const Point3& point : spec.net.points) {
    const double height =
        point.x * direction.x + point.y * direction.y + point.z * direction.z;
    heights.push_back(height);
    flats.push_back({point.x - height * direction.x,
                     point.y - height * direction.y,
                     point.z - height * direction.z});
  }
}

}  // namespace terrane::core
