// The shape of one branch: a straight segment, or a polyline that gravity and
// light bend.
//
// Gravity bends most at the base, where the weight bears; light most at the
// tip, which is youngest. Both act on the level part of the direction, so that
// an upright branch stays upright; a thick branch may be stiffer than a thin
// one. Pure functions in float32; the same bits
// everywhere.
#ifndef TERRANE_CORE_TREE_PIECES_H_
#define TERRANE_CORE_TREE_PIECES_H_

#include <array>
#include <cstddef>

#include "core/tree/branch.h"
#include "core/tree/tree_spec.h"
#include "core/tree/validate.h"

namespace terrane::core {

struct Pieces {
  std::size_t count = 0;
  // Piece k runs from points[k] to points[k + 1] in the direction of poses[k].
  std::array<Float3, kMaxPieces + 1> points;
  std::array<Pose, kMaxPieces> poses;

  // A position along the whole branch as a piece and a position along it.
  struct Place {
    std::size_t piece = 0;
    float along = 0;
  };
  Place At(float position) const;
  Float3 Point(const Place& place) const;
};

void ShapeBranch(const Branch& branch, const BendingSpec& bending,
                 Pieces* pieces);

// The pose of a child: turned away from `pose` by its deviation, in the plane
// that its azimuth names, and not twisted. For azimuths of 0 and a half turn
// these are the linear parts of the paper's maps.
Pose Deviate(const Pose& pose, SineCosine deviation, SineCosine azimuth);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_PIECES_H_
