// Whole plants: arrangement, growth, solids and stems, prototypes, blocks,
// stops, resuming, beds and scenes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "core/flower/flower_scene.h"
#include "core/flower/growth.h"
#include "core/flower/rotation.h"
#include "core/flower/solid_mesh.h"
#include "core/flower/stem.h"
#include "core/mesh/float3.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/flower_presets.h"
#include "tests/core/mesh_checks.h"
#include "tests/core/whole_flower.h"

namespace terrane::core {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kPi = 3.14159265358979323846;

// --- Rotations --------------------------------------------------------------

TEST(Turn, TurnsAboutItsAxisAndComposes) {
  const auto expect = [](Vector a, double x, double y, double z) {
    EXPECT_NEAR(a.x, x, 1e-12);
    EXPECT_NEAR(a.y, y, 1e-12);
    EXPECT_NEAR(a.z, z, 1e-12);
  };
  expect(AboutX(90).Of({0, 1, 0}), 0, 0, 1);
  expect(AboutY(90).Of({0, 0, 1}), 1, 0, 0);
  expect(AboutZ(90).Of({1, 0, 0}), 0, 1, 0);
  expect((AboutZ(90) * AboutX(90)).Of({0, 1, 0}), 0, 0, 1);
  expect((AboutX(90) * AboutZ(90)).Of({1, 0, 0}), 0, 0, 1);
  const Vector unit = UnitOf({0.3, -0.5, 0.2});
  expect(FromZTo(unit).Of({0, 0, 1}), unit.x, unit.y, unit.z);
  EXPECT_NEAR(SineCosineOf(-330).sine, 0.5, 1e-15);
  EXPECT_NEAR(SineCosineOf(360e4 + 60).cosine, 0.5, 1e-9);
}

// --- Arrangement ------------------------------------------------------------

TEST(Arrangement, VogelIsTheLawOfThePaper) {
  Arrangement arrangement;
  arrangement.spacing = 0.03;
  for (int n = 1; n <= 1000; ++n) {
    const Seat seat = SeatOf(arrangement, n, 1000, 1);
    EXPECT_DOUBLE_EQ(seat.radius, 0.03 * std::sqrt(n));
    EXPECT_DOUBLE_EQ(seat.azimuth_deg, n * 137.50776405);
    EXPECT_EQ(seat.rank, n);
  }
}

TEST(Arrangement, AWhorlHasLayersTurnedByHalfAStep) {
  Arrangement arrangement;
  arrangement.kind = ArrangementKind::kWhorl;
  arrangement.layers = 2;
  arrangement.radius = 1;
  arrangement.phase_deg = 10;
  const Seat third = SeatOf(arrangement, 3, 6, 1);
  EXPECT_DOUBLE_EQ(third.azimuth_deg, 10 + 240);
  EXPECT_DOUBLE_EQ(third.radius, 1.1);
  EXPECT_EQ(third.share, 0);
  EXPECT_EQ(third.rank, 3);
  const Seat fourth = SeatOf(arrangement, 4, 6, 0.5);
  EXPECT_DOUBLE_EQ(fourth.azimuth_deg, 10 + 60);
  EXPECT_DOUBLE_EQ(fourth.radius, 0.5 * 1.2);
  EXPECT_EQ(fourth.share, 1);
  EXPECT_EQ(fourth.rank, 6);
  // One layer, over part of the circle: 360 (n - 1) / Np for all of it.
  arrangement = {};
  arrangement.kind = ArrangementKind::kWhorl;
  EXPECT_DOUBLE_EQ(SeatOf(arrangement, 5, 5, 1).azimuth_deg, 360 * 4 / 5.0);
  arrangement.arc_deg = 100;
  EXPECT_DOUBLE_EQ(SeatOf(arrangement, 2, 2, 1).azimuth_deg, 50);
}

TEST(Arrangement, ADomeIsHighestAtItsCentre) {
  Arrangement arrangement;
  arrangement.height = 0.2;
  arrangement.dome = 0.5;
  EXPECT_NEAR(SeatOf(arrangement, 100, 100, 1).height, 0.2, 1e-12);
  EXPECT_NEAR(SeatOf(arrangement, 25, 100, 1).height, 0.2 + 0.5 * 0.75, 1e-12);
}

std::vector<Float3> Florets() {
  FlowerSpec spec = FlowerPreset("sunflower");
  spec.petals.clear();
  spec.leaves.clear();
  spec.stem.reset();
  spec.solids.resize(1);
  spec.unit_m = 1;
  spec.variation = 0;
  EXPECT_EQ(spec.solids[0].count, 1000);
  return GrowRows(spec).translation;
}

TEST(SunflowerHead, DivergesByTheGoldenAngle) {
  const std::vector<Float3> florets = Florets();
  for (std::size_t i = 1; i < florets.size(); ++i) {
    const double before = std::atan2(florets[i - 1].y, florets[i - 1].x);
    const double here = std::atan2(florets[i].y, florets[i].x);
    const double step = std::fmod((here - before) * 180 / kPi + 720, 360);
    ASSERT_NEAR(step, 137.50776405, 1e-3) << i;
  }
}

TEST(SunflowerHead, FloretsKeepTheirDistance) {
  const std::vector<Float3> florets = Florets();
  const double spacing =
      FlowerPreset("sunflower").solids[0].arrangement.spacing;
  double least = 1e9;
  for (std::size_t i = 0; i < florets.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(
          least, std::hypot(static_cast<double>(florets[i].x - florets[j].x),
                            static_cast<double>(florets[i].y - florets[j].y)));
    }
  }
  EXPECT_GE(least, 1.60 * spacing);
}

// --- Growth -----------------------------------------------------------------

TEST(Growth, OpensPetalsAsThePaperSays) {
  const GrowthStage stage = {8, 0.7, 1, 1};
  for (int n = 1; n <= 8; ++n) EXPECT_EQ(Openness(stage, n, 34), 0);
  EXPECT_DOUBLE_EQ(Openness(stage, 21, 34), 0.7 * 13 / 26);
  EXPECT_DOUBLE_EQ(Openness(stage, 34, 34), 0.7);
  // All buds: nothing opens, and nothing is divided by 0.
  EXPECT_EQ(Openness({34, 1, 1, 1}, 34, 34), 0);
  const GrowthStage half = StageAt({30, 0.1, 0.6, 0.4}, {8, 0.7, 1, 1}, 0.5);
  EXPECT_DOUBLE_EQ(half.buds, 19);
  EXPECT_DOUBLE_EQ(half.angle_ratio, 0.4);
  EXPECT_DOUBLE_EQ(half.size, 0.8);
  EXPECT_DOUBLE_EQ(half.spread, 0.7);
}

// Elevation of a petal: of its y, in degrees.
std::vector<double> Elevations(const FlowerSpec& spec) {
  const InstanceBlock rows = GrowRows(spec);
  std::vector<double> elevations;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const Quaternion q = rows.rotation[i];
    const double up =
        2 * (static_cast<double>(q.y * q.z) + static_cast<double>(q.x * q.w));
    elevations.push_back(std::asin(std::clamp(up, -1.0, 1.0)) * 180 / kPi);
  }
  return elevations;
}

FlowerSpec BareRose(double stage) {
  FlowerSpec rose = FlowerPreset("rose");
  rose.petals.resize(1);
  rose.leaves.clear();
  rose.solids.clear();
  rose.stem.reset();
  rose.variation = 0;
  rose.stage = stage;
  return rose;
}

TEST(Growth, APetalStandsAtItsAngle) {
  const FlowerSpec rose = BareRose(1);
  const PetalGroup& petals = rose.petals[0];
  const std::vector<double> elevations = Elevations(rose);
  ASSERT_THAT(elevations, SizeIs(34));
  for (int n = 1; n <= 34; ++n) {
    const double open = n <= 8 ? 0 : 0.7 * (n - 8) / 26.0;
    const double expected =
        petals.angle_deg - open * (petals.angle_deg - petals.open_angle_deg);
    EXPECT_NEAR(elevations[static_cast<std::size_t>(n) - 1], expected, 0.05);
  }
}

TEST(Growth, AStageOpensTheFlower) {
  double before = 91;
  for (const double stage : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const std::vector<double> elevations = Elevations(BareRose(stage));
    const double mean =
        std::accumulate(elevations.begin(), elevations.end(), 0.0) / 34;
    EXPECT_LT(mean, before);
    before = mean;
  }
}

// --- Solids and stems -------------------------------------------------------

TEST(Solids, AreClosed) {
  SolidGroup both;
  SolidGroup filament = both;
  filament.head_length = 0;
  SolidGroup head = both;
  head.filament_length = 0;
  head.sides = 3;
  for (const SolidGroup& solid : {both, filament, head}) {
    const Mesh mesh = MakeSolid(solid);
    ExpectGoodMesh(mesh);
    EXPECT_EQ(OpenEdges(mesh), 0u);
    const MeshSize size = SolidSize(solid);
    EXPECT_EQ(static_cast<std::int64_t>(mesh.positions.size()), size.vertices);
    EXPECT_EQ(static_cast<std::int64_t>(mesh.indices.size()),
              3 * size.triangles);
  }
  EXPECT_EQ(OpenEdges(MakeCylinder(kStalkSides)), 0u);
}

TEST(Stem, IsAClosedTubeAlongItsLine) {
  StemSpec spec;
  spec.bend = 0.2;
  spec.nod_deg = 120;
  spec.rows = 64;
  for (int variant = 0; variant < 3; ++variant) {
    const StemLine line(spec, variant, PerlinNoise(variant));
    const Mesh mesh = MakeStem(spec, line);
    ExpectGoodMesh(mesh);
    EXPECT_EQ(OpenEdges(mesh), 0u);
    const MeshSize size = StemSize(spec);
    EXPECT_EQ(static_cast<std::int64_t>(mesh.positions.size()), size.vertices);
    EXPECT_EQ(static_cast<std::int64_t>(mesh.indices.size()),
              3 * size.triangles);
    // The tip nods as it was told, within what the bend does to it.
    const Vector tip = line.At(1).direction;
    EXPECT_LT(tip.z, -0.2);
    EXPECT_LT(tip.y, -0.5);
  }
}

TEST(Stem, IsAsLongAsItsHeightAndStartsUpright) {
  StemSpec spec;
  spec.bend = 0;
  const StemLine line(spec, 0, PerlinNoise(1));
  EXPECT_DOUBLE_EQ(line.At(0).direction.z, 1);
  EXPECT_NEAR(line.At(1).position.z, spec.height, 1e-12);
  EXPECT_NEAR(line.At(0.25).position.z, spec.height / 4, 1e-12);
}

// --- Prototypes and rows ----------------------------------------------------

TEST(Flower, EstimateIsExact) {
  for (const std::string& name : FlowerPresetNames()) {
    SCOPED_TRACE(name);
    FlowerSpec spec = FlowerPreset(name);
    spec.bed.plants = 3;
    const auto flower = MakeFlower(spec);
    const FlowerEstimate& estimate = flower->estimate();
    std::int64_t vertices = 0, triangles = 0, bytes = 0;
    for (const FlowerPrototype& prototype : flower->prototypes()) {
      const Mesh& mesh = prototype.mesh;
      vertices += static_cast<std::int64_t>(mesh.positions.size());
      triangles += static_cast<std::int64_t>(mesh.indices.size()) / 3;
      bytes += static_cast<std::int64_t>(MeshBytes(mesh).size());
    }
    EXPECT_EQ(estimate.prototypes,
              static_cast<std::int64_t>(flower->prototypes().size()));
    EXPECT_EQ(estimate.vertices, vertices);
    EXPECT_EQ(estimate.triangles, triangles);
    EXPECT_EQ(estimate.prototype_bytes, bytes);
    const InstanceBlock rows = GrowRows(flower);
    EXPECT_EQ(estimate.instances, static_cast<std::int64_t>(rows.rows()));
    EXPECT_EQ(estimate.instance_bytes,
              static_cast<std::int64_t>(RowBytes(rows, 0, rows.rows()).size()));
  }
}

TEST(Flower, PrototypesAreGoodMeshes) {
  for (const std::string& name : FlowerPresetNames()) {
    const auto flower = MakeFlower(FlowerPreset(name));
    EXPECT_THAT(flower->warnings(), IsEmpty());
    for (const FlowerPrototype& prototype : flower->prototypes()) {
      SCOPED_TRACE(name + ": " + prototype.name);
      ExpectGoodMesh(prototype.mesh);
      const bool is_sheet = prototype.organ == FlowerOrgan::kPetal ||
                            prototype.organ == FlowerOrgan::kSepal ||
                            prototype.organ == FlowerOrgan::kLeaf;
      EXPECT_EQ(OpenEdges(prototype.mesh) > 0, is_sheet);
      EXPECT_EQ(prototype.material.double_sided || !is_sheet, true);
    }
  }
}

TEST(Flower, RowsFitTheirPrototypes) {
  for (const std::string& name : FlowerPresetNames()) {
    SCOPED_TRACE(name);
    const auto flower = MakeFlower(FlowerPreset(name));
    const InstanceBlock rows = GrowRows(flower);
    std::set<std::uint32_t> used;
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      ASSERT_LT(rows.prototype[i], flower->prototypes().size());
      used.insert(rows.prototype[i]);
      EXPECT_EQ(flower->prototypes()[rows.prototype[i]].organ, rows.organ[i]);
      const Quaternion q = rows.rotation[i];
      EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1, 1e-5);
      EXPECT_GT(std::min({rows.scale[i].x, rows.scale[i].y, rows.scale[i].z}),
                0);
      EXPECT_GE(rows.n[i], 1u);
    }
    EXPECT_GT(used.size(), flower->prototypes().size() / 2);
  }
}

TEST(Flower, SketchesAreChosenAtRandom) {
  const FlowerSpec rose = BareRose(1);
  const InstanceBlock rows = GrowRows(rose);
  const BladeSpec& blade = rose.petals[0].blade;
  int second = 0;
  for (const std::uint32_t prototype : rows.prototype) {
    second += prototype / static_cast<std::uint32_t>(blade.steps) == 1 ? 1 : 0;
  }
  EXPECT_GT(second, 8);
  EXPECT_LT(second, 26);
}

// The method's claim: at 32 x 40 cells a petal, a rose of 34 petals falls from
// 2.6 MB to about 0.2 MB.
TEST(Flower, StructureIsATenthOfTheGeometry) {
  FlowerSpec rose = FlowerPreset("rose");
  rose.petals[0].blade.columns = 32;
  rose.petals[0].blade.rows = 40;
  rose.petals[0].blade.steps = 1;
  rose.petals[0].blade.colors = {};
  rose.leaves[0].leaflets = 1;
  const auto flower = MakeFlower(rose);
  std::int64_t expanded = 0;
  for (const std::uint32_t prototype : GrowRows(flower).prototype) {
    expanded += static_cast<std::int64_t>(
        MeshBytes(flower->prototypes()[prototype].mesh).size());
  }
  const FlowerEstimate& estimate = flower->estimate();
  const std::int64_t bytes = estimate.prototype_bytes + estimate.instance_bytes;
  EXPECT_NEAR(static_cast<double>(bytes), 0.2e6, 0.02e6);
  EXPECT_NEAR(static_cast<double>(expanded), 2.6e6, 0.1e6);
}

TEST(Flower, SaysWhenItsReliefFolds) {
  FlowerSpec rose = FlowerPreset("rose");
  rose.petals[0].blade.relief = {1, 8, 8, 1, true};
  const auto flower = MakeFlower(rose);
  ASSERT_THAT(flower->warnings(), SizeIs(1));
  EXPECT_THAT(flower->warnings()[0],
              HasSubstr("petals[0].blade.relief folds: the variance of its "
                        "normals by area is 0."));
  EXPECT_THAT(flower->warnings()[0], HasSubstr(", above 0.4"));
}

// --- Blocks, stops and resuming ---------------------------------------------

TEST(FlowerGenerator, BlocksAndResumingChangeNothing) {
  FlowerSpec spec = FlowerPreset("rose");
  spec.bed.plants = 5;
  const auto flower = MakeFlower(spec);
  const InstanceBlock whole = GrowRows(flower);
  ASSERT_EQ(static_cast<std::int64_t>(whole.rows()), flower->rows());
  const std::string bytes = RowBytes(whole, 0, whole.rows());
  for (const std::size_t block_rows : {1u, 7u, 100u, 385u}) {
    const InstanceBlock again = GrowRows(flower, 0, block_rows);
    EXPECT_EQ(RowBytes(again, 0, again.rows()), bytes) << block_rows;
  }
  for (const std::int64_t from : {1, 76, 77, 200, 384, 385}) {
    const InstanceBlock rest = GrowRows(flower, from, 50);
    EXPECT_EQ(RowBytes(rest, 0, rest.rows()),
              RowBytes(whole, static_cast<std::size_t>(from), whole.rows()))
        << from;
  }
}

TEST(FlowerGenerator, RefusesRowsThatAreNotThere) {
  const auto flower = MakeFlower(FlowerPreset("daisy"));
  for (const std::int64_t from : {std::int64_t{-1}, flower->rows() + 1}) {
    FlowerGenerator generator(flower, from);
    InstanceBlock block;
    const absl::Status status = generator.Next({}, &block);
    ASSERT_THAT(ViolationsOf(status), SizeIs(1));
    EXPECT_EQ(ViolationsOf(status)[0].field, "from_row");
  }
}

TEST(FlowerGenerator, StopsAndGoesOn) {
  FlowerSpec spec = FlowerPreset("rose");
  spec.bed.plants = 10;
  const auto flower = MakeFlower(spec);
  FlowerGenerator generator(flower);
  std::stop_source source;
  source.request_stop();
  InstanceBlock block;
  EXPECT_EQ(generator.Next(source.get_token(), &block).code(),
            absl::StatusCode::kCancelled);
  EXPECT_EQ(block.rows(), 0u);
  EXPECT_FALSE(generator.Done());
  ASSERT_TRUE(generator.Next({}, &block).ok());
  EXPECT_EQ(static_cast<std::int64_t>(block.rows()), flower->rows());
  EXPECT_TRUE(generator.Done());
}

// --- Beds -------------------------------------------------------------------

TEST(Bed, OfAHundredRosesHasNoTwoAlike) {
  FlowerSpec spec = FlowerPreset("rose");
  spec.bed.plants = 100;
  const auto flower = MakeFlower(spec);
  const InstanceBlock rows = GrowRows(flower);
  const auto of_plant =
      static_cast<std::size_t>(flower->placement().rows_of_plant());
  // Sizes and prototypes do not depend on where a plant stands or how it is
  // turned: they alone must tell plants apart.
  std::set<std::string> plants;
  std::set<std::string> choices;
  for (std::size_t first = 0; first < rows.rows(); first += of_plant) {
    const auto* sizes = reinterpret_cast<const char*>(&rows.scale[first]);
    const auto* chosen = reinterpret_cast<const char*>(&rows.prototype[first]);
    plants.emplace(sizes, of_plant * sizeof(Float3));
    choices.emplace(chosen, of_plant * sizeof(std::uint32_t));
  }
  EXPECT_EQ(plants.size(), 100u);
  EXPECT_EQ(choices.size(), 100u);
}

TEST(Bed, WithoutVariationPlantsDifferInSketchesOnly) {
  FlowerSpec spec = FlowerPreset("rose");
  spec.bed.plants = 4;
  spec.variation = 0;
  const InstanceBlock rows = GrowRows(spec);
  const std::size_t of_plant = rows.rows() / 4;
  for (std::size_t i = 0; i < of_plant; ++i) {
    EXPECT_EQ(rows.scale[i], rows.scale[of_plant + i]);
  }
  EXPECT_NE(
      std::vector(rows.prototype.begin(), rows.prototype.begin() + 77),
      std::vector(rows.prototype.begin() + 77, rows.prototype.begin() + 154));
}

TEST(Bed, PlantsKeepTheirSpacing) {
  FlowerSpec spec = FlowerPreset("daisy");
  spec.bed = {25, BedSpec::Layout::kGrid, 0.5, 0, 180};
  const auto flower = MakeFlower(spec);
  EXPECT_NEAR(flower->placement().PlantAt(0).place_m.x, -1, 1e-12);
  EXPECT_NEAR(flower->placement().PlantAt(24).place_m.y, 1, 1e-12);
  EXPECT_NEAR(flower->placement().PlantAt(12).place_m.x, 0, 1e-12);
  spec.bed.layout = BedSpec::Layout::kVogel;
  const auto disc = MakeFlower(spec);
  const Vector fifth = disc->placement().PlantAt(4).place_m;
  EXPECT_NEAR(std::hypot(fifth.x, fifth.y), 1, 1e-12);
}

TEST(Bed, OfAThousandIsGivenInBlocksOfOneSize) {
  FlowerSpec spec = FlowerPreset("rose");
  spec.bed.plants = 1000;
  const auto flower = MakeFlower(spec);
  EXPECT_EQ(flower->rows(), 77'000);
  FlowerGenerator generator(flower, 0, 4096);
  InstanceBlock block;
  std::size_t rows = 0;
  std::size_t largest = 0;
  while (!generator.Done()) {
    ASSERT_TRUE(generator.Next({}, &block).ok());
    rows += block.rows();
    largest = std::max(largest, block.translation.capacity());
  }
  EXPECT_EQ(rows, 77'000u);
  EXPECT_EQ(largest, 4096u);
}

// --- Scene ------------------------------------------------------------------

TEST(FlowerScene, HoldsEveryInstanceOnce) {
  FlowerSpec spec = FlowerPreset("pansy");
  spec.bed.plants = 3;
  const auto flower = MakeFlower(spec);
  const auto made = FlowerScene::Create(flower, {});
  ASSERT_TRUE(made.ok());
  const Scene scene = (*made)->View();
  std::int64_t count = 0;
  for (const SceneObject& object : scene.objects) {
    ASSERT_LT(object.material, scene.materials.size());
    ASSERT_NE(object.instances, nullptr);
    EXPECT_GT(object.instances->count(), 0u);
    EXPECT_EQ(object.instances->rotations.size(), object.instances->count());
    EXPECT_EQ(object.instances->scales.size(), object.instances->count());
    count += static_cast<std::int64_t>(object.instances->count());
  }
  EXPECT_EQ(count, flower->rows());
  // Materials that are equal are one.
  EXPECT_EQ(scene.materials.size(), 4u);
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(FlowerScene::Create(flower, source.get_token()).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace terrane::core
