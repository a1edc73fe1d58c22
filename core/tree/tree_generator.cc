#include "core/tree/tree_generator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/det_math.h"
#include "core/base/violations.h"

namespace terrane::core {
namespace {

// Branches grown between two looks at the stop token: some 50 microseconds.
constexpr int kBranchesOfPoll = 128;

std::size_t PopulationRun(const Tree& tree) {
  return tree.rule().Breeds() ? tree.operators().padded_population() : 1;
}

// Appends a row; the caller fills it by the index that comes back.
std::size_t AddRow(SegmentBlock* block, bool has_extension) {
  const std::size_t row = block->parent.size();
  block->parent.emplace_back();
  block->start.emplace_back();
  block->end.emplace_back();
  block->radius_start.emplace_back();
  block->radius_end.emplace_back();
  block->flags.emplace_back();
  block->attach.emplace_back();
  block->chromosome.emplace_back();
  if (has_extension) block->extension.emplace_back();
  return row;
}

void Clear(SegmentBlock* block) {
  block->parent.clear();
  block->start.clear();
  block->end.clear();
  block->radius_start.clear();
  block->radius_end.clear();
  block->flags.clear();
  block->attach.clear();
  block->chromosome.clear();
  block->extension.clear();
  block->marks.clear();
}

}  // namespace

TreeGenerator::TreeGenerator(std::shared_ptr<const Tree> tree,
                             std::int64_t from_row, BlockSizes sizes)
    : tree_(std::move(tree)),
      spec_(tree_->spec()),
      from_row_(from_row),
      end_row_(spec_.max_segments > 0
                   ? spec_.max_segments
                   : std::numeric_limits<std::int64_t>::max()),
      sizes_(sizes),
      populations_(PopulationRun(*tree_)) {
  const Branch trunk = tree_->rule().Trunk();
  *branches_.Push() = trunk;
  if (tree_->rule().Breeds()) {
    tree_->operators().FirstPopulation(
        trunk.chromosome, BranchDraws(trunk.key),
        {populations_.Push(), tree_->operators().population()});
  }
}

absl::Status TreeGenerator::Next(std::stop_token stop, SegmentBlock* block) {
  Clear(block);
  const std::size_t most = gave_first_ ? sizes_.rows : sizes_.first_rows;
  const auto pieces = static_cast<std::size_t>(spec_.bending.pieces);
  for (int grown = 0; !done_; ++grown) {
    if (block->rows() > 0 && block->rows() + pieces > most) break;
    if (grown % kBranchesOfPoll == 0 && stop.stop_requested()) {
      return absl::CancelledError("generation stopped");
    }
    Grow(block);
  }
  if (done_ && row_ < from_row_) {
    return ViolationError("from_row", "must be in [0, " + std::to_string(row_) +
                                          "], got " +
                                          std::to_string(from_row_));
  }
  gave_first_ = true;
  return absl::OkStatus();
}

void TreeGenerator::Grow(SegmentBlock* block) {
  const Branch branch = *branches_.Front();
  branches_.Pop();
  const bool will_grow = WillGrow();
  PlanChildren(branch, will_grow);
  ShapeBranch(branch, spec_.bending, &pieces_);
  const std::int64_t first_row = row_;
  const bool whole = WriteRows(branch, block);
  if (whole) {
    if (will_grow) {
      QueueChildren(branch, first_row);
    } else {
      next_is_partial_ = true;
    }
    if (--left_in_generation_ == 0) EndGeneration(block);
  }
  if (row_ == end_row_) done_ = true;
}

bool TreeGenerator::WillGrow() const {
  return generation_ < spec_.depth &&
         row_ + spec_.bending.pieces +
                 static_cast<std::int64_t>(branches_.size()) <
             end_row_;
}

void TreeGenerator::PlanChildren(const Branch& branch, bool will_grow) {
  const GrowthRule& rule = tree_->rule();
  const BranchDraws draws(branch.key);
  if (!rule.Breeds()) {
    rule.Plan(branch, draws, {}, will_grow, &plan_);
    return;
  }
  const Operators& operators = tree_->operators();
  if (branch.opens_family) {
    operators.Select({populations_.Front(), operators.population()},
                     &survivors_);
    populations_.Pop();
  }
  const std::size_t needed = rule.MembersNeeded(branch.chromosome);
  const std::size_t members =
      will_grow ? std::max(needed, operators.population()) : needed;
  operators.Breed(survivors_, branch.chromosome, draws,
                  will_grow ? GenesBred::kAll : GenesBred::kLengthAndSide,
                  members, members_.data());
  rule.Plan(branch, draws, {members_.data(), needed}, will_grow, &plan_);
}

bool TreeGenerator::WriteRows(const Branch& branch, SegmentBlock* block) {
  const bool is_solid = spec_.dimensions == 3;
  const float base = RadiusOfPipes(branch.pipes);
  const float tip = RadiusOfPipes(branch.pipes * plan_.tip_pipes);
  const auto count = static_cast<float>(pieces_.count);
  for (std::size_t k = 0; k < pieces_.count; ++k) {
    if (row_ == end_row_) return false;
    const std::int64_t row = row_++;
    if (row < from_row_) continue;
    if (block->rows() == 0) {
      block->first_row = row;
      block->first_generation = generation_;
    }
    const bool is_last = k + 1 == pieces_.count;
    const std::size_t at = AddRow(block, is_solid);
    block->parent[at] =
        k == 0 ? branch.parent_row : static_cast<std::uint32_t>(row - 1);
    block->start[at] = pieces_.points[k];
    block->end[at] = pieces_.points[k + 1];
    block->radius_start[at] =
        base + (tip - base) * (static_cast<float>(k) / count);
    block->radius_end[at] =
        is_last ? tip
                : base + (tip - base) * (static_cast<float>(k + 1) / count);
    block->flags[at] = static_cast<std::uint8_t>(
        branch.flags | (is_last ? 0 : kContinuedFlag) |
        (plan_.count == 0 ? kTerminalFlag : 0));
    block->attach[at] = k == 0 ? branch.attach : 1.0f;
    block->chromosome[at] = branch.chromosome;
    if (is_solid) block->extension[at] = branch.extension;
  }
  return true;
}

void TreeGenerator::QueueChildren(const Branch& branch,
                                  std::int64_t first_row) {
  for (std::size_t i = 0; i < plan_.count; ++i) {
    const PlannedChild& planned = plan_.children[i];
    const Pieces::Place place = pieces_.At(planned.position);
    Branch* child = branches_.Push();
    child->key = ChildKey(branch.key, planned.index);
    child->start = pieces_.Point(place);
    child->pose =
        Deviate(pieces_.poses[place.piece], planned.deviation, planned.azimuth);
    child->length = planned.length;
    child->pipes = branch.pipes * planned.pipes;
    child->attach = place.along;
    child->parent_row = static_cast<std::uint32_t>(
        first_row + static_cast<std::int64_t>(place.piece));
    child->chromosome = planned.chromosome;
    child->extension = planned.extension;
    child->flags = planned.flags;
    child->opens_family = i == 0;
  }
  if (plan_.count > 0 && tree_->rule().Breeds()) {
    std::copy_n(members_.begin(), tree_->operators().padded_population(),
                populations_.Push());
  }
}

void TreeGenerator::EndGeneration(SegmentBlock* block) {
  if (row_ > from_row_ && !is_partial_) {
    block->marks.push_back({generation_, row_});
  }
  is_partial_ = std::exchange(next_is_partial_, false);
  ++generation_;
  left_in_generation_ = branches_.size();
  if (left_in_generation_ == 0) done_ = true;
}

float TreeGenerator::RadiusOfPipes(float pipes) const {
  const auto trunk = static_cast<float>(*spec_.trunk_radius);
  if (spec_.pipe_exponent == 2) return trunk * std::sqrt(pipes);
  return trunk * static_cast<float>(DetPow(static_cast<double>(pipes),
                                           1 / spec_.pipe_exponent));
}

}  // namespace terrane::core
