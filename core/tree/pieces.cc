#include "core/tree/pieces.h"

#include <algorithm>
#include <cmath>

namespace terrane::core {
namespace {

// Raises the direction, or lowers it where `lift` is negative.
Pose Lifted(const Pose& pose, float lift) {
  const Float3 d = pose.direction;
  const float level = std::sqrt(d.x * d.x + d.y * d.y);
  const Float3 direction = Normalized(d + lift * level * Float3{0, 0, 1});
  const Float3 right = pose.right - Dot(pose.right, direction) * direction;
  return {direction, Normalized(right)};
}

}  // namespace

Pieces::Place Pieces::At(float position) const {
  const float scaled = position * static_cast<float>(count);
  const std::size_t piece =
      std::min(static_cast<std::size_t>(scaled), count - 1);
  return {piece, scaled - static_cast<float>(piece)};
}

Float3 Pieces::Point(const Place& place) const {
  const Float3 start = points[place.piece];
  return start + place.along * (points[place.piece + 1] - start);
}

void ShapeBranch(const Branch& branch, const BendingSpec& bending,
                 Pieces* pieces) {
  const auto count = static_cast<float>(bending.pieces);
  const float supple =
      1.0f - static_cast<float>(bending.stiffness) * std::sqrt(branch.pipes);
  const float gravity = supple * static_cast<float>(bending.gravity);
  const float light = supple * static_cast<float>(bending.light);
  const float length = branch.length / count;
  pieces->count = static_cast<std::size_t>(bending.pieces);
  pieces->points[0] = branch.start;
  Pose pose = branch.pose;
  for (std::size_t k = 0; k < pieces->count; ++k) {
    if (k > 0) {
      const float along = static_cast<float>(k) / count;
      pose = Lifted(pose,
                    2.0f * (light * along - gravity * (1.0f - along)) / count);
    }
    pieces->poses[k] = pose;
    pieces->points[k + 1] = pieces->points[k] + length * pose.direction;
  }
}

Pose Deviate(const Pose& pose, SineCosine deviation, SineCosine azimuth) {
  const Float3 front = Cross(pose.direction, pose.right);
  // Unit vectors across the parent: in the plane of the turn, and its axis.
  const Float3 across = azimuth.cosine * pose.right + azimuth.sine * front;
  const Float3 axis = azimuth.cosine * front - azimuth.sine * pose.right;
  const Float3 turned =
      deviation.cosine * across - deviation.sine * pose.direction;
  return {deviation.cosine * pose.direction + deviation.sine * across,
          azimuth.cosine * turned - azimuth.sine * axis};
}

}  // namespace terrane::core
