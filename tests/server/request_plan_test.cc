// Requests checked and cut into tiles: every violation of a request by its
// path, sums that do not overflow, tiles that cover exactly what was asked for.
#include "server/convert/request_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A violation of this field.
auto Field(const char* name) {
  return ::testing::Field("field", &core::Violation::field, name);
}

constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();

class RequestPlanTest : public ::testing::Test {
 protected:
  TilePlan Plan(const std::string& json, bool bounded = false) {
    core::TerrainSpec spec;
    if (bounded) spec.domain = core::Domain{4, 2};
    return PlanTiles(FromJson<v1::StreamTilesRequest>(json), &spec, limits_, "",
                     &violations_);
  }

  // The violations of a request as "field: description", which it must have.
  std::vector<std::string> Wrong(const std::string& json,
                                 bool bounded = false) {
    violations_ = {};
    Plan(json, bounded);
    std::vector<std::string> lines;
    for (const core::Violation& one : violations_.kept()) {
      lines.push_back(one.field + ": " + one.description);
    }
    return lines;
  }

  Limits limits_;
  core::Violations violations_;
};

TEST_F(RequestPlanTest, WindowIsCutIntoTilesThatShareNothing) {
  const TilePlan plan = Plan(R"({"level": 3, "tileSize": 4,
               "window": {"x": -3, "y": 5, "width": 10, "height": 4}})");
  ASSERT_THAT(violations_.kept(), IsEmpty());
  EXPECT_EQ(plan.columns, 3);
  EXPECT_EQ(plan.rows, 1);
  EXPECT_EQ(plan.TileWindow(0, 0), (core::Window{-3, 5, 4, 4}));
  EXPECT_EQ(plan.TileWindow(2, 0), (core::Window{5, 5, 2, 4}));
}

TEST_F(RequestPlanTest, PointTileRangesShareEdges) {
  const TilePlan plan = Plan(
      R"({"tileSize": 5, "tiles": {"x": -1, "y": 2, "columns": 2, "rows": 1}})");
  ASSERT_THAT(violations_.kept(), IsEmpty());
  EXPECT_EQ(plan.whole, (core::Window{-4, 8, 9, 5}));
  EXPECT_EQ(plan.TileWindow(0, 0), (core::Window{-4, 8, 5, 5}));
  EXPECT_EQ(plan.TileWindow(1, 0), (core::Window{0, 8, 5, 5}));
}

TEST_F(RequestPlanTest, AreaTileRangesShareNothing) {
  const TilePlan plan = Plan(R"({"tileSize": 5, "sampling": "SAMPLING_AREA",
               "tiles": {"x": -1, "y": 2, "columns": 2, "rows": 1}})");
  ASSERT_THAT(violations_.kept(), IsEmpty());
  EXPECT_EQ(plan.whole, (core::Window{-5, 10, 10, 5}));
  EXPECT_EQ(plan.TileWindow(1, 0), (core::Window{0, 10, 5, 5}));
}

TEST_F(RequestPlanTest, WholeDomainIsTheDefault) {
  EXPECT_EQ(Plan(R"({"level": 2})", true).whole, (core::Window{0, 0, 17, 9}));
  EXPECT_EQ(Plan(R"({"level": 2, "sampling": "SAMPLING_AREA"})", true).whole,
            (core::Window{0, 0, 16, 8}));
  EXPECT_THAT(violations_.kept(), IsEmpty());
  EXPECT_THAT(Wrong("{}"),
              ElementsAre("window: must be set, or tiles, when the terrain is "
                          "endless"));
}

TEST_F(RequestPlanTest, EachFieldOutsideItsRangeIsNamed) {
  EXPECT_THAT(
      Wrong(R"({"level": 41, "tileSize": 1026, "sampling": 3, "encoding": 9,
                "window": {"width": 1, "height": 1}})"),
      ElementsAre("level: must be in [0, 40], got 41",
                  "sampling: must be a value that the API knows, got 3",
                  "tile_size: must be in [1, 1025], got 1026",
                  "encoding: must be a value that the API knows, got 9"));
  EXPECT_THAT(Wrong(R"({"level": -1, "tileSize": 1,
                "tiles": {"columns": 1, "rows": 1}})"),
              ElementsAre("level: must be in [0, 40], got -1",
                          "tile_size: must be in [2, 1025], got 1"));
  EXPECT_THAT(
      Wrong(R"({"window": {"width": 0, "height": -5}})"),
      ElementsAre("window.width: must be in [1, 4503599627370496], got 0",
                  "window.height: must be in [1, 4503599627370496], got -5"));
  EXPECT_THAT(
      Wrong(R"({"tileSize": 3, "tiles": {"columns": 0, "rows": -5}})"),
      ElementsAre("tiles.columns: must be in [1, 2251799813685247], got 0",
                  "tiles.rows: must be in [1, 2251799813685247], got -5"));
}

// A user mends a request once: a wrong field hides no other one.
TEST_F(RequestPlanTest, NoFieldHidesAnother) {
  EXPECT_THAT(
      Wrong(R"({"level": 41, "tileSize": -1, "firstTile": -1,
                "window": {"x": "-9000000000000000", "width": -1,
                           "y": "9000000000000000", "height": 0}})"),
      ElementsAre("level: must be in [0, 40], got 41",
                  "tile_size: must be in [1, 1025], got -1",
                  "window.x: must be in [-4503599627370496, "
                  "4503599627370495], got -9000000000000000",
                  "window.width: must be in [1, 9007199254740992], got -1",
                  "window.y: must be in [-4503599627370496, "
                  "4503599627370495], got 9000000000000000",
                  "window.height: must be in [1, 9007199254740992], got 0",
                  "first_tile: must be in [0, 9223372036854775807], got -1"));
  EXPECT_THAT(Wrong(R"({"tileSize": 1, "tiles": {"x": -1, "columns": 0,
                        "y": 5, "rows": -2}})",
                    true),
              ElementsAre("tile_size: must be in [2, 1025], got 1",
                          "tiles.x: must be in [0, 3], got -1",
                          "tiles.columns: must be in [1, 4], got 0",
                          "tiles.y: must be in [0, 1], got 5",
                          "tiles.rows: must be in [1, 2], got -2"));
  EXPECT_THAT(
      Wrong(R"({"tileSize": 4, "tiles": {"columns": 1, "rows": 1}})", true),
      ElementsAre("tile_size: must be in [2, 3], got 4"));
  EXPECT_THAT(Wrong(R"({"window": {"width": 1, "height": 1}, "encoding": 9,
                        "range": {"minimum": 5, "maximum": 5}})"),
              ElementsAre("encoding: must be a value that the API knows, got 9",
                          "range.maximum: must be above minimum 5, got 5"));
  core::TerrainSpec line;
  line.dimensions = 1;
  line.domain = core::Domain{3, 0};
  violations_ = {};
  PlanProfile(
      FromJson<v1::GetProfileRequest>(R"({"first": -1, "count": 400001})"),
      &line, limits_, "", &violations_);
  EXPECT_THAT(violations_.kept(), ElementsAre(Field("count"), Field("first")));
}

TEST_F(RequestPlanTest, RangeIsCheckedForSixteenBitsOnly) {
  EXPECT_THAT(Wrong(R"({"window": {"width": 1, "height": 1},
                        "range": {"minimum": 5, "maximum": 5}})"),
              IsEmpty());
  EXPECT_THAT(Wrong(R"({"encoding": "HEIGHT_ENCODING_UINT16_LE",
                "window": {"width": 1, "height": 1},
                "range": {"minimum": 5, "maximum": 5}})"),
              ElementsAre("range.maximum: must be above minimum 5, got 5"));
  EXPECT_THAT(
      Wrong(R"({"encoding": "HEIGHT_ENCODING_UINT16_LE",
                "window": {"width": 1, "height": 1},
                "range": {"minimum": "NaN", "maximum": "Infinity"}})"),
      ElementsAre("range.minimum: must be in [-1e+12, 1e+12], got nan",
                  "range.maximum: must be in [-1e+12, 1e+12], got inf"));
}

TEST_F(RequestPlanTest, IndicesStayWithinTwoToTheFiftyTwo) {
  EXPECT_THAT(Wrong(R"({"window": {"x": "4503599627370495", "width": 2,
                "height": 1}})"),
              ElementsAre("window.width: must be in [1, 1], got 2"));
  EXPECT_THAT(Wrong(R"({"window": {"x": "-4503599627370497", "width": 1,
                        "height": 1}})"),
              ElementsAre("window.x: must be in [-4503599627370496, "
                          "4503599627370495], got -4503599627370497"));
  EXPECT_THAT(Wrong(R"({"tileSize": 257, "tiles":
                {"x": "17592186044415", "columns": 1, "rows": 1}})"),
              ElementsAre("tiles.x: must be in [-17592186044416, "
                          "17592186044414], got 17592186044415"));
}

TEST_F(RequestPlanTest, ExtremeNumbersDoNotOverflow) {
  for (const std::int64_t x : {-kHuge - 1, -kHuge, std::int64_t{0}, kHuge}) {
    for (const std::int64_t size :
         {-kHuge - 1, std::int64_t{1} << 52, kHuge - 1, kHuge}) {
      v1::StreamTilesRequest request;
      request.set_first_tile(kHuge);
      request.mutable_window()->set_x(x);
      request.mutable_window()->set_y(x);
      request.mutable_window()->set_width(size);
      request.mutable_window()->set_height(size);
      const core::TerrainSpec spec;
      core::Violations window_violations;
      PlanTiles(request, &spec, limits_, "", &window_violations);
      EXPECT_FALSE(window_violations.empty()) << x << " " << size;
      request.mutable_tiles()->set_x(x);
      request.mutable_tiles()->set_y(x);
      request.mutable_tiles()->set_columns(size);
      request.mutable_tiles()->set_rows(size);
      core::Violations tiles_violations;
      PlanTiles(request, &spec, limits_, "", &tiles_violations);
      EXPECT_FALSE(tiles_violations.empty()) << x << " " << size;
    }
  }
}

TEST_F(RequestPlanTest, StreamsHoldALimitedNumberOfSamples) {
  EXPECT_THAT(Wrong(R"({"window": {"width": 262145, "height": 262144}})"),
              ElementsAre("window: must have at most 68719476736 samples, got "
                          "68719738880"));
  EXPECT_THAT(Wrong(R"({"tileSize": 2, "tiles": {"columns": "1000000000000",
                        "rows": "1000000000000"}})"),
              ElementsAre("tiles: must have at most 68719476736 samples, got "
                          "more than 2^63"));
}

TEST_F(RequestPlanTest, WindowsStayInsideABoundedDomain) {
  EXPECT_THAT(Wrong(R"({"window": {"x": 4, "width": 1, "height": 3}})", true),
              IsEmpty());
  EXPECT_THAT(
      Wrong(R"({"window": {"x": 5, "y": -1, "width": 1, "height": 3}})", true),
      ElementsAre("window.x: must be in [0, 4], got 5",
                  "window.y: must be in [0, 2], got -1"));
  EXPECT_THAT(Wrong(R"({"window": {"x": 1, "width": 5, "height": 1}})", true),
              ElementsAre("window.width: must be in [1, 4], got 5"));
  EXPECT_THAT(
      Wrong(R"({"tileSize": 3, "tiles": {"columns": 3, "rows": 1}})", true),
      ElementsAre("tiles.columns: must be in [1, 2], got 3"));
}

TEST_F(RequestPlanTest, FirstTileIsWithinTheRequest) {
  EXPECT_THAT(Wrong(R"({"tileSize": 2, "firstTile": 4,
                        "window": {"width": 4, "height": 4}})"),
              IsEmpty());
  EXPECT_THAT(Wrong(R"({"tileSize": 2, "firstTile": 5,
                        "window": {"width": 4, "height": 4}})"),
              ElementsAre("first_tile: must be in [0, 4], got 5"));
  EXPECT_THAT(Wrong(R"({"tileSize": 2, "firstTile": -1,
                        "window": {"width": 4, "height": 4}})"),
              ElementsAre("first_tile: must be in [0, 4], got -1"));
}

TEST_F(RequestPlanTest, NothingOfABadRecipeIsUsed) {
  PlanTiles(FromJson<v1::StreamTilesRequest>(R"({"level": 41})"), nullptr,
            limits_, "request.", &violations_);
  EXPECT_THAT(violations_.kept(),
              ElementsAre(core::Violation{"request.level",
                                          "must be in [0, 40], got 41"}));
}

TEST_F(RequestPlanTest, TilesNeedTwoDimensionsAndProfilesOne) {
  core::TerrainSpec line;
  line.dimensions = 1;
  line.domain = core::Domain{3, 0};
  PlanTiles({}, &line, limits_, "", &violations_);
  EXPECT_EQ(violations_.kept().front(),
            (core::Violation{"terrain", "must have 2 dimensions, got 1"}));
  violations_ = {};
  PlanProfile(FromJson<v1::GetProfileRequest>(R"({"count": 3})"),
              std::make_unique<core::TerrainSpec>().get(), limits_, "",
              &violations_);
  EXPECT_THAT(
      violations_.kept(),
      ElementsAre(core::Violation{"terrain", "must have 1 dimension, got 2"}));
}

TEST_F(RequestPlanTest, ProfileDefaultsToTheWholeDomain) {
  core::TerrainSpec line;
  line.dimensions = 1;
  line.domain = core::Domain{3, 0};
  v1::GetProfileRequest request;
  request.set_level(2);
  EXPECT_EQ(PlanProfile(request, &line, limits_, "", &violations_).window,
            (core::Window{0, 0, 13, 1}));
  EXPECT_THAT(violations_.kept(), IsEmpty());
  request.set_level(20);
  PlanProfile(request, &line, limits_, "", &violations_);
  EXPECT_THAT(violations_.kept(),
              ElementsAre(core::Violation{
                  "count", "must be in [1, 400000], got 3145729"}));
  violations_ = {};
  line.domain.reset();
  PlanProfile(request, &line, limits_, "", &violations_);
  EXPECT_THAT(violations_.kept(),
              ElementsAre(core::Violation{
                  "count", "must be set when the terrain is endless"}));
}

TEST_F(RequestPlanTest, PointsAreCountedAndFinite) {
  const core::TerrainSpec spec;
  PlanHeights(FromJson<v1::GetHeightsRequest>(
                  R"({"points": [{"x": 1}, {"x": 1, "y": "NaN"}]})"),
              &spec, limits_, "", &violations_);
  EXPECT_THAT(violations_.kept(),
              ElementsAre(core::Violation{
                  "points[1].y", "must be in [-1e+15, 1e+15], got nan"}));
  violations_ = {};
  v1::GetHeightsRequest many;
  for (int i = 0; i <= limits_.max_points; ++i) many.add_points();
  EXPECT_THAT(PlanHeights(many, &spec, limits_, "", &violations_), IsEmpty());
  EXPECT_THAT(violations_.kept(),
              ElementsAre(core::Violation{
                  "points", "must have at most 100000 elements, got 100001"}));
}

// Counted one by one, the remaining tiles are those of the kinds.
TEST_F(RequestPlanTest, RemainingTilesCountEveryTileOnce) {
  TilePlan plan =
      Plan(R"({"tileSize": 4, "window": {"width": 11, "height": 14}})");
  for (plan.first_tile = 0; plan.first_tile <= plan.total();
       ++plan.first_tile) {
    std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> by_size;
    for (std::int64_t i = plan.first_tile; i < plan.total(); ++i) {
      const core::Window tile =
          plan.TileWindow(i % plan.columns, i / plan.columns);
      ++by_size[{tile.width, tile.height}];
    }
    std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> counted;
    for (const TileKind& kind : RemainingTiles(plan)) {
      counted[{kind.example.width, kind.example.height}] += kind.count;
    }
    EXPECT_EQ(by_size, counted) << plan.first_tile;
  }
}

TEST(SampleFrameTest, AreaSamplesSitAtCellCentres) {
  const core::Frame frame{10, 20, 8, -4};
  EXPECT_EQ(SampleFrame(frame, 1, core::Sampling::kPoint),
            (core::Frame{10, 20, 4, -2}));
  EXPECT_EQ(SampleFrame(frame, 1, core::Sampling::kArea),
            (core::Frame{12, 19, 4, -2}));
}

}  // namespace
}  // namespace terrane::server
