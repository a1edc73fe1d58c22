// Petals: the outline against its points, the noise against its definition,
// normals against differences, and the two methods of comparison.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/flower/bezier_rows.h"
#include "core/flower/blade_mesh.h"
#include "core/flower/blade_outline.h"
#include "core/flower/blade_painter.h"
#include "core/flower/blade_rows.h"
#include "core/flower/ifs_rows.h"
#include "core/mesh/float3.h"
#include "core/noise/perlin_noise.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/flower_presets.h"
#include "tests/core/mesh_checks.h"

namespace terrane::core {
namespace {

using ::testing::HasSubstr;

const Sketch kTwoPoints = {
    {{0.36, 0.26}, {0.53, 0.66}}, SketchEnd::kPointed, SketchEnd::kRound};
const Sketch kThreePoints = {{{0.2, 0.2}, {0.35, 0.5}, {0.2, 0.8}},
                             SketchEnd::kRound,
                             SketchEnd::kPointed};

// --- Outline ----------------------------------------------------------------

TEST(BladeOutline, PassesThroughItsPoints) {
  for (const Sketch& sketch : {kTwoPoints, kThreePoints}) {
    const BladeOutline outline(sketch);
    ASSERT_EQ(outline.spans(), static_cast<int>(sketch.points.size()) + 1);
    EXPECT_EQ(outline.At(0), (SketchPoint{0, 0}));
    for (std::size_t i = 0; i < sketch.points.size(); ++i) {
      const SketchPoint p = outline.At(static_cast<double>(i) + 1);
      EXPECT_DOUBLE_EQ(p.x, sketch.points[i].x);
      EXPECT_DOUBLE_EQ(p.y, sketch.points[i].y);
    }
    EXPECT_NEAR(outline.At(outline.spans()).x, 0, 1e-15);
    EXPECT_NEAR(outline.At(outline.spans()).y, 1, 1e-15);
    EXPECT_EQ(outline.Fault(), "");
  }
}

// The printed matrix, in full, at an inner span: [1 x x^2 x^3] M [p0 .. p3].
TEST(BladeOutline, IsTheMatrixOfThePaper) {
  const BladeOutline outline(kThreePoints);
  const double t = 0.5;
  const double m[4][4] = {{0, 1, 0, 0},
                          {-t, 0, t, 0},
                          {2 * t, t - 3, 3 - 2 * t, -t},
                          {-t, 2 - t, t - 2, t}};
  const double p[4][2] = {{0, 0}, {0.2, 0.2}, {0.35, 0.5}, {0.2, 0.8}};
  for (double x = 0; x <= 1; x += 0.125) {
    double sum[2] = {0, 0};
    double power = 1;
    for (const auto& row : m) {
      for (int k = 0; k < 4; ++k) {
        sum[0] += power * row[k] * p[k][0];
        sum[1] += power * row[k] * p[k][1];
      }
      power *= x;
    }
    EXPECT_NEAR(outline.At(1 + x).x, sum[0], 1e-14);
    EXPECT_NEAR(outline.At(1 + x).y, sum[1], 1e-14);
  }
}

TEST(BladeOutline, EndsAreLevelOrPointed) {
  constexpr double kStep = 1e-6;
  const auto slope_at_tip = [](const Sketch& sketch) {
    const BladeOutline outline(sketch);
    const SketchPoint near = outline.At(outline.spans() - kStep);
    return (1 - near.y) / near.x;
  };
  EXPECT_NEAR(slope_at_tip(kTwoPoints), 0, 1e-5);
  EXPECT_NEAR(slope_at_tip(kThreePoints), 0.2 / 0.2, 1e-5);
}

TEST(BladeOutline, FaultsAreFound) {
  EXPECT_EQ(BladeOutline(kTwoPoints).Fault(), "");
  // y leaps up and then hardly rises: the spline overshoots and falls back.
  const Sketch folds = {{{0.3, 0.1}, {0.3, 0.9}, {0.2, 0.91}},
                        SketchEnd::kPointed,
                        SketchEnd::kPointed};
  EXPECT_THAT(BladeOutline(folds).Fault(), HasSubstr("must not fold back"));
  const Sketch crosses = {{{0.01, 0.3}, {1.5, 0.5}, {0.02, 0.6}},
                          SketchEnd::kPointed,
                          SketchEnd::kPointed};
  EXPECT_THAT(BladeOutline(crosses).Fault(), HasSubstr("must not cross"));
}

// --- Noise ------------------------------------------------------------------

TEST(PerlinNoise, IsZeroOnTheLattice) {
  const PerlinNoise noise(3);
  for (int i = -300; i <= 300; i += 7) {
    for (int j = -9; j <= 9; ++j) {
      EXPECT_EQ(noise.At(static_cast<float>(i), static_cast<float>(j)).value,
                0.0f);
    }
  }
}

// Equations 5-8, corner by corner, in double.
TEST(PerlinNoise, IsTheSumOfThePaper) {
  const PerlinNoise noise(11);
  const auto fade = [](double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
  };
  for (int k = 0; k < 500; ++k) {
    const float x = 0.137f * static_cast<float>(k) - 21;
    const float y = 0.073f * static_cast<float>(k) - 9;
    const double i = std::floor(static_cast<double>(x));
    const double j = std::floor(static_cast<double>(y));
    double sum = 0;
    for (const int a : {0, 1}) {
      for (const int b : {0, 1}) {
        const Float2 g =
            noise.GradientAt(static_cast<int>(i) + a, static_cast<int>(j) + b);
        const double dx = static_cast<double>(x) - i - a;
        const double dy = static_cast<double>(y) - j - b;
        sum += fade(1 - std::fabs(dx)) * fade(1 - std::fabs(dy)) *
               (static_cast<double>(g.x) * dx + static_cast<double>(g.y) * dy);
      }
    }
    EXPECT_NEAR(static_cast<double>(noise.At(x, y).value), sum, 3e-6);
  }
}

TEST(PerlinNoise, HasUnitGradientsAndAPermutation) {
  const PerlinNoise noise(5);
  for (int i = 0; i < 256; ++i) {
    const Float2 g = noise.GradientAt(0, i);
    EXPECT_NEAR(std::hypot(g.x, g.y), 1, 1e-6);
    EXPECT_EQ(noise.GradientAt(i + 256, 3), noise.GradientAt(i, 3));
    EXPECT_EQ(noise.GradientAt(i - 256, 3 - 256), noise.GradientAt(i, 3));
  }
  // No two columns read the gradients from the same place.
  int same = 0;
  for (int i = 1; i < 256; ++i) {
    same += noise.GradientAt(0, 0) == noise.GradientAt(i, 0) ? 1 : 0;
  }
  EXPECT_EQ(same, 0);
}

TEST(PerlinNoise, DerivativesAreTheDifferences) {
  const PerlinNoise noise(17);
  constexpr float kStep = 1.0f / 256;
  for (int k = 0; k < 1000; ++k) {
    const float x = 0.0371f * static_cast<float>(k);
    const float y = 0.0293f * static_cast<float>(k) - 7;
    const NoiseSample here = noise.At(x, y);
    EXPECT_NEAR(here.dx,
                (noise.At(x + kStep, y).value - noise.At(x - kStep, y).value) /
                    (2 * kStep),
                2e-3);
    EXPECT_NEAR(here.dy,
                (noise.At(x, y + kStep).value - noise.At(x, y - kStep).value) /
                    (2 * kStep),
                2e-3);
  }
}

// --- Rows -------------------------------------------------------------------

const Relief kRelief = {0.15, 4, 2, 1, true};
const BladeShape kShape = {150, 60, -90, 0.12};

TEST(BladeRows, HalvesMirrorExactly) {
  const PerlinNoise noise(1);
  const BladeOutline outline(kTwoPoints);
  BladeRows rows(noise, outline, kRelief, kShape, {3, 9});
  BladeRow row;
  for (int j = 0; j <= 20; ++j) {
    rows.Make(outline.spans() * (j / 20.0), 18, &row);
    const std::size_t last = row.positions.size() - 1;
    for (std::size_t k = 0; k <= last; ++k) {
      const Float3 p = row.positions[k];
      const Float3 n = row.normals[k];
      EXPECT_EQ(row.positions[last - k], (Float3{-p.x, p.y, p.z}));
      EXPECT_EQ(row.normals[last - k], (Float3{-n.x, n.y, n.z}));
    }
  }
}

TEST(BladeRows, WithoutMirroringTheOutlineStillDoes) {
  const PerlinNoise noise(1);
  const BladeOutline outline(kTwoPoints);
  Relief relief = kRelief;
  relief.mirrored = false;
  BladeRows rows(noise, outline, relief, {}, {3, 9});
  BladeRow row;
  rows.Make(1.7, 18, &row);
  float largest = 0;
  for (std::size_t k = 0; k <= 18; ++k) {
    EXPECT_EQ(row.positions[18 - k].x, -row.positions[k].x);
    EXPECT_EQ(row.positions[18 - k].y, row.positions[k].y);
    largest = std::max(largest,
                       std::fabs(row.positions[18 - k].z - row.positions[k].z));
  }
  EXPECT_GT(largest, 0.005f);
}

// A flat petal is z(x, y) = k Nd noise(Nsx |x|, Nsy y) over its sketch.
TEST(BladeRows, DepthIsTheNoiseOfThePaper) {
  const PerlinNoise noise(8);
  const BladeOutline outline(kThreePoints);
  const Relief relief = {0.2, 5, 3, 1.5, true};
  BladeRows rows(noise, outline, relief, {}, {7, 2});
  BladeRow row;
  for (int j = 0; j <= 16; ++j) {
    rows.Make(outline.spans() * (j / 16.0), 12, &row);
    for (const Float3& p : row.positions) {
      const NoiseSample sample = noise.At(7 + 5 * std::fabs(p.x), 2 + 3 * p.y);
      EXPECT_NEAR(p.z, 0.3f * sample.value, 1e-6);
      EXPECT_NEAR(p.y, row.y, 1e-6);
    }
  }
  // Meets its base at 0.
  BladeRows base(noise, outline, relief, {}, {7, 2});
  base.Make(0, 12, &row);
  EXPECT_EQ(row.positions.size(), 1u);
  EXPECT_EQ(row.positions[0], (Float3{0, 0, 0}));
}

// Central differences along a row and between rows, in the sketch.
TEST(BladeRows, NormalsAreThoseOfTheSurface) {
  constexpr double kStep = 1.0 / 512;
  constexpr int kColumns = 512;
  const PerlinNoise noise(21);
  const BladeOutline outline(kTwoPoints);
  for (const bool mirrored : {true, false}) {
    Relief relief = kRelief;
    relief.mirrored = mirrored;
    for (const double t : {0.35, 0.9, 1.4, 2.1, 2.6}) {
      BladeRow rows[3];
      BladeRows surface(noise, outline, relief, kShape, {100, 50});
      for (int j = 0; j < 3; ++j) {
        surface.Make(t + (j - 1) * kStep, kColumns, &rows[j]);
      }
      // A row's own columns spread with its width; so the difference between
      // rows also runs along them, which the cross product takes out.
      for (std::size_t k = 8; k + 8 <= kColumns; k += 24) {
        if (mirrored && k == kColumns / 2) continue;  // the ridge
        const Float3 along =
            rows[1].positions[k + 1] - rows[1].positions[k - 1];
        const Float3 up = rows[2].positions[k] - rows[0].positions[k];
        const Float3 normal = Normalized(Cross(along, up));
        EXPECT_GT(Dot(normal, rows[1].normals[k]), 0.9995f)
            << "t " << t << " column " << k;
      }
    }
  }
}

TEST(BladeRows, ShapesBendAsTheySay) {
  const PerlinNoise noise(2);
  const BladeOutline outline(kTwoPoints);
  const Relief flat = {0, 1, 1, 1, true};
  BladeRow row;
  // 90 degrees along: the tip lies on a quarter circle of length 1.
  BladeRows curled(noise, outline, flat, {0, 90, 90, 0}, {});
  for (int j = 0; j <= 30; ++j) {
    curled.Make(outline.spans() * (j / 30.0), 8, &row);
  }
  const double radius = 2 / 3.14159265358979;
  EXPECT_NEAR(row.positions[0].y, radius, 1e-5);
  EXPECT_NEAR(row.positions[0].z, radius, 1e-5);
  EXPECT_NEAR(row.normals[0].y, -1, 1e-5);
  // Across: every row lies on a cylinder of radius 180 / (pi across).
  BladeRows cupped(noise, outline, flat, {120, 0, 0, 0}, {});
  cupped.Make(2, 16, &row);
  const double cup = 180 / 3.14159265358979 / 120;
  for (const Float3& p : row.positions) {
    EXPECT_NEAR(std::hypot(p.x, p.z - cup), cup, 1e-5);
  }
  // The lip leans out, most at the rim.
  BladeRows lip(noise, outline, flat, {0, 0, 0, 0.2}, {});
  lip.Make(2.9, 16, &row);
  EXPECT_LT(row.positions[8].z, -0.05f);
}

// --- Relief -----------------------------------------------------------------

double MeanVariance(const Relief& relief) {
  double sum = 0;
  for (int seed = 0; seed < 40; ++seed) {
    sum += NormalVariance(PerlinNoise(seed), kTwoPoints, relief, {seed, seed});
  }
  return sum / 40;
}

TEST(Relief, GrowsWithAmplitudeAndBothFrequencies) {
  const Relief base = {0.1, 2, 2, 1, true};
  const double variance = MeanVariance(base);
  EXPECT_GT(MeanVariance({0.2, 2, 2, 1, true}), 1.5 * variance);
  EXPECT_GT(MeanVariance({0.1, 6, 2, 1, true}), 1.5 * variance);
  EXPECT_GT(MeanVariance({0.1, 2, 6, 1, true}), 1.5 * variance);
  EXPECT_GT(MeanVariance({0.1, 2, 2, 2, true}), 1.5 * variance);
  // Flat, ruffled and folding, as the method has it.
  EXPECT_EQ(MeanVariance({0, 4, 4, 1, true}), 0);
  EXPECT_LT(MeanVariance({0.03, 1, 1, 1, true}), 0.01);
  EXPECT_GT(MeanVariance({0.3, 8, 8, 1, true}), kFoldingVariance);
}

// --- Meshes -----------------------------------------------------------------

BladeSpec Blade() {
  BladeSpec blade;
  blade.sketches = {kTwoPoints, kThreePoints};
  blade.relief = {0.05, 3, 2, 1, true};
  blade.variants = 2;
  blade.steps = 3;
  blade.closed = {200, 30, 40, 0};
  blade.open = {60, 40, -60, 0.1};
  return blade;
}

TEST(BladeMesh, IsOneSheetByEveryMethod) {
  const PerlinNoise noise(4);
  const BladeSpec blade = Blade();
  for (const PetalMethod method :
       {PetalMethod::kPerlin, PetalMethod::kBezier, PetalMethod::kIfs}) {
    for (int sketch = 0; sketch < 2; ++sketch) {
      const Mesh mesh =
          MakeBladeMesh(method, blade, {sketch, 1, 2}, 4, 0, noise);
      ExpectGoodMesh(mesh, 0.3);
      const MeshSize size = BladeSize(blade);
      EXPECT_EQ(static_cast<std::int64_t>(mesh.positions.size()),
                size.vertices);
      EXPECT_EQ(static_cast<std::int64_t>(mesh.indices.size()),
                3 * size.triangles);
      // One boundary: down one side, up the other.
      EXPECT_EQ(OpenEdges(mesh), static_cast<std::size_t>(2 * blade.rows));
    }
  }
}

TEST(BladeMesh, MeetsTheSketchAtEveryRow) {
  const PerlinNoise noise(4);
  BladeSpec blade = Blade();
  blade.relief.amplitude = 0;
  blade.closed = blade.open = {};
  blade.rows = 30;  // a whole number of rows a span
  const Mesh mesh = MakeBladeMesh(PetalMethod::kPerlin, blade, {}, 4, 0, noise);
  for (const SketchPoint& point : blade.sketches[0].points) {
    const auto meets = [&](double side) {
      return std::any_of(
          mesh.positions.begin(), mesh.positions.end(), [&](Float3 p) {
            return std::hypot(static_cast<double>(p.x) - side * point.x,
                              static_cast<double>(p.y) - point.y) < 1e-6;
          });
    };
    EXPECT_TRUE(meets(1)) << point.x;
    EXPECT_TRUE(meets(-1)) << point.x;
  }
}

TEST(BladeMesh, VariantsDifferAndStepsBlend) {
  const PerlinNoise noise(4);
  const BladeSpec blade = Blade();
  const auto make = [&](BladeChoice choice) {
    return MakeBladeMesh(PetalMethod::kPerlin, blade, choice, 4, 0, noise)
        .positions;
  };
  EXPECT_NE(make({0, 0, 0}), make({0, 1, 0}));
  EXPECT_NE(make({0, 0, 0}), make({1, 0, 0}));
  EXPECT_NE(make({0, 0, 0}), make({0, 0, 1}));
  EXPECT_EQ(ShapeAt(blade, 0), blade.closed);
  EXPECT_EQ(ShapeAt(blade, 1), (BladeShape{130, 35, -10, 0.05}));
  EXPECT_EQ(ShapeAt(blade, 2), blade.open);
}

TEST(BladeMesh, StopsAtARow) {
  const PerlinNoise noise(4);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(MakeBladeMesh(PetalMethod::kPerlin, Blade(), {}, 4, 0, noise,
                            stop.get_token())
                  .positions.empty());
}

TEST(BezierPetal, MeetsTheNoisePetalAtThirds) {
  const PerlinNoise noise(6);
  const BladeOutline outline(kTwoPoints);
  BladeRows petal(noise, outline, kRelief, kShape, {});
  const BezierNet net = FitBezierNet(outline, &petal);
  BezierRows patch(outline, net);
  BladeRows again(noise, outline, kRelief, kShape, {});
  BladeRow of_patch;
  BladeRow of_petal;
  for (const int third : {1, 2}) {
    const double t = outline.spans() * third / 3.0;
    patch.Make(t, 6, &of_patch);
    again.Make(t, 6, &of_petal);
    for (const std::size_t k : {0u, 2u, 4u, 6u}) {
      EXPECT_LT(Length(of_patch.positions[k] - of_petal.positions[k]), 1e-5f);
    }
  }
  EXPECT_EQ(net[0][0].x, net[0][3].x);  // the base is one point
}

TEST(IfsPetal, IsFlatAndInsideTheHullOfItsMaps) {
  const std::vector<AffineMap> code = IfsCode(kThreePoints);
  EXPECT_EQ(code.size(), 8u);
  for (const AffineMap& map : code) {
    EXPECT_LT(std::fabs(map.a * map.d - map.b * map.c), 1);
  }
  IfsRows rows(code, 40, 4, 9);
  BladeRow row;
  float widest = 0;
  for (int j = 0; j <= 40; ++j) {
    rows.Make(4 * (j / 40.0), 8, &row);
    for (const Float3& p : row.positions) {
      EXPECT_EQ(p.z, 0);
      EXPECT_LE(std::fabs(p.x), 0.35f);
    }
    if (j > 0 && j < 40) {
      EXPECT_GT(row.half_width, 0);
    }
    widest = std::max(widest, row.half_width);
  }
  EXPECT_GT(widest, 0.3f);
}

TEST(PetalMethods, NeedSoManyControlValues) {
  EXPECT_EQ(ControlValues(PetalMethod::kPerlin, kTwoPoints), 7);
  EXPECT_EQ(ControlValues(PetalMethod::kPerlin, kThreePoints), 9);
  EXPECT_EQ(ControlValues(PetalMethod::kIfs, kTwoPoints), 36);
  EXPECT_EQ(ControlValues(PetalMethod::kBezier, kTwoPoints), 48);
}

// --- Colours ----------------------------------------------------------------

TEST(BladePainter, PaintsFromBaseToTipWithBlotchAndSeam) {
  const PerlinNoise noise(4);
  BladeColors colors;
  EXPECT_FALSE(HasColors(colors));
  colors.base = {1, 0.5f, 0};
  colors.tip = {0, 0, 1};
  EXPECT_TRUE(HasColors(colors));
  EXPECT_EQ(BladePainter(colors, noise).At(0, 0, 0.5f), (Float3{1, 0.5f, 0}));
  EXPECT_EQ(BladePainter(colors, noise).At(0, 1, 0.5f), (Float3{0, 0, 1}));
  const Float3 middle = BladePainter(colors, noise).At(0, 0.5f, 0.5f);
  EXPECT_NEAR(middle.x, 0.5, 1e-6);
  EXPECT_NEAR(middle.z, 0.5, 1e-6);
  colors.blotch = {{0, 1, 0}, 0.3, 0.6, 0};
  EXPECT_EQ(BladePainter(colors, noise).At(0, 0.45f, 0.5f), (Float3{0, 1, 0}));
  EXPECT_EQ(BladePainter(colors, noise).At(0, 0.1f, 0.5f).z,
            BladePainter({colors.base, colors.tip}, noise).At(0, 0.1f, 0.5f).z);
  colors.margin = {1, 1, 1};
  colors.margin_width = 0.05;
  EXPECT_EQ(BladePainter(colors, noise).At(0.5f, 0.5f, 0.5f),
            (Float3{1, 1, 1}));
}

}  // namespace
}  // namespace terrane::core
