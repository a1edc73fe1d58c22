// Which displacements P_fbm of a lattice point is made of, and with what
// weight.
//
// P is linear in independent displacements, P(p) = sum_a w_a(p) A_a, and few
// ancestors a have a weight: about 60 a level for SUBDIVISION, 12 for MIDPOINT.
// The walk is the transpose of refining: it starts with weight 1 at p and, from
// p's level up to level 0, hands each weight on to the points that the stencil
// took. Weights below 2^-24 are dropped: they are below the rounding of the
// floats that the lattice adds up.
//
// Weights do not depend on H, seed or deviations. Indices are those inside the
// domain (mirrored); every displacement occurs once. Threads: an AncestorWalk
// belongs to one thread. Determinism: double arithmetic in a fixed order.
//
// Source: docs/terrain.md, "Spot heights"; Tan & Chen 2003, eqs. 5 and 12, for
// the stencils.
#ifndef TERRANE_CORE_TERRAIN_ANCESTOR_WEIGHTS_H_
#define TERRANE_CORE_TERRAIN_ANCESTOR_WEIGHTS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/terrain/discrete_constraints.h"
#include "core/terrain/displacement.h"
#include "core/terrain/mirror.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

struct Ancestor {
  HalfStep step = HalfStep::kEdge;  // level 0 and lines: always
  LatticePoint point;               // in indices of the walk's level
  double weight = 0;
};

// A rectangle of lattice points.
struct LatticeBox {
  std::int64_t x = 0, y = 0;
  int columns = 0, rows = 0;
};

class AncestorWalk {
 public:
  AncestorWalk(FractalSource source, int dimensions, Mirror mirror);

  // Begins at a point of `level`.
  void Start(int level, LatticePoint point);

  // Fills `ancestors` with the displacements of the current level, which hold
  // inside box(), and goes one level up. False: level 0 is done.
  bool Next(std::vector<Ancestor>* ancestors);

  // Of the ancestors that Next filled in last.
  int level() const { return level_; }
  const LatticeBox& box() const { return box_; }

  // The farthest that an ancestor of level n lies from the point, along an
  // axis, in spacings of level n.
  static double Radius(FractalSource source);

  // Points this far apart along an axis (spacings of level n) have no common
  // ancestor of level n that counts: the products of their weights sum up to
  // less than 2^-28.
  static double Separation(FractalSource source);

 private:
  // Weights of the points of a box, row-major.
  struct Weights {
    LatticeBox box;
    std::vector<double> values;
  };

  void Level0(std::vector<Ancestor>* ancestors);
  void OpenLevel();
  void CloseLevel();
  void Add(std::int64_t x, std::int64_t y, double weight);
  std::size_t IndexOf(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>((y - work_.box.y) * work_.box.columns +
                                    (x - work_.box.x));
  }
  void PushEdge(std::int64_t x, std::int64_t y, double weight);
  void PushBorderEdge(std::int64_t x, std::int64_t y, double weight);
  void PushCentre(std::int64_t x, std::int64_t y, double weight);
  bool OnBorder(std::int64_t x, std::int64_t y) const;
  void Edges(std::vector<Ancestor>* ancestors);
  void Centres(std::vector<Ancestor>* ancestors);
  void Line(std::vector<Ancestor>* ancestors);

  const FractalSource source_;
  const int dimensions_;
  const Mirror mirror_;
  const std::int64_t reach_;  // of one stencil, in child points
  // The stencil's taps as steps in work_, for points that no border is near.
  struct Taps {
    std::array<std::ptrdiff_t, 16> steps;
    std::array<double, 16> weights;
  };
  void AddAll(const Taps& taps, std::int64_t x, std::int64_t y, double weight);
  Taps edge_taps_, centre_taps_;
  bool inside_ = false;  // work_ lies inside the domain
  // Where the columns and rows of work_ are found in it: beyond the border, at
  // their mirror images.
  std::vector<std::size_t> columns_, row_starts_;
  int level_ = 0;  // of box_
  bool started_ = false;
  LatticeBox box_;
  Weights given_;  // what finer levels handed on, in points of the next level
  Weights work_;   // the level in hand, with room for two stencils around
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_ANCESTOR_WEIGHTS_H_
