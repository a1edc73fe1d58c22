// Whole plants: solids and stems, prototypes, blocks, stops, resuming, beds
// and scenes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "core/flower/flower_scene.h"
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
    std::size_t index = 0;
    for (const PrototypeKind& kind : PrototypeKinds(spec)) {
      for (std::int64_t k = 0; k < kind.count; ++k) {
        const Mesh& mesh = flower->prototypes().at(index++).mesh;
        EXPECT_EQ(std::ssize(mesh.positions), kind.size.vertices);
        EXPECT_EQ(std::ssize(mesh.indices), 3 * kind.size.triangles);
        EXPECT_EQ(!mesh.colors.empty(), kind.has_colors);
      }
    }
    const InstanceBlock rows = GrowRows(flower);
    EXPECT_EQ(estimate.instances, static_cast<std::int64_t>(rows.rows()));
    EXPECT_EQ(estimate.instance_bytes,
              static_cast<std::int64_t>(RowBytes(rows, 0, rows.rows()).size()));
  }
}

TEST(Flower, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(
      absl::IsCancelled(Flower::Create(Rose(), {}, stop.get_token()).status()));
}

TEST(Flower, ControlValuesAreThoseOfItsMethod) {
  // Two sketches of a petal, one of a sepal, one of a leaf with three points.
  FlowerSpec rose = Rose();
  EXPECT_EQ(EstimateFlower(rose).control_values, 3 * 7 + 9);
  rose.method = PetalMethod::kIfs;
  EXPECT_EQ(EstimateFlower(rose).control_values, 3 * 36 + 48);
  rose.method = PetalMethod::kBezier;
  EXPECT_EQ(EstimateFlower(rose).control_values, 4 * 48);
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
  FlowerSpec rose = Rose();
  rose.petals.resize(1);
  rose.leaves.clear();
  rose.solids.clear();
  rose.stem.reset();
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
