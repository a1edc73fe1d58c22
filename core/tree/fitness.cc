#include "core/tree/fitness.h"

#include <algorithm>
#include <cmath>

namespace terrane::core {
namespace {

constexpr int kBest = 10;
constexpr int kFitnessOfOneBranch = 5;

int Rounded(double value) { return static_cast<int>(std::floor(value + 0.5)); }

// A code of 0 to `largest`, evenly onto 0-10 in the wanted direction.
int OfCode(std::uint32_t code, std::uint32_t largest, Wanted wanted) {
  if (wanted == Wanted::kAny) return 0;
  const int up = Rounded(static_cast<double>(kBest * code) / largest);
  return wanted == Wanted::kHigh ? up : kBest - up;
}

int OfCount(std::uint32_t count, Wanted wanted) {
  if (wanted == Wanted::kAny) return 0;
  const int up = 3 * static_cast<int>(count);
  return wanted == Wanted::kHigh ? up : 9 - up;
}

int OfGap(double gap, Wanted wanted) {
  const int dense = std::clamp(Rounded(kBest * (1 - 2 * gap)), 0, kBest);
  return wanted == Wanted::kLow ? dense : kBest - dense;
}

Wanted Opposite(Wanted wanted) {
  switch (wanted) {
    case Wanted::kAny:
      return Wanted::kAny;
    case Wanted::kLow:
      return Wanted::kHigh;
    case Wanted::kHigh:
      return Wanted::kLow;
  }
  return Wanted::kAny;
}

}  // namespace

Fitness::Fitness(const GeneticSpec& spec) {
  // A dense tree has short branches at narrow angles, many, with small gaps.
  const Wanted lengths = spec.lengths.value_or(Opposite(spec.density));
  const Wanted angles = spec.angles.value_or(Opposite(spec.density));
  const Wanted counts = spec.counts.value_or(spec.density);
  const Wanted gaps = spec.gaps.value_or(Opposite(spec.density));
  for (std::uint32_t low = 0; low < length_and_angle_.size(); ++low) {
    length_and_angle_[low] = static_cast<std::uint8_t>(
        OfCode(CodeOf(low, Gene::kLength), kLengthCodeMax, lengths) +
        OfCode(CodeOf(low, Gene::kAngle), kAngleCodeMax, angles));
  }
  for (std::uint32_t high = 0; high < axis_side_and_count_.size(); ++high) {
    const std::uint32_t chromosome = high << FieldOf(Gene::kAxis).shift;
    const double axis = IsMonopodial(chromosome) ? spec.monopodial_share
                                                 : 1 - spec.monopodial_share;
    const double side =
        IsLeft(chromosome) ? spec.left_share : 1 - spec.left_share;
    axis_side_and_count_[high] = static_cast<std::uint8_t>(
        Rounded(kBest * axis) + Rounded(kBest * side) +
        OfCount(CodeOf(chromosome, Gene::kCount), counts));
  }
  counts_gaps_ = gaps != Wanted::kAny;
  if (!counts_gaps_) return;
  for (std::size_t between = 0; between < gaps_.size(); ++between) {
    for (std::size_t span = 0; span <= kPositionCodeMax; ++span) {
      const double gap = static_cast<double>(span) /
                         static_cast<double>(kPositionCodeMax * (between + 1));
      gaps_[between][span] = static_cast<std::uint8_t>(OfGap(gap, gaps));
    }
  }
}

int Fitness::Of(std::uint32_t chromosome) const {
  const int sum =
      length_and_angle_[chromosome & (length_and_angle_.size() - 1)] +
      axis_side_and_count_[chromosome >> FieldOf(Gene::kAxis).shift &
                           (axis_side_and_count_.size() - 1)];
  if (!counts_gaps_) return sum;
  const std::uint32_t count = CodeOf(chromosome, Gene::kCount);
  if (count < 2 || !IsMonopodial(chromosome)) return sum + kFitnessOfOneBranch;
  // The mean gap is the distance of the outermost over the number of gaps.
  std::uint32_t first = CodeOf(chromosome, Gene::kPosition0);
  std::uint32_t last = first;
  for (const Gene gene : {Gene::kPosition1, Gene::kPosition2}) {
    if (gene == Gene::kPosition2 && count < 3) break;
    first = std::min(first, CodeOf(chromosome, gene));
    last = std::max(last, CodeOf(chromosome, gene));
  }
  return sum + gaps_[count - 2][last - first];
}

}  // namespace terrane::core
