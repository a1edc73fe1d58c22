// Placement: where the organs of every plant of a bed stand.
//
// A plant is a function of (spec, index), a row of it of (spec, plant, row):
// chance comes from hashes of (seed, plant, row), so any row can be made on its
// own. Rows of a plant: its stem, then group by group leaves (the stalk before
// its blades), petals and solids.
//
// Immutable and thread-safe; refers to the spec. Double precision, rounded to
// float32 at the end; the same bits everywhere.
#ifndef TERRANE_CORE_FLOWER_PLACEMENT_H_
#define TERRANE_CORE_FLOWER_PLACEMENT_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/flower/flower_spec.h"
#include "core/flower/growth.h"
#include "core/flower/instance_block.h"
#include "core/flower/prototypes.h"
#include "core/flower/rotation.h"
#include "core/flower/stem.h"
#include "core/noise/counter_hash.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

// What the rows of one plant have in common.
struct Plant {
  std::uint32_t index = 0;
  RowKey key = {};
  Vector place_m;      // of its root
  Turn turn;           // about it: yaw, then leaning
  double size = 1;     // of everything
  double stretch = 1;  // of the stem's height
  double azimuth = 0;  // of its first leaf, degrees
  GrowthStage stage;
  std::size_t stem = 0;  // variant
  // Of the flower head, in the plant's unit.
  Vector head;
  Turn head_turn;
};

class Placement {
 public:
  // `spec` is valid and outlives it; `noise` is read here only.
  Placement(const FlowerSpec& spec, const PerlinNoise& noise);

  std::int64_t rows_of_plant() const { return rows_; }

  Plant PlantAt(std::uint32_t index) const;
  // Row `row` of a plant, in [0, rows_of_plant()).
  FlowerInstance RowOf(const Plant& plant, std::int64_t row) const;

 private:
  enum class Kind { kStem, kLeaves, kPetals, kSolids };
  struct Group {
    std::int64_t first_row = 0;
    Kind kind = Kind::kStem;
    std::size_t index = 0;
  };
  // A row before its plant is taken into account.
  struct Local {
    std::uint32_t prototype = 0;
    FlowerOrgan organ = FlowerOrgan::kStem;
    std::int64_t n = 1;
    Vector place;
    Turn turn;
    Vector scale = {1, 1, 1};
  };
  class Chance;

  void AddGroup(Kind kind, std::size_t index, std::int64_t rows);
  Vector BedPlace(std::uint32_t index, const Chance& chance) const;
  // The stem's line at a share, stretched as the plant's.
  StemLine::Place StemAt(const Plant& plant, double share) const;
  BladeChoice Choose(const BladeSpec& blade, double openness,
                     const Chance& chance) const;

  Local StemRow(const Plant& plant) const;
  Local LeafRow(const Plant& plant, std::size_t group, std::int64_t row,
                const Chance& chance) const;
  Local PetalRow(const Plant& plant, std::size_t group, std::int64_t row,
                 const Chance& chance) const;
  Local SolidRow(const Plant& plant, std::size_t group, std::int64_t row,
                 const Chance& chance) const;

  const FlowerSpec& spec_;
  const PrototypeTable table_;
  std::vector<StemLine> stems_;
  std::vector<Group> groups_;
  std::int64_t rows_ = 0;
};

// Rows of a leaf: its blades and, where it has one, its stalk.
std::int64_t RowsOfLeaf(const FlowerSpec& spec, const LeafGroup& group);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_PLACEMENT_H_
