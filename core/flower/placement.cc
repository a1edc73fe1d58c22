#include "core/flower/placement.h"

#include <algorithm>
#include <cmath>

namespace terrane::core {
namespace {

constexpr std::uint32_t kPlantStream = 0x464C4F57;
// What the chance of a plant as a whole is drawn as: no row has this number.
constexpr std::int64_t kWholePlant = -1;

// How far chance goes at a variation of 1.
constexpr double kPlantSize = 0.2;
constexpr double kStemStretch = 0.25;
constexpr double kPlantLean = 12;  // degrees
constexpr double kStageShift = 0.35;
constexpr double kPetalAngle = 9;
constexpr double kPetalAzimuth = 8;
constexpr double kPetalSwirl = 7;
constexpr double kPetalSize = 0.1;
constexpr double kPetalWidth = 0.1;
constexpr double kLeafAngle = 20;
constexpr double kLeafSize = 0.25;
constexpr double kSolidAngle = 6;
constexpr double kSolidSize = 0.12;

// Leaflets: their lean to the side, their size, where the lowest sit.
constexpr double kLeafletAngle = 62;
constexpr double kLeafletSize = 0.85;
constexpr double kLeafletReach = 0.65;
// A stalk's radius over the stem's.
constexpr double kStalkShare = 1.0 / 3;

double Mix(double a, double b, double share) { return a + share * (b - a); }

// A frame whose y leaves the axis at an azimuth, raised by an elevation.
Turn Outwards(double azimuth, double elevation) {
  return AboutZ(azimuth - 90) * AboutX(elevation);
}

}  // namespace

// The draws of one row; `what` tells them apart.
class Placement::Chance {
 public:
  Chance(RowKey key, std::int64_t row, double variation)
      : key_(key), first_(row * 16), variation_(variation) {}

  std::uint32_t Word(int what) const {
    return HashLane(ColumnWord(first_ + what), key_);
  }
  // In [0, count).
  int Choice(int what, int count) const {
    return static_cast<int>(
        (std::uint64_t{Word(what)} * static_cast<std::uint64_t>(count)) >> 32);
  }
  // In [-1, 1).
  double Signed(int what) const { return 0x1p-31 * Word(what) - 1; }
  // The same, as far as the variation goes.
  double Varied(int what) const { return variation_ * Signed(what); }

 private:
  RowKey key_;
  std::int64_t first_;
  double variation_;
};

std::int64_t RowsOfLeaf(const FlowerSpec& spec, const LeafGroup& group) {
  return group.leaflets + (spec.stem.has_value() && group.stalk > 0 ? 1 : 0);
}

Placement::Placement(const FlowerSpec& spec, const PerlinNoise& noise)
    : spec_(spec), table_(spec) {
  if (spec.stem.has_value()) {
    for (int variant = 0; variant < spec.stem->variants; ++variant) {
      stems_.emplace_back(*spec.stem, variant, noise);
    }
    AddGroup(Kind::kStem, 0, 1);
  }
  for (std::size_t i = 0; i < spec.leaves.size(); ++i) {
    const LeafGroup& group = spec.leaves[i];
    AddGroup(Kind::kLeaves, i, group.count * RowsOfLeaf(spec, group));
  }
  for (std::size_t i = 0; i < spec.petals.size(); ++i) {
    AddGroup(Kind::kPetals, i, spec.petals[i].count);
  }
  for (std::size_t i = 0; i < spec.solids.size(); ++i) {
    AddGroup(Kind::kSolids, i, spec.solids[i].count);
  }
}

void Placement::AddGroup(Kind kind, std::size_t index, std::int64_t rows) {
  groups_.push_back({rows_, kind, index});
  rows_ += rows;
}

Plant Placement::PlantAt(std::uint32_t index) const {
  Plant plant;
  plant.index = index;
  plant.key = MakeRowKey(StreamKey(spec_.seed, kPlantStream), index);
  const Chance chance(plant.key, kWholePlant, spec_.variation);
  plant.place_m = BedPlace(index, chance);
  const double yaw =
      spec_.bed.plants > 1 ? spec_.bed.turn_deg * chance.Signed(2) : 0;
  const double lean = kPlantLean * chance.Varied(3);
  const double lean_azimuth = 180 * chance.Signed(4);
  plant.turn = AboutZ(lean_azimuth) * AboutX(lean) * AboutZ(yaw - lean_azimuth);
  plant.size = 1 + kPlantSize * chance.Varied(5);
  plant.stretch = 1 + kStemStretch * chance.Varied(6);
  plant.azimuth = 180 * chance.Signed(7);
  const double stage =
      std::clamp(spec_.stage + kStageShift * chance.Varied(8), 0.0, 1.0);
  plant.stage = StageAt(spec_.early, spec_.full, stage);
  if (spec_.stem.has_value()) {
    plant.stem =
        static_cast<std::size_t>(chance.Choice(9, spec_.stem->variants));
    const StemLine::Place tip = StemAt(plant, 1);
    plant.head = tip.position;
    plant.head_turn = FromZTo(tip.direction);
  }
  return plant;
}

Vector Placement::BedPlace(std::uint32_t index, const Chance& chance) const {
  const BedSpec& bed = spec_.bed;
  if (bed.plants == 1) return {};
  if (bed.layout == BedSpec::Layout::kVogel) {
    const double radius = bed.spacing_m * std::sqrt(static_cast<double>(index));
    const SineCosine64 at = SineCosineOf(index * Arrangement{}.divergence_deg);
    return {radius * at.cosine, radius * at.sine, 0};
  }
  const double side = std::ceil(std::sqrt(static_cast<double>(bed.plants)));
  const double row = std::floor(index / side);
  const double column = index - row * side;
  const double middle = 0.5 * (side - 1);
  const double reach = 0.5 * bed.jitter;
  return bed.spacing_m * Vector{column - middle + reach * chance.Signed(0),
                                row - middle + reach * chance.Signed(1), 0};
}

StemLine::Place Placement::StemAt(const Plant& plant, double share) const {
  if (stems_.empty()) return {{}, {0, 0, 1}};
  const StemLine::Place place = stems_[plant.stem].At(share);
  const Vector p = place.position;
  const Vector d = place.direction;
  return {{p.x, p.y, plant.stretch * p.z},
          UnitOf({d.x, d.y, plant.stretch * d.z})};
}

FlowerInstance Placement::RowOf(const Plant& plant, std::int64_t row) const {
  const auto after = std::upper_bound(
      groups_.begin(), groups_.end(), row,
      [](std::int64_t at, const Group& group) { return at < group.first_row; });
  const Group& group = *(after - 1);
  const std::int64_t in_group = row - group.first_row;
  const Chance chance(plant.key, row, spec_.variation);
  Local local;
  switch (group.kind) {
    case Kind::kStem:
      local = StemRow(plant);
      break;
    case Kind::kLeaves:
      local = LeafRow(plant, group.index, in_group, chance);
      break;
    case Kind::kPetals:
      local = PetalRow(plant, group.index, in_group, chance);
      break;
    case Kind::kSolids:
      local = SolidRow(plant, group.index, in_group, chance);
      break;
  }
  const double scale = spec_.unit_m * plant.size;
  return {local.prototype,
          ToFloat3(plant.place_m + scale * plant.turn.Of(local.place)),
          (plant.turn * local.turn).ToQuaternion(),
          ToFloat3(scale * local.scale),
          local.organ,
          static_cast<std::uint32_t>(local.n),
          plant.index};
}

Placement::Local Placement::StemRow(const Plant& plant) const {
  Local local;
  local.prototype = table_.stems + static_cast<std::uint32_t>(plant.stem);
  local.scale = {1, 1, plant.stretch};
  return local;
}

BladeChoice Placement::Choose(const BladeSpec& blade, double openness,
                              const Chance& chance) const {
  return {chance.Choice(0, static_cast<int>(blade.sketches.size())),
          chance.Choice(1, blade.variants),
          std::min(static_cast<int>(openness * blade.steps), blade.steps - 1)};
}

Placement::Local Placement::LeafRow(const Plant& plant, std::size_t index,
                                    std::int64_t row,
                                    const Chance& chance) const {
  const LeafGroup& group = spec_.leaves[index];
  const std::int64_t of_leaf = RowsOfLeaf(spec_, group);
  const std::int64_t leaf = row / of_leaf;
  const bool has_stalk = of_leaf > group.leaflets;
  const std::int64_t part = row % of_leaf - (has_stalk ? 1 : 0);
  // All parts of a leaf share its chance.
  const Chance whole(
      plant.key,
      kWholePlant - 1 - leaf - 1024 * static_cast<std::int64_t>(index),
      spec_.variation);
  const double along =
      group.count > 1 ? static_cast<double>(leaf) / (group.count - 1) : 0;
  const double share = Mix(group.from, group.to, along);
  const double stalk = has_stalk ? group.stalk * group.size : 0;
  const Turn turn =
      Outwards(plant.azimuth + static_cast<double>(leaf) * group.divergence_deg,
               group.angle_deg + kLeafAngle * whole.Varied(0));
  const double size = group.size * (1 + kLeafSize * whole.Varied(1));

  Local local;
  local.n = leaf + 1;
  local.place = StemAt(plant, share).position;
  local.turn = turn;
  if (part < 0) {
    const double radius = kStalkShare * StemRadius(*spec_.stem, share);
    local.prototype = table_.stalk;
    local.scale = {radius, stalk, radius};
    return local;
  }
  local.organ = FlowerOrgan::kLeaf;
  local.prototype = table_.leaves[index] +
                    BladeIndex(group.blade, Choose(group.blade, 1, chance));
  const std::int64_t pair = (part + 1) / 2;
  const double pairs = (group.leaflets - 1) / 2;
  const double at =
      1 - kLeafletReach * static_cast<double>(pair) / (pairs + 0.5);
  local.place = local.place + turn.Of({0, stalk * (pair == 0 ? 1 : at), 0});
  const double side = part % 2 == 1 ? 1 : -1;
  if (pair > 0) local.turn = turn * AboutZ(side * kLeafletAngle);
  const double own = pair == 0 ? size : kLeafletSize * size;
  local.scale = {own, own, own};
  return local;
}

Placement::Local Placement::PetalRow(const Plant& plant, std::size_t index,
                                     std::int64_t row,
                                     const Chance& chance) const {
  const PetalGroup& group = spec_.petals[index];
  const int n = static_cast<int>(row) + 1;
  const Seat seat =
      SeatOf(group.arrangement, n, group.count, plant.stage.spread);
  const double openness =
      Openness(plant.stage, group.arrangement.kind, seat.rank, group.count);
  const double azimuth = seat.azimuth_deg + kPetalAzimuth * chance.Varied(2);
  const double angle = Mix(group.angle_deg, group.open_angle_deg, openness) +
                       kPetalAngle * chance.Varied(3);
  const double swirl = group.swirl_deg + kPetalSwirl * chance.Varied(4);
  const double size = plant.stage.size *
                      Mix(group.inner_size, group.outer_size, seat.share) *
                      (1 + kPetalSize * chance.Varied(5));
  const SineCosine64 at = SineCosineOf(seat.azimuth_deg);

  Local local;
  local.prototype =
      table_.petals[index] +
      BladeIndex(group.blade, Choose(group.blade, openness, chance));
  local.organ = group.organ;
  local.n = n;
  local.place =
      plant.head + plant.stage.size *
                       plant.head_turn.Of({seat.radius * at.cosine,
                                           seat.radius * at.sine, seat.height});
  local.turn = plant.head_turn * Outwards(azimuth, angle) * AboutY(swirl);
  local.scale = size * Vector{1 + kPetalWidth * chance.Varied(6), 1,
                              1 + kPetalWidth * chance.Varied(7)};
  return local;
}

Placement::Local Placement::SolidRow(const Plant& plant, std::size_t index,
                                     std::int64_t row,
                                     const Chance& chance) const {
  const SolidGroup& group = spec_.solids[index];
  const int n = static_cast<int>(row) + 1;
  const Seat seat =
      SeatOf(group.arrangement, n, group.count, plant.stage.spread);
  const double angle =
      Mix(group.inner_angle_deg, group.outer_angle_deg, seat.share) +
      kSolidAngle * chance.Varied(2);
  const double size = plant.stage.size *
                      Mix(group.inner_size, group.outer_size, seat.share) *
                      (1 + kSolidSize * chance.Varied(3));
  const SineCosine64 at = SineCosineOf(seat.azimuth_deg);

  Local local;
  local.prototype = table_.solids[index];
  local.organ = group.organ;
  local.n = n;
  local.place =
      plant.head + plant.stage.size *
                       plant.head_turn.Of({seat.radius * at.cosine,
                                           seat.radius * at.sine, seat.height});
  local.turn = plant.head_turn * Outwards(seat.azimuth_deg, angle);
  local.scale = {size, size, size};
  return local;
}

}  // namespace terrane::core
