// What a tree's form says of the children of one branch: how many, where, how
// long, turned how.
//
// A rule is prepared once from a spec: tables by code, thresholds. Immutable,
// safe from any thread. The members given to PlanGenetic and PlanCantor are the
// first of the population that the operators bred for the branch's children.
//
// Source: Wu & Zhou 2008, sections 2.1 (plain), 2.3 (genetic), 5 (Cantor). The
// printed w1 has a wrong sign (its determinant is cos 2 theta, singular at 45
// degrees) and prints a length where the ratio s belongs; with the maps mended,
//   w1(x, y) = (s( x cos + y sin), s(-x sin + y cos) + a)   right
//   w2(x, y) = (s( x cos - y sin), s( x sin + y cos) + a)   left
//
// Radii follow the pipe model, split from the base up: r^Delta is conserved at
// every node. At a lateral i of a monopodial branch
//   r_i^Delta = r_rem^Delta w_i / (w_axis + sum of w_j, j >= i)
// where r_rem is the axis below the node, w are lengths and w_axis is the
// branch's own; all the way up that gives each its share w / (w_axis + sum of
// all w). A lateral is shorter than its axis, so it is nowhere thicker. A
// leader has the axis' share. A sympodial branch ends in its children: w_axis
// is 0.
#ifndef TERRANE_CORE_TREE_GROWTH_RULE_H_
#define TERRANE_CORE_TREE_GROWTH_RULE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/tree/branch.h"
#include "core/tree/draws.h"
#include "core/tree/tree_spec.h"
#include "core/tree/turn_table.h"

namespace terrane::core {

class GrowthRule {
 public:
  explicit GrowthRule(const TreeSpec& spec);

  // Generation 0. Its key is the seed's.
  Branch Trunk() const;

  // Whether the operators breed a population for a branch's children.
  bool Breeds() const { return breeds_; }

  // Children whose chromosomes a branch's plan needs.
  std::size_t MembersNeeded(std::uint32_t chromosome) const;

  // `members` has MembersNeeded of them. Children that will not grow are not
  // turned: of them the plan says only how the parent's pipes split.
  void Plan(const Branch& branch, const BranchDraws& draws,
            std::span<const std::uint32_t> members, bool will_grow,
            ChildPlan* plan) const;

 private:
  void PlanPlain(const Branch& branch, ChildPlan* plan) const;
  void PlanCantor(const Branch& branch, std::span<const std::uint32_t> members,
                  ChildPlan* plan) const;
  void PlanGenetic(const Branch& branch, const BranchDraws& draws,
                   std::span<const std::uint32_t> members, bool will_grow,
                   ChildPlan* plan) const;
  std::size_t CountOf(std::uint32_t chromosome) const;
  // Length and length code of a child at a position; false when it is too short
  // to grow.
  bool LimitLength(const Branch& parent, PlannedChild* child) const;
  void Turn(const Branch& parent, const BranchDraws& draws, std::size_t member,
            PlannedChild* child) const;

  TreeSpec spec_;
  std::uint32_t trunk_chromosome_;
  bool breeds_;
  TurnTable turns_;
  // By code: lengths (ABSOLUTE), shares of the parent's (RELATIVE, Cantor),
  // deviations, positions.
  std::array<float, kLengthCodeMax + 1> lengths_;
  std::array<SineCosine, kAngleCodeMax + 1> deviations_;
  std::array<float, kPositionCodeMax + 1> positions_;
  SineCosine plain_deviation_;
  float crown_taper_;
  float lateral_share_;
  float least_length_;
  // Half the width of the azimuth's chance part, 2^32 to a turn.
  std::int64_t azimuth_spread_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_GROWTH_RULE_H_
