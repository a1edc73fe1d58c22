// Spot heights from CSV files and vector layers: what is taken, and how what is
// wrong is named.
#include "client/spot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class SpotFileTest : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    const std::string path = folder_.File(name);
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  absl::StatusOr<SpotFile> ReadCsv(const std::string& text,
                                   SpotFileOptions options = {},
                                   int dimensions = 2) {
    options.path = Write("spots.csv", text);
    return ReadSpotFile(options, dimensions);
  }
  std::string CsvError(const std::string& text,
                       const SpotFileOptions& options = {}) {
    return std::string(ReadCsv(text, options).status().message());
  }
  // A GeoJSON file of features, each "GEOMETRY|PROPERTIES" as JSON.
  absl::StatusOr<SpotFile> ReadJson(
      const std::vector<std::pair<std::string, std::string>>& features,
      SpotFileOptions options = {}) {
    std::string text = R"({"type": "FeatureCollection", "features": [)";
    for (const auto& [geometry, properties] : features) {
      if (text.back() == '}') text += ",";
      text += R"({"type": "Feature", "geometry": )" + geometry +
              R"(, "properties": )" + properties + "}";
    }
    options.path = Write("spots.geojson", text + "]}");
    return ReadSpotFile(options, 2);
  }
  std::string JsonError(
      const std::vector<std::pair<std::string, std::string>>& features,
      const SpotFileOptions& options = {}) {
    return std::string(ReadJson(features, options).status().message());
  }

  TemporaryFolder folder_;
};

TEST_F(SpotFileTest, CsvColumnsAreFoundByNameInAnyOrderAndCase) {
  const auto spots = ReadCsv(
      "\xEF\xBB\xBFid,Z,\"X\", y ,SE\r\n"
      "\"a, \"\"b\"\"\",3,1,2,0.5\r\n"
      "\r\n"
      ",-6.5,4, 5e1 ,0\n");
  ASSERT_TRUE(spots.ok()) << spots.status();
  EXPECT_THAT(spots->table.x, ElementsAre(1, 4));
  EXPECT_THAT(spots->table.y, ElementsAre(2, 50));
  EXPECT_THAT(spots->table.height, ElementsAre(3, -6.5));
  EXPECT_THAT(spots->table.standard_error, ElementsAre(0.5, 0));
  EXPECT_THAT(spots->table.source, ElementsAre(2, 4));
  EXPECT_EQ(spots->PlaceOf(4), folder_.File("spots.csv") + " line 4");
  EXPECT_EQ(spots->crs, "");
}

TEST_F(SpotFileTest, CsvColumnsCanBeChosen) {
  const std::string text = "x,y,z,top,noise\n1,2,3,4,5\n";
  const auto chosen = ReadCsv(text, {.field = "Top", .error_field = "noise"});
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_THAT(chosen->table.height, ElementsAre(4));
  EXPECT_THAT(chosen->table.standard_error, ElementsAre(5));
  EXPECT_THAT(ReadCsv(text)->table.standard_error, IsEmpty());
  EXPECT_EQ(ReadCsv(text, {.crs = "EPSG:4326"})->crs, "EPSG:4326");
}

TEST_F(SpotFileTest, LineNeedsNoY) {
  const auto line = ReadCsv("x,z\n1,3\n", {}, 1);
  ASSERT_TRUE(line.ok()) << line.status();
  EXPECT_THAT(line->table.y, ElementsAre(0));
  EXPECT_THAT(CsvError("x,z\n1,3\n"), HasSubstr("must name a column y"));
}

TEST_F(SpotFileTest, CsvErrorsNameTheLine) {
  EXPECT_THAT(CsvError("x,y,z\n1,2,3\n\n4,5,high\n"),
              HasSubstr("spots.csv line 4: column z must be a finite number, "
                        "got \"high\""));
  EXPECT_THAT(CsvError("x,y,z\n1,2\n"), HasSubstr("line 2: column z"));
  EXPECT_THAT(CsvError("x,y,z\n1,nan,2\n"), HasSubstr("line 2: column y"));
  EXPECT_THAT(CsvError("x,y,z,se\n1,2,3,\n"),
              HasSubstr("line 2: column standard_error"));
  EXPECT_THAT(CsvError("1,2,3\n4,5,6\n"),
              HasSubstr("line 1: must name a column x, got \"1,2,3\""));
  EXPECT_THAT(CsvError("x,y,X,z\n"),
              HasSubstr("line 1: names the column X more than once"));
  EXPECT_THAT(CsvError("x,y,z\n"), HasSubstr("no row"));
  EXPECT_THAT(CsvError("x,y,z\n1,2,3\n", {.field = "h"}),
              HasSubstr("must name a column h"));
}

TEST_F(SpotFileTest, MissingFileIsNotFound) {
  for (const char* name : {"none.csv", "none.gpkg"}) {
    const auto spots = ReadSpotFile({.path = folder_.File(name)}, 2);
    EXPECT_EQ(spots.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(std::string(spots.status().message()), HasSubstr(name));
  }
}

TEST_F(SpotFileTest, LayerGivesPointsAndLines) {
  const auto spots = ReadJson({
      {R"({"type": "Point", "coordinates": [1, 2, 3]})", "{}"},
      {R"({"type": "MultiPoint", "coordinates": [[4, 5, 6], [7, 8, 9]]})",
       "{}"},
      {R"({"type": "LineString", "coordinates": [[0, 0, 9], [1, 1, 8]]})",
       "{}"},
  });
  ASSERT_TRUE(spots.ok()) << spots.status();
  EXPECT_THAT(spots->table.x, ElementsAre(1, 4, 7));
  EXPECT_THAT(spots->table.y, ElementsAre(2, 5, 8));
  EXPECT_THAT(spots->table.height, ElementsAre(3, 6, 9));
  EXPECT_THAT(spots->table.standard_error, IsEmpty());
  EXPECT_THAT(spots->table.source, ElementsAre(0, 1, 1));
  ASSERT_THAT(spots->lines, SizeIs(1));
  EXPECT_THAT(spots->lines[0].x, ElementsAre(0, 1));
  EXPECT_THAT(spots->lines[0].height, ElementsAre(9, 8));
  EXPECT_EQ(spots->PlaceOf(1), folder_.File("spots.geojson") + " feature 1");
  EXPECT_THAT(spots->crs, HasSubstr("WGS 84"));
}

// Contour lines: the height is the feature's, and wins over a Z.
TEST_F(SpotFileTest, FieldIsTheHeightOfTheWholeFeature) {
  const auto spots = ReadJson(
      {{R"({"type": "LineString", "coordinates": [[0, 0], [1, 1], [2, 0]]})",
        R"({"elevation": 120, "error": 0.5})"},
       {R"({"type": "Point", "coordinates": [1, 2, 3]})",
        R"({"elevation": 7.25, "error": 0})"}},
      {.field = "ELEVATION", .error_field = "error"});
  ASSERT_TRUE(spots.ok()) << spots.status();
  EXPECT_THAT(spots->lines[0].height, ElementsAre(120, 120, 120));
  EXPECT_EQ(spots->lines[0].standard_error, 0.5);
  EXPECT_THAT(spots->table.height, ElementsAre(7.25));
  EXPECT_THAT(spots->table.standard_error, ElementsAre(0));
}

TEST_F(SpotFileTest, LayerErrorsNameTheFeature) {
  const std::string flat = R"({"type": "Point", "coordinates": [1, 2]})";
  const std::string good = R"({"type": "Point", "coordinates": [1, 2, 3]})";
  const std::string area =
      R"({"type": "Polygon", "coordinates":
          [[[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 0, 1]]]})";
  EXPECT_THAT(JsonError({{good, "{}"}, {flat, "{}"}}),
              HasSubstr("feature 1: has no Z; name the field"));
  EXPECT_THAT(JsonError({{good, "{}"}, {area, "{}"}}),
              HasSubstr("feature 1: is a POLYGON"));
  EXPECT_THAT(JsonError({{"null", "{}"}}), HasSubstr("feature 0: has no geom"));
  EXPECT_THAT(JsonError({{flat, R"({"h": 1})"}, {flat, R"({"h": null})"}},
                        {.field = "h"}),
              HasSubstr("feature 1: has no value of the field h"));
  EXPECT_THAT(JsonError({{good, R"({"h": 1, "w": "x"})"}}, {.field = "depth"}),
              HasSubstr("has no field depth; its fields are h, w"));
  EXPECT_THAT(JsonError({{good, R"({"w": "x"})"}}, {.field = "w"}),
              HasSubstr("does not hold numbers"));
  EXPECT_THAT(JsonError({{good, "{}"}}, {.layer = "other"}),
              HasSubstr("has no layer other; its layers are"));
}

TEST_F(SpotFileTest, FileThatIsNoLayerIsAnError) {
  const std::string path = Write("spots.gpkg", "no database");
  EXPECT_FALSE(ReadSpotFile({.path = path}, 2).ok());
}

// Longitude 3 degrees is the central meridian of UTM zone 31.
TEST_F(SpotFileTest, CoordinatesAreTransformedXEast) {
  auto spots = ReadCsv("x,y,z\n3,0,77\n3,45,78\n", {.crs = "EPSG:4326"});
  ASSERT_TRUE(spots.ok()) << spots.status();
  spots->lines.push_back({{3}, {0}, {5}, 0, 9});
  ASSERT_TRUE(TransformSpots("EPSG:32631", &*spots).ok());
  EXPECT_NEAR(spots->table.x[0], 500'000, 1e-3);
  EXPECT_NEAR(spots->table.y[0], 0, 1e-3);
  EXPECT_NEAR(spots->table.x[1], 500'000, 1e-3);
  EXPECT_NEAR(spots->table.y[1], 4'982'950.400, 1e-2);
  EXPECT_THAT(spots->table.height, ElementsAre(77, 78));
  EXPECT_NEAR(spots->lines[0].x[0], 500'000, 1e-3);
}

TEST_F(SpotFileTest, KnownToBeTheSameOrUnknownStaysBitForBit) {
  for (const auto& [from, to] :
       {std::pair("EPSG:4326", "EPSG:4326"), std::pair("", "EPSG:32631"),
        std::pair("EPSG:4326", "")}) {
    auto spots = ReadCsv("x,y,z\n0.1,0.2,0.3\n", {.crs = from});
    ASSERT_TRUE(TransformSpots(to, &*spots).ok());
    EXPECT_EQ(spots->table.x[0], 0.1);
    EXPECT_EQ(spots->table.y[0], 0.2);
  }
}

TEST_F(SpotFileTest, WhatCannotBeTransformedIsNamed) {
  auto spots = ReadCsv("x,y,z\n3,0,1\n3,95,1\n", {.crs = "EPSG:4326"});
  EXPECT_THAT(std::string(TransformSpots("EPSG:32631", &*spots).message()),
              HasSubstr("spots.csv line 3: has no place"));
  EXPECT_THAT(std::string(TransformSpots("EPSG:0", &*spots).message()),
              HasSubstr("EPSG:0"));
}

}  // namespace
}  // namespace terrane::client
