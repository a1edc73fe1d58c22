// The small helpers of the commands: tables, ticks, numbers for people.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "client/csv.h"
#include "client/progress.h"
#include "client/render/plot.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ReadCsv, TakesAHeaderEmptyLinesAndBlanks) {
  std::istringstream input("x,y\n1, 2\r\n\n -3e2 ,4.5\n");
  const auto table = ReadCsv(&input, "points", 2);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_THAT(*table, ElementsAre(ElementsAre(1, -300), ElementsAre(2, 4.5)));
}

TEST(ReadCsv, NamesTheLineThatIsWrong) {
  for (const auto& [text, line] :
       {std::pair("1,2\n3\n", "line 2"), std::pair("1,2\n3,x\n", "line 2"),
        std::pair("1,2\n3,4 5\n", "line 2"), std::pair("", "no row")}) {
    std::istringstream input(text);
    EXPECT_THAT(std::string(ReadCsv(&input, "points", 2).status().message()),
                HasSubstr(line));
  }
}

TEST(NiceTicks, AreRoundAndInside) {
  EXPECT_THAT(NiceTicks(-0.3, 1.1, 5), ElementsAre(0, 0.5, 1));
  EXPECT_THAT(NiceTicks(97, 1003, 4), ElementsAre(500, 1000));
  EXPECT_EQ(TickText(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(TickText(-1e-17, 0.1), "0.0");
  EXPECT_EQ(TickText(1500, 500), "1500");
}

TEST(RenderPlot, DrawsTheLineWhereTheNumbersAre) {
  const Series series{"height", {0, 1}, {5, 5}, {0, 0, 1}, 3};
  PlotOptions options;
  const auto picture = RenderPlot({series}, options);
  ASSERT_TRUE(picture.ok()) << picture.status();
  // A level line crosses the middle of the plot, blue and nothing else.
  int blue_rows = 0;
  for (int y = 0; y < picture->height; ++y) {
    const std::uint8_t* pixel = picture->Pixel(picture->width / 2 + 7, y);
    blue_rows += pixel[2] > 200 && pixel[0] < 60 ? 1 : 0;
  }
  EXPECT_THAT(blue_rows, testing::AllOf(testing::Ge(2), testing::Le(4)));
  EXPECT_FALSE(RenderPlot({{"empty", {}, {}, {}, 1}}, options).ok());
}

TEST(Numbers, AreShort) {
  EXPECT_EQ(ShortNumber(999), "999 ");
  EXPECT_EQ(ShortNumber(12345), "12.3 k");
  EXPECT_EQ(ShortNumber(999600), "1.0 M");
  EXPECT_EQ(ClockText(59.4), "0:59");
  EXPECT_EQ(ClockText(3725), "1:02:05");
}

}  // namespace
}  // namespace terrane::client
