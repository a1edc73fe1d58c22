// What the command line makes of rows: places, models, looks and pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>

#include "client/forest.h"
#include "client/local_backend.h"
#include "client/render/skeleton_view.h"
#include "client/tree_model.h"
#include "client/tree_rows.h"
#include "core/mesh/float3.h"
#include "core/mesh/rotation.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using ::testing::HasSubstr;

v1::TreeRecipe SmallOak() {
  v1::TreeRecipe recipe;
  recipe.set_dimensions(3);
  recipe.set_length_mode(v1::LENGTH_MODE_RELATIVE);
  recipe.set_depth(4);
  recipe.set_trunk_length(4);
  recipe.mutable_leaves()->set_count(2);
  return recipe;
}

TEST(PlaceTreeTest, ScalesTurnsAndMoves) {
  core::SegmentBlock tree;
  tree.start = {{0, 0, 0}};
  tree.end = {{1, 0, 3}};
  tree.radius_start = {0.5f};
  tree.radius_end = {0.25f};
  v1::TreePlacement placement;
  placement.set_x(10);
  placement.set_y(20);
  placement.set_z(30);
  placement.set_scale(2);
  placement.set_yaw_deg(90);
  PlaceTree(placement, &tree);
  EXPECT_EQ(tree.start[0], (core::Float3{10, 20, 30}));
  EXPECT_LT(core::Length(tree.end[0] - core::Float3{10, 22, 36}), 1e-5f);
  EXPECT_EQ(tree.radius_start[0], 1);
  EXPECT_EQ(tree.radius_end[0], 0.5f);
}

TEST(TreeModelTest, LevelsLeaveOutGenerationsFacesAndLeaves) {
  LocalBackend backend(1);
  const auto fine = StreamTreeModel(SmallOak(), {}, &backend.trees(), {});
  ASSERT_TRUE(fine.ok()) << fine.status();
  const auto coarse =
      StreamTreeModel(SmallOak(), {.level = 2}, &backend.trees(), {});
  ASSERT_TRUE(coarse.ok()) << coarse.status();
  EXPECT_LT(4 * coarse->wood.indices.size(), fine->wood.indices.size());
  EXPECT_EQ(coarse->leaves.count(), (fine->leaves.count() + 3) / 4);
  EXPECT_EQ(coarse->leaves.translations[1], fine->leaves.translations[4]);
  EXPECT_EQ(coarse->leaves.scales[1], 2.0f * fine->leaves.scales[4]);
  const auto bare =
      StreamTreeModel(SmallOak(), {.leaves = false}, &backend.trees(), {});
  EXPECT_EQ(bare->leaves.count(), 0u);
  const auto nothing =
      StreamTreeModel(SmallOak(), {.level = 5}, &backend.trees(), {});
  EXPECT_THAT(std::string(nothing.status().message()),
              HasSubstr("--lod: must be in [0, 4], the tree's generations"));
}

TEST(TreeModelTest, MergingWritesInstancesOutInTheirColours) {
  LocalBackend backend(1);
  const auto model = StreamTreeModel(SmallOak(), {}, &backend.trees(), {});
  ASSERT_TRUE(model.ok());
  v1::TreeView view;
  view.set_leaf_color("#00ff00");
  const auto look = TreeLook::Create(view);
  ASSERT_TRUE(look.ok()) << look.status();
  const core::Mesh merged = MergedMesh(look->SceneOf(*model));
  const std::size_t wood = model->wood.positions.size();
  const std::size_t leaf = look->leaf().positions.size();
  ASSERT_EQ(merged.positions.size(), wood + model->leaves.count() * leaf);
  // A leaf's base is its instance's place.
  EXPECT_EQ(merged.positions[wood + leaf], model->leaves.translations[1]);
  EXPECT_EQ(merged.colors[wood], (core::Float3{0, 1, 0}));
}

TEST(TreeLookTest, NamesTheFieldThatIsWrong) {
  const auto error = [](auto&& set) {
    v1::TreeView view;
    set(&view);
    return std::string(TreeLook::Create(view).status().message());
  };
  EXPECT_THAT(error([](v1::TreeView* v) { v->set_bark_color("brown"); }),
              HasSubstr("view.bark_color: must be #rrggbb, got \"brown\""));
  EXPECT_THAT(error([](v1::TreeView* v) { v->set_leaf_color("#12345g"); }),
              HasSubstr("view.leaf_color: must be #rrggbb"));
  EXPECT_THAT(error([](v1::TreeView* v) { v->set_leaf_width(3); }),
              HasSubstr("view.leaf_width: must be in (0, 2]"));
  EXPECT_THAT(error([](v1::TreeView* v) { v->set_leaf_blades(33); }),
              HasSubstr("view.leaf_blades: must be in [1, 32], got 33"));
  EXPECT_THAT(error([](v1::TreeView* v) { v->set_leaf_spread_deg(-1); }),
              HasSubstr("view.leaf_spread_deg: must be in (0, 360]"));
}

TEST(ForestTest, StandsOnAGridOrWhereTheTableSays) {
  v1::TreeRecipe recipe = SmallOak();
  const auto grid = Forest::Create({.count = 5, .first_seed = 7});
  ASSERT_TRUE(grid.ok());
  EXPECT_EQ(grid->At(4, recipe).seed(), 11);
  EXPECT_EQ(grid->At(4, recipe).x(), 12);
  EXPECT_EQ(grid->At(4, recipe).y(), 12);
  const TemporaryFolder folder;
  const std::string path = folder.File("trees.csv");
  std::ofstream(path) << "y,x,scale\n1,2,3\n4,5,6\n";
  const auto table = Forest::Create({.placements_file = path});
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_EQ(table->count(), 2);
  EXPECT_EQ(table->At(1, recipe).x(), 5);
  EXPECT_EQ(table->At(1, recipe).scale(), 6);
  EXPECT_EQ(table->At(1, recipe).seed(), 2);
  EXPECT_FALSE(Forest::Create({}).ok());
}

TEST(ForestModelTest, ASeedThatStandsTwiceIsThereOnce) {
  const TemporaryFolder folder;
  const std::string path = folder.File("trees.csv");
  std::ofstream(path) << "x,y,seed,yaw_deg,scale\n"
                         "0,0,4,0,1\n9,0,4,180,2\n0,9,5,0,1\n";
  LocalBackend backend(1);
  const auto forest = Forest::Create({.placements_file = path});
  ASSERT_TRUE(forest.ok());
  const auto model =
      ForestModel::Stream(*forest, SmallOak(), {}, &backend.trees(), {});
  ASSERT_TRUE(model.ok()) << model.status();
  const auto look = TreeLook::Create({});
  const core::Scene scene = model->SceneOf(*look);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].instances->count(), 2u);
  // The second tree's leaves are the first one's, turned half around and twice
  // as large.
  const core::Instances& leaves = model->leaves();
  v1::TreeRecipe one = SmallOak();
  one.set_seed(4);
  const auto alone = StreamTreeModel(one, {}, &backend.trees(), {});
  const std::size_t count = alone->leaves.count();
  const core::Float3& p = alone->leaves.translations[0];
  EXPECT_LT(core::Length(leaves.translations[count] -
                         core::Float3{9 - 2 * p.x, -2 * p.y, 2 * p.z}),
            1e-4f);
  EXPECT_EQ(leaves.scales[count], 2.0f * alone->leaves.scales[0]);
  const core::Quaternion& q = leaves.rotations[count];
  EXPECT_NEAR(
      static_cast<double>(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w), 1,
      1e-5);
}

TEST(SkeletonViewTest, DrawsTheTrunkAsWideAsItIs) {
  core::SegmentBlock tree;
  tree.parent = {core::kNoParent};
  tree.start = {{0, 0, 0}};
  tree.end = {{0, 0, 8}};
  tree.radius_start = tree.radius_end = {1};
  tree.flags = {0};
  const Picture picture = DrawSkeleton(tree, 100, {0, 0, 0});
  int dark = 0;
  for (int x = 0; x < 100; ++x) dark += picture.Pixel(x, 50)[0] < 128;
  // Of ten units, round ends included, on 92 pixels.
  EXPECT_NEAR(dark, 2 * 9.2, 1.5);
}

TEST(SkeletonViewTest, LaysACantorSetsGenerationsBelowEachOther) {
  v1::TreeRecipe recipe;
  recipe.set_form(v1::TREE_FORM_CANTOR);
  recipe.set_depth(2);
  recipe.set_trunk_length(9);
  LocalBackend backend(1);
  auto tree =
      StreamWholeTree(recipe, ProgressMode::kNone, &backend.trees(), {});
  ASSERT_TRUE(tree.ok()) << tree.status();
  SpreadGenerations(&tree->rows);
  EXPECT_EQ(tree->rows.start[0].z, 0);
  EXPECT_LT(tree->rows.start[1].z, tree->rows.start[0].z);
  EXPECT_EQ(tree->rows.start[1].z, tree->rows.start[2].z);
  EXPECT_LT(tree->rows.start[3].z, tree->rows.start[2].z);
  // A round end does not reach into a gap.
  EXPECT_NEAR(
      static_cast<double>(tree->rows.end[1].x + tree->rows.radius_end[1]), 3,
      1e-5);
}

// A flower stands on its leaf's face, as large as the leaf is long: its +y
// along the leaf's +x, its +z along the leaf's +z.
TEST(FoliageTest, StandsAtEveryLeafAsTheLeafDoes) {
  LocalBackend backend(1);
  v1::FlowerChoice choice;
  choice.set_preset("flower/leaf-flat");
  const auto flower =
      FlowerModel::Stream(choice, ProgressMode::kNone, &backend.flowers(), {});
  ASSERT_TRUE(flower.ok()) << flower.status();
  auto model = StreamTreeModel(SmallOak(), {}, &backend.trees(), {});
  ASSERT_TRUE(model.ok()) << model.status();
  auto look = TreeLook::Create({});
  ASSERT_TRUE(look.ok()) << look.status();
  look->SetFoliage(std::make_shared<FlowerModel>(*flower));
  ASSERT_TRUE(look->Dress(&*model).ok());
  const core::Scene scene = look->SceneOf(*model);
  const core::Instances& own = *flower->View().objects[0].instances;
  ASSERT_EQ(own.count(), 1u);
  ASSERT_EQ(scene.objects.size(), 2u);
  const core::SceneObject& leaves = scene.objects[1];
  ASSERT_EQ(leaves.instances->count(), model->leaves.count());
  EXPECT_EQ(scene.materials[leaves.material].name, "leaf");
  const float unit = static_cast<float>(flower->header().recipe().unit_m());
  for (std::size_t k = 0; k < model->leaves.count(); ++k) {
    const core::Quaternion& leaf = model->leaves.rotations[k];
    const float size = model->leaves.scales[k].x / unit;
    // A point of the flower, where the leaf has it.
    const core::Float3 p = own.translations[0];
    const core::Float3 expected = model->leaves.translations[k] +
                                  size * core::Rotated(leaf, {p.y, -p.x, p.z});
    EXPECT_LT(core::Length(leaves.instances->translations[k] - expected),
              1e-5f);
    const core::Float3 up =
        core::Rotated(leaves.instances->rotations[k], {0, 0, 1});
    const core::Float3 flower_up = core::Rotated(own.rotations[0], {0, 0, 1});
    EXPECT_LT(core::Length(up - core::Rotated(leaf, {flower_up.y, -flower_up.x,
                                                     flower_up.z})),
              1e-5f);
  }
}

}  // namespace
}  // namespace terrane::client
