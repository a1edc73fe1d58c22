#include "core/tree/tree.h"

#include "core/base/violations.h"

namespace terrane::core {
namespace {

// A trunk is this many times as long as its radius at the base.
constexpr double kTrunkSlenderness = 20;

TreeSpec Resolved(TreeSpec spec) {
  if (!spec.trunk_radius.has_value()) {
    spec.trunk_radius = spec.trunk_length / kTrunkSlenderness;
  }
  return spec;
}

}  // namespace

Tree::Tree(const TreeSpec& spec)
    : spec_(Resolved(spec)),
      estimate_(EstimateTree(spec)),
      rule_(spec),
      operators_(spec.genetic) {}

absl::StatusOr<std::shared_ptr<const Tree>> Tree::Create(
    const TreeSpec& spec, const TreeLimits& limits) {
  Violations violations;
  ValidateTreeSpec(spec, limits, "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  return std::shared_ptr<const Tree>(new Tree(spec));
}

}  // namespace terrane::core
