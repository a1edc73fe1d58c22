// What the method promises of flowers, over many random ones: the noise's
// distribution, relief that grows with its three numbers, meshes without a
// fault, and streams that no block, thread or order changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "core/flower/blade_mesh.h"
#include "core/flower/blade_outline.h"
#include "core/noise/perlin_noise.h"
#include "tests/core/mesh_checks.h"
#include "tests/core/whole_flower.h"

namespace terrane::core {
namespace {

constexpr int kFlowers = 200 / TERRANE_REPETITION_DIVISOR;

// Chance for recipes; of tests only.
class Dice {
 public:
  explicit Dice(int seed) : random_(static_cast<unsigned>(seed)) {}
  double In(double low, double high) {
    return low + (high - low) * Whole(0, 10'000) / 10'000.0;
  }
  int Whole(int low, int high) {
    return low +
           static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }
  bool Half() { return random_() % 2 == 0; }

 private:
  std::mt19937 random_;
};

// One that makes an outline.
Sketch RandomSketch(Dice* dice) {
  for (;;) {
    Sketch sketch;
    const int points = dice->Whole(2, 3);
    for (int i = 1; i <= points; ++i) {
      sketch.points.push_back(
          {dice->In(0.03, 0.7), (i + dice->In(-0.3, 0.3)) / (points + 1)});
    }
    sketch.base = dice->Half() ? SketchEnd::kRound : SketchEnd::kPointed;
    sketch.tip = dice->Half() ? SketchEnd::kRound : SketchEnd::kPointed;
    if (BladeOutline(sketch).Fault().empty()) return sketch;
  }
}

BladeSpec RandomBlade(Dice* dice) {
  BladeSpec blade;
  for (int i = dice->Whole(1, 3); i > 0; --i) {
    blade.sketches.push_back(RandomSketch(dice));
  }
  blade.relief = {dice->In(0, 0.08), dice->In(0, 4), dice->In(0, 4),
                  dice->In(0.5, 1.5), dice->Half()};
  blade.variants = dice->Whole(1, 2);
  blade.steps = dice->Whole(1, 3);
  blade.closed = {dice->In(0, 200), dice->In(-60, 60), dice->In(-60, 60), 0};
  blade.open = {dice->In(0, 90), dice->In(-60, 60), dice->In(-90, 60),
                dice->In(0, 0.1)};
  blade.columns = 2 * dice->Whole(1, 12);
  blade.rows = dice->Whole(2, 24);
  if (dice->Half()) blade.colors.tip = {0.5f, 0.2f, 1};
  if (dice->Half()) blade.colors.blotch = {{0, 0, 0.2f}, 0.1, 0.5, 0.6};
  return blade;
}

Arrangement RandomArrangement(Dice* dice) {
  Arrangement arrangement;
  if (dice->Half()) arrangement.kind = ArrangementKind::kWhorl;
  arrangement.spacing = dice->In(0, 0.2);
  arrangement.radius = dice->In(0, 0.5);
  arrangement.phase_deg = dice->In(-360, 360);
  arrangement.layers = dice->Whole(1, 4);
  arrangement.arc_deg = dice->In(30, 360);
  arrangement.height = dice->In(-1, 1);
  arrangement.dome = dice->In(-1, 1);
  return arrangement;
}

PetalGroup RandomPetals(Dice* dice) {
  PetalGroup group;
  group.count = dice->Whole(1, 40);
  group.blade = RandomBlade(dice);
  group.arrangement = RandomArrangement(dice);
  group.angle_deg = dice->In(-90, 120);
  group.open_angle_deg = dice->In(-90, 90);
  group.inner_size = dice->In(0.1, 2);
  group.swirl_deg = dice->In(-30, 30);
  return group;
}

FlowerSpec RandomFlower(int index) {
  Dice dice(index);
  FlowerSpec spec;
  spec.seed = (std::int64_t{dice.Whole(-1000, 1000)} << 40) + index;
  spec.method = static_cast<PetalMethod>(index % 3);
  for (int i = dice.Whole(1, 3); i > 0; --i) {
    spec.petals.push_back(RandomPetals(&dice));
  }
  if (dice.Half()) {
    SolidGroup solid;
    solid.count = dice.Whole(1, 60);
    solid.arrangement = RandomArrangement(&dice);
    solid.sides = dice.Whole(3, 12);
    solid.head_length = dice.In(0.01, 1);
    solid.head_radius = dice.In(0.01, 1);
    if (dice.Half()) solid.filament_length = 0;
    if (dice.Half()) solid.head_tint = {1, 1, 0};
    spec.solids.push_back(solid);
  }
  if (dice.Half()) {
    StemSpec stem;
    stem.height = dice.In(4, 20);
    stem.bend = dice.In(0, 0.2);
    stem.nod_deg = dice.In(0, 120);
    stem.variants = dice.Whole(1, 3);
    spec.stem = stem;
  }
  if (dice.Half()) {
    LeafGroup leaves;
    leaves.count = dice.Whole(1, 9);
    leaves.blade = RandomBlade(&dice);
    leaves.leaflets = 2 * dice.Whole(0, 3) + 1;
    if (dice.Half()) leaves.stalk = 0;
    spec.leaves.push_back(leaves);
  }
  spec.early = {dice.In(0, 50), dice.In(0, 1), dice.In(0.2, 1), 0.5};
  spec.full = {dice.In(0, 10), dice.In(0, 1), dice.In(0.2, 1), 1};
  spec.stage = dice.In(0, 1);
  spec.variation = dice.In(0, 1);
  spec.bed.plants = dice.Whole(1, 6);
  if (dice.Half()) spec.bed.layout = BedSpec::Layout::kVogel;
  return spec;
}

// --- Noise and relief -------------------------------------------------------

TEST(NoiseProperty, HasTheRmsAndTheRangeOfTheMethod) {
  constexpr int kSeeds = 20;
  constexpr int kSide = 200;
  double squares = 0;
  double sum = 0;
  float largest = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const PerlinNoise noise(seed);
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const float value = noise
                                .At(0.617f * static_cast<float>(i),
                                    0.377f * static_cast<float>(j))
                                .value;
        largest = std::max(largest, std::fabs(value));
        sum += static_cast<double>(value);
        squares += static_cast<double>(value) * static_cast<double>(value);
      }
    }
  }
  constexpr double kCount = double{kSeeds} * kSide * kSide;
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.217, 0.01);
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_LE(largest, 0.7072f);
  EXPECT_GT(largest, 0.6f);
}

// A petal's variance for amplitudes in turn, always; for frequencies, in most
// petals and in the mean.
TEST(ReliefProperty, GrowsWithItsThreeNumbers) {
  int rises_x = 0;
  int rises_y = 0;
  double ratio_x = 0;
  double ratio_y = 0;
  for (int index = 0; index < kFlowers; ++index) {
    Dice dice(index);
    const Sketch sketch = RandomSketch(&dice);
    const PerlinNoise noise(index);
    const LatticeOffset offset = {index, 3 * index};
    const auto variance = [&](double nd, double nsx, double nsy) {
      return NormalVariance(noise, sketch, {nd, nsx, nsy, 1, true}, offset);
    };
    const double base = variance(0.1, 2, 2);
    double before = 0;
    for (const double nd : {0.02, 0.05, 0.1, 0.2, 0.5}) {
      const double now = variance(nd, 2, 2);
      EXPECT_GT(now, before);
      before = now;
    }
    const double in_x = variance(0.1, 8, 2);
    const double in_y = variance(0.1, 2, 8);
    rises_x += in_x > base ? 1 : 0;
    rises_y += in_y > base ? 1 : 0;
    ratio_x += in_x / base / kFlowers;
    ratio_y += in_y / base / kFlowers;
  }
  EXPECT_GT(rises_x, 0.9 * kFlowers);
  EXPECT_GT(rises_y, 0.9 * kFlowers);
  EXPECT_GT(ratio_x, 2);
  EXPECT_GT(ratio_y, 2);
}

// --- Flowers ----------------------------------------------------------------

TEST(FlowerProperty, PrototypesHaveNoFault) {
  for (int index = 0; index < kFlowers; ++index) {
    SCOPED_TRACE(index);
    const FlowerSpec spec = RandomFlower(index);
    const auto flower = MakeFlower(spec);
    for (const FlowerPrototype& prototype : flower->prototypes()) {
      SCOPED_TRACE(prototype.name);
      ExpectGoodMesh(prototype.mesh, -0.5);
      const bool is_solid = prototype.organ == FlowerOrgan::kStem ||
                            prototype.organ == FlowerOrgan::kStamen;
      EXPECT_EQ(OpenEdges(prototype.mesh) == 0, is_solid);
      if (HasFatalFailure()) return;
    }
    EXPECT_EQ(flower->estimate().prototypes,
              static_cast<std::int64_t>(flower->prototypes().size()));
  }
}

TEST(FlowerProperty, RowsDoNotDependOnHowTheyAreAsked) {
  for (int index = 0; index < kFlowers; ++index) {
    SCOPED_TRACE(index);
    Dice dice(index);
    const auto flower = MakeFlower(RandomFlower(index));
    const InstanceBlock whole = GrowRows(flower);
    ASSERT_EQ(flower->estimate().instances,
              static_cast<std::int64_t>(whole.rows()));
    const int from = dice.Whole(0, static_cast<int>(whole.rows()));
    const InstanceBlock rest =
        GrowRows(flower, from, static_cast<std::size_t>(dice.Whole(1, 100)));
    ASSERT_EQ(RowBytes(rest, 0, rest.rows()),
              RowBytes(whole, static_cast<std::size_t>(from), whole.rows()));
    for (const Float3& p : whole.translation) {
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) &&
                  std::isfinite(p.z));
    }
  }
}

TEST(FlowerProperty, ThreadsMakeTheSameBytes) {
  for (int index = 0; index < 8; ++index) {
    const FlowerSpec spec = RandomFlower(index);
    const auto shared = MakeFlower(spec);
    std::vector<std::string> bytes(4);
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < bytes.size(); ++t) {
      threads.emplace_back([&, t] {
        // Two of one flower, two of flowers of their own.
        const auto flower = t < 2 ? shared : MakeFlower(spec);
        const InstanceBlock rows = GrowRows(flower, 0, 10 + t);
        bytes[t] = RowBytes(rows, 0, rows.rows());
        for (const FlowerPrototype& prototype : flower->prototypes()) {
          bytes[t] += MeshBytes(prototype.mesh);
        }
      });
    }
    threads.clear();
    for (const std::string& of_thread : bytes) EXPECT_EQ(of_thread, bytes[0]);
  }
}

}  // namespace
}  // namespace terrane::core
