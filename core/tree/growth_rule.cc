#include "core/tree/growth_rule.h"

#include <algorithm>

#include "core/mesh/segment_block.h"
#include "core/tree/estimate.h"
#include "core/tree/genetic_kernels.h"
#include "core/tree/siblings.h"

namespace terrane::core {
namespace {

constexpr double kTurn = 4294967296.0;
constexpr float kCantorThird = 1.0f / 3.0f;
constexpr std::size_t kPlainChildren = 2;

constexpr SineCosine kToTheRight = {0, 1};
constexpr SineCosine kToTheLeft = {0, -1};
constexpr SineCosine kStraight = {0, 1};

// A Cantor set's ratios are 1/6 to 1/2, 1/3 in the middle.
double CantorRatio(std::uint32_t code) {
  return (1.0 + 2.0 * code / kLengthCodeMax) / 6.0;
}

std::uint8_t SideFlag(bool left) { return left ? kLeftFlag : 0; }
std::uint8_t FlagsOf(std::uint32_t chromosome) {
  const std::uint8_t axis = IsMonopodial(chromosome) ? kMonopodialFlag : 0;
  return axis | SideFlag(IsLeft(chromosome));
}

// Splits the pipes of a branch among its planned children.
void SplitPipes(float length, bool monopodial, ChildPlan* plan) {
  if (plan->count == 0) return;
  const auto leads = [](const PlannedChild& child) {
    return (child.flags & kLeaderFlag) != 0;
  };
  const float axis = monopodial ? length : 0.0f;
  float total = axis;
  for (std::size_t i = 0; i < plan->count; ++i) {
    if (!leads(plan->children[i])) total += plan->children[i].length;
  }
  const float of_length = 1.0f / total;
  for (std::size_t i = 0; i < plan->count; ++i) {
    PlannedChild* child = &plan->children[i];
    child->pipes = (leads(*child) ? axis : child->length) * of_length;
  }
  if (monopodial) plan->tip_pipes = axis * of_length;
}

}  // namespace

GrowthRule::GrowthRule(const TreeSpec& spec)
    : spec_(spec),
      trunk_chromosome_(TrunkChromosome(spec)),
      breeds_(spec.form == TreeForm::kGenetic ||
              (spec.form == TreeForm::kCantor && spec.cantor.statistical)),
      plain_deviation_(SineCosineOfDegrees(spec.plain.angle_deg)),
      crown_taper_(static_cast<float>(spec.genetic.crown_taper)),
      lateral_share_(static_cast<float>(spec.genetic.lateral_share)),
      least_length_(static_cast<float>(spec.genetic.least_length)),
      azimuth_spread_(static_cast<std::int64_t>(
          spec.genetic.azimuth_spread_deg / 360 * kTurn)) {
  const GeneticSpec& genetic = spec.genetic;
  for (std::uint32_t code = 0; code <= kPositionCodeMax; ++code) {
    positions_[code] = static_cast<float>(PositionOfCode(code));
  }
  const std::uint32_t trunk_code = CodeOf(trunk_chromosome_, Gene::kLength);
  for (std::uint32_t code = 0; code <= kLengthCodeMax; ++code) {
    const double share = static_cast<double>(code) / kLengthCodeMax;
    const double length =
        spec.form == TreeForm::kCantor ? CantorRatio(code)
        : spec.length_mode == LengthMode::kAbsolute
            ? spec.trunk_length * code / trunk_code
            : genetic.ratio_min +
                  (genetic.ratio_max - genetic.ratio_min) * share;
    lengths_[code] = static_cast<float>(length);
    deviations_[code] = SineCosineOfDegrees(
        genetic.angle_min_deg +
        (genetic.angle_max_deg - genetic.angle_min_deg) * share);
  }
}

Branch GrowthRule::Trunk() const {
  const bool lies = spec_.form == TreeForm::kCantor;
  Branch trunk;
  trunk.key = TrunkKey(spec_.seed);
  trunk.pose = lies ? Pose{{1, 0, 0}, {0, 0, -1}} : Pose{{0, 0, 1}, {1, 0, 0}};
  trunk.length = static_cast<float>(spec_.trunk_length);
  trunk.pipes = lies ? 0 : 1;
  trunk.parent_row = kNoParent;
  trunk.opens_family = true;
  if (breeds_) trunk.chromosome = trunk_chromosome_;
  if (spec_.form == TreeForm::kGenetic) trunk.flags = FlagsOf(trunk.chromosome);
  if (spec_.form == TreeForm::kPlain && spec_.plain.offset < 1) {
    trunk.flags = kMonopodialFlag;
  }
  return trunk;
}

std::size_t GrowthRule::CountOf(std::uint32_t chromosome) const {
  const std::uint32_t code = CodeOf(chromosome, Gene::kCount);
  return spec_.genetic.twigs_end ? code : std::max(1u, code);
}

std::size_t GrowthRule::MembersNeeded(std::uint32_t chromosome) const {
  if (spec_.form == TreeForm::kCantor) return kPlainChildren;
  const std::size_t count = CountOf(chromosome);
  const bool leads =
      spec_.genetic.leader && count > 0 && IsMonopodial(chromosome);
  return count + (leads ? 1 : 0);
}

void GrowthRule::Plan(const Branch& branch, const BranchDraws& draws,
                      std::span<const std::uint32_t> members, bool will_grow,
                      ChildPlan* plan) const {
  plan->Clear();
  switch (spec_.form) {
    case TreeForm::kGenetic:
      PlanGenetic(branch, draws, members, will_grow, plan);
      return;
    case TreeForm::kPlain:
      PlanPlain(branch, plan);
      return;
    case TreeForm::kCantor:
      PlanCantor(branch, members, plan);
      return;
  }
}

void GrowthRule::PlanPlain(const Branch& branch, ChildPlan* plan) const {
  const bool monopodial = spec_.plain.offset < 1;
  for (std::size_t i = 0; i < kPlainChildren; ++i) {
    const bool left = i == 1;
    PlannedChild& child = plan->children[plan->count++];
    child.index = i;
    child.flags = static_cast<std::uint8_t>(SideFlag(left) |
                                            (monopodial ? kMonopodialFlag : 0));
    child.position = static_cast<float>(spec_.plain.offset);
    child.length = static_cast<float>(spec_.plain.contraction) * branch.length;
    child.deviation = plain_deviation_;
    child.azimuth = left ? kToTheLeft : kToTheRight;
  }
  SplitPipes(branch.length, monopodial, plan);
}

void GrowthRule::PlanCantor(const Branch& branch,
                            std::span<const std::uint32_t> members,
                            ChildPlan* plan) const {
  for (std::size_t i = 0; i < kPlainChildren; ++i) {
    PlannedChild& child = plan->children[plan->count++];
    child.index = i;
    float ratio = kCantorThird;
    if (breeds_) {
      child.chromosome = members[i];
      ratio = lengths_[CodeOf(child.chromosome, Gene::kLength)];
    }
    // The left segment begins where its parent does, the right one ends there.
    const bool left = i == 0;
    child.flags = SideFlag(left);
    child.position = left ? 0.0f : 1.0f - ratio;
    child.length = ratio * branch.length;
    child.deviation = kStraight;
    child.azimuth = kToTheRight;
  }
}

bool GrowthRule::LimitLength(const Branch& parent, PlannedChild* child) const {
  const std::uint32_t code = CodeOf(child->chromosome, Gene::kLength);
  if (spec_.length_mode == LengthMode::kRelative) {
    const bool lateral =
        IsMonopodial(parent.chromosome) && (child->flags & kLeaderFlag) == 0;
    const float share =
        lateral ? lateral_share_ * (1.0f - crown_taper_ * child->position)
                : 1.0f;
    child->length = parent.length * lengths_[code] * share;
    return child->length >= least_length_;
  }
  const std::uint32_t limited = std::min(
      code, LargestChildLength(CodeOf(parent.chromosome, Gene::kLength)));
  child->chromosome = WithCode(child->chromosome, Gene::kLength, limited);
  child->length = lengths_[limited];
  return limited > 0;
}

void GrowthRule::Turn(const Branch& parent, const BranchDraws& draws,
                      std::size_t member, PlannedChild* child) const {
  const bool leads = (child->flags & kLeaderFlag) != 0;
  child->deviation =
      leads ? kStraight : deviations_[CodeOf(child->chromosome, Gene::kAngle)];
  if (spec_.dimensions == 2) {
    child->azimuth = IsLeft(child->chromosome) ? kToTheLeft : kToTheRight;
    return;
  }
  // The spiral goes on from the parent's own place in its parent's spiral; a
  // left branch winds it the other way.
  const std::uint32_t sum = DrawSum(draws.Word(member, kWordOfAzimuth),
                                    draws.Word(member, kWordOfAzimuth + 1));
  const std::int64_t chance =
      (2 * std::int64_t{sum} - kDrawSumMax) * azimuth_spread_ / kDrawSumMax;
  const std::uint32_t step =
      kGoldenTurn * (static_cast<std::uint32_t>(child->index) + 1);
  child->extension = parent.extension +
                     (IsLeft(parent.chromosome) ? 0u - step : step) +
                     static_cast<std::uint32_t>(chance);
  child->azimuth = turns_.Of(child->extension);
}

void GrowthRule::PlanGenetic(const Branch& branch, const BranchDraws& draws,
                             std::span<const std::uint32_t> members,
                             bool will_grow, ChildPlan* plan) const {
  if (members.empty()) return;
  const std::size_t laterals = CountOf(branch.chromosome);
  const SiblingPlaces siblings =
      PlaceSiblings(branch.chromosome, members.first(laterals));
  for (std::size_t i = 0; i < siblings.count; ++i) {
    const SiblingPlace& place = siblings.places[i];
    PlannedChild* child = &plan->children[plan->count];
    child->index = i;
    child->chromosome =
        WithCode(members[place.member], Gene::kSide, place.left ? 1 : 0);
    child->flags = FlagsOf(child->chromosome);
    child->position = positions_[place.position];
    if (!LimitLength(branch, child)) continue;
    if (will_grow) Turn(branch, draws, place.member, child);
    ++plan->count;
  }
  if (members.size() > laterals) {
    PlannedChild* leader = &plan->children[plan->count];
    leader->index = siblings.count;
    leader->chromosome = members[laterals];
    leader->flags = FlagsOf(leader->chromosome) | kLeaderFlag;
    leader->position = 1;
    if (LimitLength(branch, leader)) {
      if (will_grow) Turn(branch, draws, laterals, leader);
      ++plan->count;
    }
  }
  SplitPipes(branch.length, IsMonopodial(branch.chromosome), plan);
}

}  // namespace terrane::core
