// What the pictures show, pixel by pixel where it is known.
#include "client/render/relief.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "client/render/perspective.h"
#include "client/render/side_by_side.h"

namespace terrane::client {
namespace {

constexpr int kSize = 64;
const core::GroundScale kMetres(core::GroundSpacing{1, 1});

// A cone in the middle of a plain at 0.
std::vector<float> Hill() {
  std::vector<float> heights;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double r = std::hypot(x - kSize / 2, y - kSize / 2);
      heights.push_back(static_cast<float>(std::max(0.0, 20 - r)));
    }
  }
  return heights;
}

core::HeightView ViewOf(const std::vector<float>& heights) {
  return {kSize, kSize, heights};
}

int Sum(const Picture& picture, int x, int y) {
  const std::uint8_t* pixel = picture.Pixel(x, y);
  return pixel[0] + pixel[1] + pixel[2];
}

bool IsBlue(const Picture& picture, int x, int y) {
  const std::uint8_t* pixel = picture.Pixel(x, y);
  return pixel[2] > pixel[0] + 40;
}

TEST(RenderRelief, NorthWesternSlopeIsBrighterThanSouthEastern) {
  const std::vector<float> hill = Hill();
  for (const ReliefStyle style :
       {ReliefStyle::kRelief, ReliefStyle::kHillshade}) {
    ReliefOptions options;
    options.style = style;
    const Picture picture = RenderRelief(ViewOf(hill), kMetres, options);
    EXPECT_GT(Sum(picture, 26, 26), Sum(picture, 38, 38) + 60);
  }
}

TEST(RenderRelief, GreyGrowsWithTheHeight) {
  ReliefOptions options;
  options.style = ReliefStyle::kGrey;
  const std::vector<float> hill = Hill();
  const Picture picture = RenderRelief(ViewOf(hill), kMetres, options);
  EXPECT_EQ(Sum(picture, 0, 0), 0);
  EXPECT_EQ(Sum(picture, kSize / 2, kSize / 2), 3 * 255);
}

TEST(RenderRelief, WaterCoversWhatIsBelowItAndNothingElse) {
  ReliefOptions options;
  options.water_level = 10;
  std::vector<float> hill = Hill();
  hill[0] = std::numeric_limits<float>::quiet_NaN();
  const Picture picture = RenderRelief(ViewOf(hill), kMetres, options);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const float height = hill[static_cast<std::size_t>(y * kSize + x)];
      ASSERT_EQ(IsBlue(picture, x, y), height < 10) << x << ", " << y;
    }
  }
}

TEST(RenderPerspective, FillsItsWidthAndShowsTheLake) {
  PerspectiveOptions options;
  options.width = 300;
  options.water_level = 5;
  const std::vector<float> hill = Hill();
  const PerspectivePicture result =
      RenderPerspective(ViewOf(hill), kMetres, options);
  const Picture& picture = result.picture;
  ASSERT_EQ(picture.width, 300);
  EXPECT_GT(result.exaggeration, 0);
  int first = picture.width;
  int last = 0;
  int blue = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (Sum(picture, x, y) == 3 * 255) continue;
      first = std::min(first, x);
      last = std::max(last, x);
      blue += IsBlue(picture, x, y) ? 1 : 0;
    }
  }
  EXPECT_NEAR(first, 9, 2);
  EXPECT_NEAR(last, 290, 2);
  EXPECT_GT(blue, 5000);
}

TEST(RenderSideBySide, EveryPanelShowsTheSameGroundAtTheSamePlace) {
  // The same hill at half the spacing: the panels differ by the detail only.
  std::vector<float> fine;
  for (int y = 0; y < 2 * kSize; ++y) {
    for (int x = 0; x < 2 * kSize; ++x) {
      const double r = std::hypot(x - kSize, y - kSize) / 2;
      fine.push_back(static_cast<float>(std::max(0.0, 20 - r)));
    }
  }
  const std::vector<float> coarse = Hill();
  const core::GroundScale half(core::GroundSpacing{0.5, 0.5});
  SideBySideOptions options;
  options.panel_width = 128;
  options.detail_share = 0.5;
  const Panel left{ViewOf(coarse), &kMetres, "left"};
  const Panel right{{2 * kSize, 2 * kSize, fine}, &half, "right"};
  const Panel panels[] = {left, right, left};
  const Picture picture = RenderSideBySide(panels, options);
  ASSERT_EQ(picture.width, 3 * 128 + 4 * 16);
  double difference = 0;
  for (int y = 48; y < 160; ++y) {
    for (int x = 20; x < 120; ++x) {
      difference +=
          std::abs(Sum(picture, x, y) - Sum(picture, x + 144, y)) / 3.0;
      ASSERT_EQ(Sum(picture, x, y), Sum(picture, x + 288, y));
    }
  }
  EXPECT_LT(difference / (112 * 100), 8);
}

}  // namespace
}  // namespace terrane::client
