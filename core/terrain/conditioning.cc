#include "core/terrain/conditioning.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "core/base/violations.h"
#include "core/terrain/ancestor_weights.h"
#include "core/terrain/displacement_draw.h"
#include "core/terrain/gram_system.h"
#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

// Observation errors are drawn from streams of their own, by the level of the
// spot.
constexpr std::uint32_t kObservationStream = 1u << 17;

// A solution is refused when a spot is missed by more than this (sigma = 1):
// what the lattice's float arithmetic loses anyway.
constexpr double kLargestResidual = 1e-6;

// Spots between two looks at the stop token.
constexpr std::size_t kSpotsBetweenPolls = 32;

// Shares of the progress bar.
constexpr double kWalked = 0.3;
constexpr double kSolved = 0.9;

struct PointHash {
  std::size_t operator()(const LatticePoint& point) const {
    return Mix64(static_cast<std::uint64_t>(point.x) * 0x9E3779B97F4A7C15ull ^
                 static_cast<std::uint64_t>(point.y));
  }
};

// About how many ancestors of one level a spot has.
double AncestorsPerLevel(FractalSource source, int dimensions) {
  if (dimensions == 1) return 4;
  switch (source) {
    case FractalSource::kMidpoint:
      return 13;
    case FractalSource::kSuccessive:
      return 26;
    case FractalSource::kSubdivision:
      return 60;
  }
  return 60;
}

// A displacement: the half step and the point.
struct AncestorKey {
  std::uint32_t slot = 0;
  LatticePoint point;
};

// What one displacement means to one spot.
struct Term {
  AncestorKey key;
  int level = 0;
  bool own = false;      // no other spot depends on it
  double amount = 0;     // weight times deviation
  double deviation = 0;  // standard deviation of the displacement
};

// Standard normal draws of one displacement after the other: those of a row
// share a key.
class Draws {
 public:
  explicit Draws(const ConditionedProcess& process) : process_(process) {}

  double At(const AncestorKey& key, int level) {
    if (key.slot != slot_ || key.point.y != row_) {
      slot_ = key.slot;
      row_ = key.point.y;
      row_key_ = MakeRowKey(
          StreamKey(process_.seed,
                    process_.dimensions == 1 ? LineStream(level) : key.slot),
          row_);
    }
    return static_cast<double>(
        NormalFromBits(HashLane(ColumnWord(key.point.x), row_key_)));
  }

 private:
  const ConditionedProcess& process_;
  std::uint32_t slot_ = std::numeric_limits<std::uint32_t>::max();
  std::int64_t row_ = 0;
  RowKey row_key_ = {0, 0};
};

// A displacement that several spots share: a column of W. There are up to 10^7.
struct SharedAncestor {
  LatticePoint point;
  std::uint32_t slot = 0;
  float deviation = 0;

  int level() const { return static_cast<int>(slot / 2); }
};

// Standard deviations of the displacements around one spot, a level at a time.
class LevelDeviations {
 public:
  explicit LevelDeviations(const ConditionedProcess& process)
      : process_(process) {}

  void Load(int level, const LatticeBox& box) {
    level_ = level;
    box_ = box;
    for (bool& loaded : loaded_) loaded = false;
  }

  double At(const Ancestor& ancestor) {
    if (level_ == 0) {
      return process_.flat_level0
                 ? 0.0
                 : static_cast<double>(process_.deviations->level0());
    }
    const std::int64_t odd_x = ancestor.point.x & 1;
    const std::int64_t odd_y = ancestor.point.y & 1;
    const std::size_t slot = static_cast<std::size_t>(
        4 * (ancestor.step == HalfStep::kEdge ? 1 : 0) + 2 * odd_y + odd_x);
    // First point of the box with that parity.
    const std::int64_t x0 = box_.x + ((box_.x ^ odd_x) & 1);
    const std::int64_t y0 =
        process_.dimensions == 1 ? 0 : box_.y + ((box_.y ^ odd_y) & 1);
    if (!loaded_[slot]) {
      loaded_[slot] = true;
      deviations_[slot] = process_.deviations->At(
          level_, ancestor.step, {x0, box_.columns / 2 + 1},
          {y0, process_.dimensions == 1 ? 1 : box_.rows / 2 + 1},
          &buffers_[slot], &scratch_);
    }
    const Deviation& deviation = deviations_[slot];
    if (!deviation.varies()) return static_cast<double>(deviation.uniform);
    return static_cast<double>(deviation.per_point.At(
        (ancestor.point.x - x0) / 2, (ancestor.point.y - y0) / 2));
  }

 private:
  const ConditionedProcess& process_;
  int level_ = 0;
  LatticeBox box_;
  bool loaded_[8] = {};
  Deviation deviations_[8];
  GridBuffer buffers_[8];
  DeviationModel::Scratch scratch_;
};

class Conditioner {
 public:
  Conditioner(const ConditionedProcess& process, std::span<const Spot> spots,
              const Preparation& preparation)
      : process_(process),
        spots_(spots),
        preparation_(preparation),
        walk_(process.source, process.dimensions, process.mirror),
        deviations_(process),
        draws_(process),
        builder_(process.mirror, process.dimensions) {}

  absl::StatusOr<CorrectionTable> Run();

 private:
  bool Poll(std::size_t k, double from, double to);
  void FindOwnLevels();
  void FindHeldPoints();
  template <typename Visit>
  void EachAncestor(std::size_t k, const Visit& visit);
  bool IsHeld(int level, LatticePoint point) const;
  std::uint32_t ColumnOf(const Term& term);
  void AddRow(std::size_t k);
  void RefuseUnlessMet(std::size_t k, double miss);
  absl::StatusOr<std::vector<double>> Solve();
  absl::StatusOr<CorrectionTable> MakeTable(const std::vector<double>& x);

  absl::Status StoppedStatus() const {
    return absl::CancelledError("preparation stopped");
  }

  const ConditionedProcess& process_;
  const std::span<const Spot> spots_;
  const Preparation& preparation_;
  AncestorWalk walk_;
  LevelDeviations deviations_;
  Draws draws_;
  std::vector<Ancestor> ancestors_;
  // From this level on a spot shares no ancestor with another.
  std::vector<int> own_level_;
  // SUCCESSIVE: spots stay where they are from their own level on.
  std::vector<absl::flat_hash_set<LatticePoint, PointHash>> held_;  // by level

  GramMatrix gram_;
  std::deque<SharedAncestor> shared_;  // by column
  std::vector<absl::flat_hash_map<LatticePoint, std::uint32_t, PointHash>>
      columns_;                 // by slot
  std::vector<double> misses_;  // P(p_k) + e_k - P_k
  CorrectionTable::Builder builder_;
  Violations violations_;
};

// False: stopped. Otherwise tells how far k is on the way from `from` to `to`.
bool Conditioner::Poll(std::size_t k, double from, double to) {
  if (k % kSpotsBetweenPolls != 0) return true;
  if (preparation_.progress) {
    preparation_.progress(from + (to - from) * static_cast<double>(k) /
                                     static_cast<double>(spots_.size()));
  }
  return !preparation_.stop.stop_requested();
}

// --- Which ancestors are shared ---------------------------------------------

void Conditioner::FindOwnLevels() {
  namespace bg = boost::geometry;
  using TreePoint = bg::model::point<double, 2, bg::cs::cartesian>;
  std::vector<TreePoint> points;
  points.reserve(spots_.size());
  for (const Spot& spot : spots_) points.emplace_back(spot.u, spot.v);
  const bg::index::rtree<TreePoint, bg::index::rstar<16>> tree(points);
  // Some more than the one asked for: the nearest along the axes may not be the
  // nearest by the Euclidean distance.
  constexpr unsigned kLookedAt = 6;
  std::vector<TreePoint> nearest;
  for (const TreePoint& point : points) {
    nearest.clear();
    tree.query(bg::index::nearest(point, kLookedAt),
               std::back_inserter(nearest));
    double distance = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (const TreePoint& other : nearest) {
      const double du = std::fabs(other.get<0>() - point.get<0>());
      const double dv = std::fabs(other.get<1>() - point.get<1>());
      if (du != 0 || dv != 0) distance = std::min(distance, std::max(du, dv));
      farthest = std::max(farthest, std::sqrt(du * du + dv * dv));
    }
    if (nearest.size() == kLookedAt) {
      // Those not looked at are at least that far along an axis.
      distance = std::min(distance, farthest * std::sqrt(0.5));
    }
    int level = 0;
    const double apart = AncestorWalk::Separation(process_.source);
    while (level <= kMaxLevel && std::ldexp(apart, -level) > distance) ++level;
    own_level_.push_back(level);
  }
}

void Conditioner::FindHeldPoints() {
  if (process_.source != FractalSource::kSuccessive) return;
  for (const Spot& spot : spots_) {
    if (spot.standard_error != 0) continue;  // as SpotPins has it
    const auto level = static_cast<std::size_t>(spot.level);
    if (held_.size() <= level) held_.resize(level + 1);
    held_[level].insert(spot.point);
  }
}

// Whether the displacement of `point` at `level` is kept at 0 by the lattice.
bool Conditioner::IsHeld(int level, LatticePoint point) const {
  if (held_.empty()) return false;
  int first = level;
  while (first > 0 && (point.x & 1) == 0 && (point.y & 1) == 0) {
    point = {point.x / 2, point.y / 2};
    --first;
  }
  const auto slot = static_cast<std::size_t>(first);
  return first < level && slot < held_.size() && held_[slot].contains(point);
}

template <typename Visit>
void Conditioner::EachAncestor(std::size_t k, const Visit& visit) {
  walk_.Start(spots_[k].level, spots_[k].point);
  while (walk_.Next(&ancestors_)) {
    const int level = walk_.level();
    deviations_.Load(level, walk_.box());
    const bool own = level >= own_level_[k];
    for (const Ancestor& ancestor : ancestors_) {
      const double deviation = deviations_.At(ancestor);
      if (deviation == 0 || IsHeld(level, ancestor.point)) continue;
      visit(Term{{HalfStepSlot(level, ancestor.step), ancestor.point},
                 level,
                 own,
                 ancestor.weight * deviation,
                 deviation});
    }
  }
}

// --- The system -------------------------------------------------------------

std::uint32_t Conditioner::ColumnOf(const Term& term) {
  if (columns_.size() <= term.key.slot) columns_.resize(term.key.slot + 1);
  const auto [place, fresh] = columns_[term.key.slot].try_emplace(
      term.key.point, static_cast<std::uint32_t>(shared_.size()));
  if (fresh) {
    shared_.push_back(
        {term.key.point, term.key.slot, static_cast<float>(term.deviation)});
  }
  return place->second;
}

void Conditioner::AddRow(std::size_t k) {
  const Spot& spot = spots_[k];
  double own_variance = 0;
  double variance = 0;
  double value = 0;
  EachAncestor(k, [&](const Term& term) {
    variance += term.amount * term.amount;
    value += term.amount * draws_.At(term.key, term.level);
    if (term.own) {
      own_variance += term.amount * term.amount;
      builder_.Announce(term.key.slot, term.level, term.key.point);
    } else {
      gram_.Append(ColumnOf(term), term.amount);
    }
  });
  double error = 0;
  if (spot.nugget > 0) {
    error = std::sqrt(spot.nugget) *
            static_cast<double>(DisplacementDraw(
                process_.seed,
                kObservationStream + static_cast<std::uint32_t>(spot.level),
                spot.point.x, spot.point.y));
  }
  const double miss = value + error - spot.fractal;
  // A row that nothing moves is met, or refused; it asks for nothing.
  const bool fixed = variance == 0;
  if (fixed && spot.nugget == 0) RefuseUnlessMet(k, miss);
  gram_.EndRow(own_variance + (fixed ? 1 : spot.nugget));
  misses_.push_back(fixed ? 0 : miss);
}

void Conditioner::RefuseUnlessMet(std::size_t k, double miss) {
  if (std::fabs(miss) <= kLargestResidual) return;
  violations_.Add(spots_[k].row.Path(),
                  "must have the height that is there already: the point is a "
                  "post of the refined model or has no detail; got " +
                      NumberText(spots_[k].height));
}

absl::StatusOr<std::vector<double>> Conditioner::Solve() {
  std::vector<GramPlace> places;
  places.reserve(spots_.size());
  for (const Spot& spot : spots_) {
    places.push_back({spot.u, spot.v});
  }
  Preparation part = preparation_;
  if (preparation_.progress) {
    part.progress = [&](double fraction) {
      preparation_.progress(kWalked + (kSolved - kWalked) * fraction);
    };
  }
  absl::StatusOr<GramSolution> solution = SolveGram(
      gram_, shared_.size(), places, process_.roughness, misses_, part);
  if (!solution.ok()) return solution.status();
  if (!(solution->worst_residual <= kLargestResidual)) {
    const Spot& worst = spots_[solution->worst_row];
    return ViolationError(
        worst.row.Path(),
        "must be met together with its neighbours, which double precision "
        "cannot: they are too close together for their heights; got " +
            NumberText(worst.height));
  }
  return std::move(solution->x);
}

absl::StatusOr<CorrectionTable> Conditioner::MakeTable(
    const std::vector<double>& x) {
  std::vector<double> shared(shared_.size());
  gram_.Transposed(x, shared);
  gram_ = {};
  for (const SharedAncestor& a : shared_) {
    builder_.Announce(a.slot, a.level(), a.point);
  }
  builder_.Allocate();
  for (std::size_t column = 0; column < shared_.size(); ++column) {
    const SharedAncestor& a = shared_[column];
    builder_.Add(
        a.slot, a.level(), a.point,
        static_cast<float>(-static_cast<double>(a.deviation) * shared[column]));
  }
  for (std::size_t k = 0; k < spots_.size(); ++k) {
    if (!Poll(k, kSolved, 1)) return StoppedStatus();
    EachAncestor(k, [&](const Term& term) {
      if (!term.own) return;
      builder_.Add(term.key.slot, term.level, term.key.point,
                   static_cast<float>(-term.amount * term.deviation * x[k]));
    });
  }
  return std::move(builder_).Build();
}

absl::StatusOr<CorrectionTable> Conditioner::Run() {
  if (spots_.empty()) return CorrectionTable();
  FindOwnLevels();
  FindHeldPoints();
  std::size_t shared_levels = 0;
  for (std::size_t k = 0; k < spots_.size(); ++k) {
    shared_levels +=
        static_cast<std::size_t>(std::min(own_level_[k], spots_[k].level + 1));
  }
  // At once: growing would hold 10^8 elements twice.
  gram_.Reserve(spots_.size(),
                shared_levels * static_cast<std::size_t>(AncestorsPerLevel(
                                    process_.source, process_.dimensions)));
  for (std::size_t k = 0; k < spots_.size(); ++k) {
    if (!Poll(k, 0, kWalked)) return StoppedStatus();
    AddRow(k);
  }
  if (!violations_.empty()) return violations_.ToStatus();
  columns_ = {};  // the rows are complete; the solver takes memory of its own
  absl::StatusOr<std::vector<double>> x = Solve();
  if (!x.ok()) return x.status();
  return MakeTable(*x);
}

}  // namespace

absl::StatusOr<CorrectionTable> ConditionProcess(
    const ConditionedProcess& process, std::span<const Spot> spots,
    const Preparation& preparation) {
  return Conditioner(process, spots, preparation).Run();
}

PreparationCost ConditioningCost(FractalSource source, int dimensions,
                                 std::int64_t spots, int level) {
  // A little more than tests/bench/core_bench (prepare/spots) measures. Few
  // spots share ancestors below the twelfth level: there are too many points.
  constexpr int kSharedLevels = 12;
  constexpr double kSecondsASpot = 8e-5;
  constexpr double kSecondsAnAncestor = 5e-7;
  constexpr double kBytesASpot = 2000;
  constexpr double kBytesAnAncestor = 5;
  constexpr double kBytesASharedOne = 17;
  const auto count = static_cast<double>(spots);
  const double a_level = count * AncestorsPerLevel(source, dimensions);
  const double ancestors = a_level * (level + 1);
  const double shared = a_level * std::min(level + 1, kSharedLevels);
  return {spots, count * kSecondsASpot + ancestors * kSecondsAnAncestor,
          static_cast<std::int64_t>(count * kBytesASpot +
                                    ancestors * kBytesAnAncestor +
                                    shared * kBytesASharedOne)};
}

}  // namespace terrane::core
