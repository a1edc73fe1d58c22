// Tree: a spec made ready to grow from.
//
// A Tree is immutable and thread-safe; share it by shared_ptr<const Tree>. A
// TreeGenerator (core/tree/tree_generator.h) grows it, row by row.
//
// Determinism: a row is a pure function of (spec, row index). It does not
// depend on the blocks that it was asked in, on the thread, the SIMD target or
// the build type; nor on the depth, which only says where the rows end: the
// rows of depth d are the first rows of depth d + 1.
//
// Source: Wu & Zhou 2008.
#ifndef TERRANE_CORE_TREE_TREE_H_
#define TERRANE_CORE_TREE_TREE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "core/tree/estimate.h"
#include "core/tree/growth_rule.h"
#include "core/tree/operators.h"
#include "core/tree/tree_spec.h"
#include "core/tree/validate.h"

namespace terrane::core {

class Tree {
 public:
  // Validates the spec and prepares tables. Errors: INVALID_ARGUMENT with
  // violations (field paths relative to the recipe, such as "depth").
  static absl::StatusOr<std::shared_ptr<const Tree>> Create(
      const TreeSpec& spec, const TreeLimits& limits = {});

  // With trunk_radius filled in.
  const TreeSpec& spec() const { return spec_; }
  const TreeEstimate& estimate() const { return estimate_; }
  const GrowthRule& rule() const { return rule_; }
  const Operators& operators() const { return operators_; }

 private:
  explicit Tree(const TreeSpec& spec);

  TreeSpec spec_;
  TreeEstimate estimate_;
  GrowthRule rule_;
  Operators operators_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_TREE_H_
