// Recipes between the API and the core: the round trip, the defaults, and every
// violation by its path.
#include "server/convert/terrain_convert.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "server/convert/content_hash.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Knows one raster, "sha256:known".
class OneRaster : public RasterSource {
 public:
  OneRaster() {
    auto raster = std::make_shared<core::Raster>();
    raster->width = 3;
    raster->height = 2;
    raster->frame = {500, 800, 30, -30};
    raster->values = {1, 2, 3, 4, 5, 6};
    raster_ = raster;
  }
  PlacedRaster Find(const std::string& raster_id) override {
    if (raster_id != "sha256:known") return {};
    return {raster_, "EPSG:32617"};
  }

 private:
  std::shared_ptr<const core::Raster> raster_;
};

// Knows one table, "sha256:table".
class OneTable : public SpotTableSource {
 public:
  std::shared_ptr<const SpotTable> FindTable(
      const std::string& table_id) override {
    return table_id == "sha256:table" ? table_ : nullptr;
  }

 private:
  const std::shared_ptr<const SpotTable> table_ =
      std::make_shared<const SpotTable>(
          SpotTable{{{7, 8}, 9, 0}, {{1, 2}, 3, 0.5}});
};

class TerrainConvertTest : public ::testing::Test {
 protected:
  ReadRecipe Read(const std::string& json) {
    return ReadTerrainRecipe(FromJson<v1::TerrainRecipe>(json), sources_, {},
                             "terrain.recipe.", &violations_);
  }

  OneRaster rasters_;
  OneTable tables_;
  const ContentSources sources_{&rasters_, &tables_};
  core::Violations violations_;
};

// Every field and every kind of part, source and enum value, none at its
// default.
constexpr char kResolvedTerrain[] = R"({
  "dimensions": 2, "seed": "-7", "source": "FRACTAL_SOURCE_MIDPOINT",
  "mapping": "HEIGHT_MAPPING_BOLTZMANN", "roughness": 0.7, "fidelity": 2.5,
  "sigma": 1.5, "delta": 0.01, "softLimit": 30,
  "domain": {"cellsX": "8", "cellsY": "4"},
  "frame": {"originX": -5, "originY": 9, "spacingX": 2, "spacingY": -3,
            "crs": "EPSG:3857"},
  "macro": {"base": 4, "parts": [
    {"combine": "MACRO_COMBINE_ADD", "plane":
      {"point": {"x": 1, "y": 2}, "height": 3, "slopeX": 0.5, "slopeY": -1}},
    {"combine": "MACRO_COMBINE_MAXIMUM", "cone":
      {"centre": {"x": 1, "y": 2}, "radius": 3, "height": -4}},
    {"combine": "MACRO_COMBINE_MINIMUM", "gaussianHill":
      {"centre": {"x": 1, "y": 2}, "sigmaX": 3, "sigmaY": 4, "height": 5}},
    {"combine": "MACRO_COMBINE_ADD", "ridge":
      {"crest": {"vertices": [{"x": 0, "y": 0}, {"x": 4, "y": 1}]},
       "halfWidth": 2, "height": 1}},
    {"combine": "MACRO_COMBINE_ADD", "boss": {"outline": {"vertices":
      [{"x": 0, "y": 0}, {"x": 4, "y": 1}, {"x": 2, "y": 7}]},
       "flankWidth": 2, "height": 1}},
    {"combine": "MACRO_COMBINE_ADD", "controlNet":
      {"basis": "SPLINE_BASIS_BEZIER", "degree": 1, "columns": 2, "rows": 2,
       "heights": [1, 2, 3, 4], "minimum": {"x": 0, "y": 0},
       "maximum": {"x": 9, "y": 9}}},
    {"combine": "MACRO_COMBINE_ADD", "raster":
      {"rasterId": "sha256:known", "interpolation": "INTERPOLATION_BSPLINE"}},
    {"combine": "MACRO_COMBINE_ADD", "profile":
      {"heights": [1, 2, 3], "firstX": -1, "stepX": 4,
       "interpolation": "INTERPOLATION_CATMULL_ROM"}}
  ]},
  "discreteConstraints": [{"x": -3, "y": 6, "level": 2, "radius": 1.5}],
  "continuousConstraints": [
    {"quantity": "CONSTRAINT_QUANTITY_ROUGHNESS", "target": 0.95, "falloff": 2,
     "reach": 3, "norm": "DISTANCE_NORM_L2", "edge": "REACH_EDGE_SMOOTH",
     "point": {"x": 1, "y": 1}},
    {"quantity": "CONSTRAINT_QUANTITY_FIDELITY", "target": 0.05, "reach": 3,
     "norm": "DISTANCE_NORM_L1", "edge": "REACH_EDGE_STEP",
     "polyline": {"vertices": [{"x": 0, "y": 0}, {"x": 4, "y": 1}]}},
    {"quantity": "CONSTRAINT_QUANTITY_FIDELITY", "target": 0.05, "reach": 3,
     "norm": "DISTANCE_NORM_L1", "edge": "REACH_EDGE_STEP",
     "polygon": {"vertices":
       [{"x": 0, "y": 0}, {"x": 4, "y": 1}, {"x": 2, "y": 7}]}}
  ]})";

TEST_F(TerrainConvertTest, RoundTripOfAResolvedRecipeIsTheIdentity) {
  const auto recipe = FromJson<v1::TerrainRecipe>(kResolvedTerrain);
  const ReadRecipe read = Read(kResolvedTerrain);
  ASSERT_THAT(violations_.kept(), IsEmpty());
  const v1::TerrainRecipe written = WriteTerrainRecipe(read.spec, read);
  google::protobuf::util::MessageDifferencer differencer;
  std::string difference;
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(recipe, written)) << difference;
  EXPECT_EQ(RecipeHash(recipe), RecipeHash(written));
}

constexpr char kResolvedSpots[] = R"({
  "dimensions": 2, "source": "FRACTAL_SOURCE_SUCCESSIVE",
  "mapping": "HEIGHT_MAPPING_LINEAR", "macro": {},
  "discreteMethod": "DISCRETE_METHOD_CONDITION",
  "spots": {
    "points": [{"x": 1, "y": 2, "height": 3},
               {"x": -4, "y": 5.5, "height": -6, "standardError": 0.25}],
    "tableId": "sha256:table",
    "lines": [
      {"vertices": [{"x": 0, "y": 0}, {"x": 4, "y": 1}], "heights": [9, 2],
       "spacing": 0.5, "standardError": 0.1, "onlyFalls": true},
      {"vertices": [{"x": 1, "y": 1}, {"x": 2, "y": 7}, {"x": 3, "y": 3}]}],
    "level": 6}})";

TEST_F(TerrainConvertTest, SpotHeightsAreRead) {
  const ReadRecipe read = Read(kResolvedSpots);
  const core::SpotHeights& spots = read.spec.spots;
  EXPECT_THAT(spots.points, ElementsAre(core::SpotHeight{{1, 2}, 3, 0},
                                        core::SpotHeight{{-4, 5.5}, -6, 0.25}));
  ASSERT_NE(spots.table, nullptr);
  EXPECT_THAT(*spots.table, SizeIs(2));
  EXPECT_EQ(read.spot_table_id, "sha256:table");
  ASSERT_THAT(spots.lines, SizeIs(2));
  EXPECT_THAT(spots.lines[0].vertices,
              ElementsAre(core::Point2{0, 0}, core::Point2{4, 1}));
  EXPECT_THAT(spots.lines[0].heights, ElementsAre(9, 2));
  EXPECT_EQ(spots.lines[0].spacing, 0.5);
  EXPECT_EQ(spots.lines[0].standard_error, 0.1);
  EXPECT_TRUE(spots.lines[0].only_falls);
  EXPECT_THAT(spots.lines[1].heights, IsEmpty());
  EXPECT_EQ(spots.level, 6);
  EXPECT_EQ(read.spec.discrete_method, core::DiscreteMethod::kCondition);
}

TEST_F(TerrainConvertTest, RoundTripOfResolvedSpotsIsTheIdentity) {
  const auto recipe = FromJson<v1::TerrainRecipe>(kResolvedSpots);
  const ReadRecipe read = Read(kResolvedSpots);
  v1::TerrainRecipe written = WriteTerrainRecipe(read.spec, read);
  google::protobuf::util::MessageDifferencer differencer;
  std::string difference;
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(recipe, written)) << difference;
  EXPECT_EQ(RecipeHash(recipe), RecipeHash(written));
}

TEST_F(TerrainConvertTest, RecipeWithoutSpotsSaysNothingOfThem) {
  const ReadRecipe read = Read(R"({"spots": {"level": 3}})");
  const v1::TerrainRecipe written = WriteTerrainRecipe(read.spec, read);
  EXPECT_FALSE(written.has_spots());
  EXPECT_EQ(written.discrete_method(), v1::DISCRETE_METHOD_UNSPECIFIED);
}

TEST_F(TerrainConvertTest, MissingSpotTableIsNamedAndNotAViolation) {
  const ReadRecipe read = Read(R"({"spots": {"tableId": "sha256:gone"}})");
  EXPECT_THAT(violations_.kept(), IsEmpty());
  EXPECT_EQ(read.missing_spot_table, "sha256:gone");
}

TEST_F(TerrainConvertTest, TooManyInlineSpotsAreNotEvenConverted) {
  v1::TerrainRecipe recipe;
  for (int i = 0; i < 10'001; ++i) {
    recipe.mutable_spots()->add_points();
    recipe.mutable_spots()->add_lines();
  }
  const ReadRecipe read =
      ReadTerrainRecipe(recipe, sources_, {}, "", &violations_);
  EXPECT_THAT(violations_.kept(),
              ElementsAre(core::Violation{"spots.points",
                                          "must have at most 10000 elements, "
                                          "got 10001"},
                          core::Violation{"spots.lines",
                                          "must have at most 10000 elements, "
                                          "got 10001"}));
  EXPECT_TRUE(read.spec.spots.empty());
}

TEST_F(TerrainConvertTest, UnsetFieldsTakeTheDocumentedDefaults) {
  const ReadRecipe read = Read(R"({
    "frame": {"originX": 3},
    "macro": {"parts": [{"gaussianHill": {"sigmaX": 2, "height": 1}},
      {"controlNet": {"columns": 4, "rows": 4,
        "heights": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0], "maximum": {"x": 1, "y": 1}}},
      {"raster": {"rasterId": "sha256:known"}},
      {"profile": {"heights": [1, 2], "stepX": 1}}]},
    "continuousConstraints": [{"quantity": "CONSTRAINT_QUANTITY_FIDELITY",
      "reach": 1, "point": {}}]})");
  ASSERT_THAT(violations_.kept(), IsEmpty());
  const core::TerrainSpec& spec = read.spec;
  EXPECT_EQ(spec.dimensions, 2);
  EXPECT_EQ(spec.source, core::FractalSource::kSubdivision);
  EXPECT_EQ(spec.mapping, core::HeightMapping::kLinear);
  EXPECT_FALSE(spec.roughness.has_value());
  EXPECT_FALSE(spec.domain.has_value());
  EXPECT_EQ(spec.frame, (core::Frame{3, 0, 1, 1}));
  const auto& parts = spec.macro.parts;
  EXPECT_EQ(std::get<core::GaussianHill>(parts[0].shape).sigma_y, 2);
  EXPECT_EQ(std::get<core::ControlNet>(parts[1].shape).degree, 3);
  EXPECT_EQ(std::get<core::ControlNet>(parts[1].shape).basis,
            core::SplineBasis::kBSplineClamped);
  EXPECT_EQ(std::get<core::RasterShape>(parts[2].shape).interpolation,
            core::Interpolation::kCatmullRom);
  EXPECT_EQ(std::get<core::Profile>(parts[3].shape).interpolation,
            core::Interpolation::kBilinear);
  EXPECT_EQ(parts[0].combine, core::MacroCombine::kAdd);
  EXPECT_EQ(spec.continuous_constraints[0].norm, core::DistanceNorm::kL1);
  EXPECT_EQ(spec.continuous_constraints[0].edge, core::ReachEdge::kStep);
}

TEST_F(TerrainConvertTest, UnknownEnumNumbersAreViolationsWithTheirValue) {
  Read(R"({"source": 17, "mapping": 9, "discreteMethod": 3,
    "macro": {"parts": [{"combine": 8, "plane": {}},
                        {"profile": {"heights": [1, 2], "stepX": 1,
                                     "interpolation": 7}}]},
    "continuousConstraints": [{"quantity": 6, "target": 0.5, "reach": 1,
                               "norm": 5, "edge": 4, "point": {}}]})");
  const auto unknown = [](const char* field, const char* value) {
    return core::Violation{
        std::string("terrain.recipe.") + field,
        std::string("must be a value that the API knows, got ") + value};
  };
  EXPECT_THAT(violations_.kept(),
              ElementsAre(unknown("source", "17"), unknown("mapping", "9"),
                          unknown("macro.parts[0].combine", "8"),
                          unknown("macro.parts[1].profile.interpolation", "7"),
                          unknown("discrete_method", "3"),
                          unknown("continuous_constraints[0].quantity", "6"),
                          unknown("continuous_constraints[0].norm", "5"),
                          unknown("continuous_constraints[0].edge", "4")));
}

TEST_F(TerrainConvertTest, AllViolationsComeInOnePass) {
  Read(R"({"dimensions": 3, "roughness": 1.7, "fidelity": -1, "sigma": "NaN",
    "macro": {"base": "Infinity", "parts": [{}, {"cone": {"radius": -2}}]},
    "continuousConstraints": [{"reach": 0}]})");
  std::vector<std::string> fields;
  for (const core::Violation& one : violations_.kept()) {
    fields.push_back(one.field);
  }
  for (const char* field :
       {"dimensions", "roughness", "fidelity", "sigma", "macro.base",
        "macro.parts[1].cone.radius", "continuous_constraints[0].quantity",
        "continuous_constraints[0].reach"}) {
    EXPECT_THAT(fields, Contains(std::string("terrain.recipe.") + field));
  }
}

TEST_F(TerrainConvertTest, TooManyElementsAreNotEvenConverted) {
  v1::TerrainRecipe recipe;
  for (int i = 0; i < 1001; ++i) recipe.mutable_macro()->add_parts();
  for (int i = 0; i < 10'001; ++i) {
    recipe.add_discrete_constraints();
    recipe.add_continuous_constraints();
  }
  const ReadRecipe read =
      ReadTerrainRecipe(recipe, sources_, {}, "", &violations_);
  EXPECT_THAT(
      violations_.kept(),
      ElementsAre(
          core::Violation{"macro.parts",
                          "must have at most 1000 elements, got 1001"},
          core::Violation{"discrete_constraints",
                          "must have at most 10000 elements, got 10001"},
          core::Violation{"continuous_constraints",
                          "must have at most 10000 elements, got 10001"}));
  EXPECT_THAT(read.spec.macro.parts, IsEmpty());
  EXPECT_THAT(read.spec.discrete_constraints, IsEmpty());
  EXPECT_THAT(read.spec.continuous_constraints, IsEmpty());
}

TEST_F(TerrainConvertTest, ReferenceSystemIsCarriedAndBounded) {
  EXPECT_EQ(Read(R"({"frame": {"crs": "EPSG:25832"}})").crs, "EPSG:25832");
  EXPECT_THAT(violations_.kept(), IsEmpty());
  Read(R"({"frame": {"crs": ")" + std::string(16 * 1024 + 1, 'x') + "\"}}");
  EXPECT_THAT(
      violations_.kept(),
      ElementsAre(core::Violation{"terrain.recipe.frame.crs",
                                  "must have at most 16384 bytes, got 16385"}));
}

TEST_F(TerrainConvertTest, RefinementTakesTheModelsReferenceSystem) {
  const ReadRecipe read = Read(R"({"refinement": {}, "macro": {"parts":
    [{"raster": {"rasterId": "sha256:known"}}]}})");
  EXPECT_THAT(violations_.kept(), IsEmpty());
  EXPECT_EQ(read.crs, "EPSG:32617");
}

TEST_F(TerrainConvertTest, MissingRasterIsNamedAndNotAViolation) {
  const ReadRecipe read = Read(R"({"macro": {"parts":
    [{"raster": {"rasterId": "sha256:gone"}},
     {"raster": {"rasterId": "sha256:lost"}}]}})");
  EXPECT_THAT(violations_.kept(), IsEmpty());
  EXPECT_EQ(read.missing_raster, "sha256:gone");
}

// What is not kept can be uploaded; what is wrong cannot.
TEST_F(TerrainConvertTest, MissingContentHidesNoViolation) {
  const ReadRecipe read = Read(R"({"roughness": 2, "refinement": {},
    "macro": {"parts": [{"raster": {"rasterId": "sha256:gone"}}]},
    "spots": {"tableId": "sha256:gone", "points": [{"height": "NaN"}],
              "lines": [{"vertices": [{}, {"x": 1e9}]}]}})");
  EXPECT_THAT(
      violations_.kept(),
      ElementsAre(Field(&core::Violation::field, "terrain.recipe.roughness"),
                  Field(&core::Violation::field,
                        "terrain.recipe.spots.points[0].height")));
  EXPECT_EQ(read.missing_raster, "sha256:gone");
  EXPECT_EQ(read.missing_spot_table, "sha256:gone");
}

TEST_F(TerrainConvertTest, AMissingModelsLatticeIsNotGuessedAt) {
  Read(R"({"refinement": {}, "domain": {"cellsX": "7", "cellsY": "7"},
    "macro": {"parts": [{"raster": {"rasterId": "sha256:gone"}}]},
    "spots": {"level": 9, "lines": [{"vertices": [{}, {"x": 7, "y": 7}]}]}})");
  EXPECT_THAT(violations_.kept(), IsEmpty());
  Read(R"({"refinement": {}, "spots": {"lines": [{"vertices":
    [{}, {"x": 1e9}]}]},
    "macro": {"parts": [{"raster": {"rasterId": "sha256:gone"}}]}})");
  EXPECT_THAT(violations_.kept(), IsEmpty());
}

TEST_F(TerrainConvertTest, RasterWithoutIdIsAViolation) {
  Read(R"({"macro": {"parts": [{"raster": {}}]}})");
  EXPECT_THAT(
      violations_.kept(),
      Contains(Field(&core::Violation::field,
                     "terrain.recipe.macro.parts[0].raster.raster_id")));
}

TEST(ContentHashTest, IsSha256) {
  ContentHash hash;
  hash.Add("a");
  hash.Add("bc");
  EXPECT_EQ(hash.Finish(),
            "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61"
            "f20015ad");
}

// SHA-256 of 08 02, 10 2a, 29 and 0.8 as float64 LE. A change here breaks every
// stored recipe hash.
TEST(ContentHashTest, RecipeHashIsStable) {
  EXPECT_EQ(RecipeHash(FromJson<v1::TerrainRecipe>(
                R"({"dimensions": 2, "seed": "42", "roughness": 0.8})")),
            "sha256:190b25b816610b1d99517700c03e13a00d91f8431032"
            "94a9b95ae2486ebe45ad");
}

}  // namespace
}  // namespace terrane::server
