// The ray tracer against closed forms: a lit plane, penumbrae, furnaces; and
// what a picture must not depend on.
#include "core/raytrace/ray_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <stop_token>
#include <utility>

#include "tests/core/traced_shapes.h"

namespace terrane::core {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Material White() {
  Material material;
  material.base_color = {1, 1, 1};
  return material;
}

AreaLight LightAt(float height, float half_side) {
  return {{0, 0, height}, {0, half_side, 0}, {half_side, 0, 0}, {1, 1, 1}};
}

// Irradiance under the middle of a level square light of radiance 1.
float UnderSquare(float height, float half_side) {
  const float a = half_side / height;
  const float root = std::sqrt(1 + a * a);
  return 4 * a / root * std::atan(a / root);
}

TEST(RayTracer, LitPlaneHasTheRadianceOfTheClosedForm) {
  const Mesh plane = LevelRectangle({-5, -5}, {5, 5}, 0);
  Material grey = White();
  grey.base_color = {0.5f, 0.25f, 1};
  for (const float half_side : {0.1f, 1.0f, 3.0f}) {
    PictureSpec spec = Spot({1, 1, 8}, {0, 0, 0});
    spec.shading = ShadingModel::kLambert;
    spec.light = LightAt(4, half_side);
    const std::vector<float> pixel =
        Rendered(SceneOf(plane, grey), spec, {1024, 1});
    const float white = UnderSquare(4, half_side) / kPi;
    EXPECT_NEAR(pixel[0], 0.5f * white, 2e-3f * white);
    EXPECT_NEAR(pixel[1], 0.25f * white, 2e-3f * white);
    EXPECT_NEAR(pixel[2], white, 2e-3f * white);
  }
}

TEST(RayTracer, GroundIsLitLikeAPlane) {
  const Mesh far = LevelRectangle({90, 90}, {91, 91}, 0);
  PictureSpec spec = Spot({1, 1, 8}, {0, 0, 0});
  spec.shading = ShadingModel::kLambert;
  spec.light = LightAt(4, 1);
  spec.ground = Ground{.material = White()};
  const std::vector<float> pixel =
      Rendered(SceneOf(far, White()), spec, {1024, 1});
  EXPECT_NEAR(pixel[0], UnderSquare(4, 1) / kPi, 1e-3f);
}

TEST(RayTracer, LightShinesToOneSide) {
  const Mesh plane = LevelRectangle({-5, -5}, {5, 5}, 0);
  PictureSpec spec = Spot({1, 1, 8}, {0, 0, 0});
  spec.light = LightAt(4, 1);
  std::swap(spec.light->half_u, spec.light->half_v);
  EXPECT_EQ(Rendered(SceneOf(plane, White()), spec, {16, 1})[0], 0);
}

// An edge at height 1 over the plane, half a light of half side 1 at height 4
// behind it: the penumbra is as wide as similar triangles say.
TEST(RayTracer, PenumbraLiesWhereSimilarTrianglesSay) {
  const Mesh plate = LevelRectangle({-9, -9}, {0, 9}, 1);
  const float half_width = 1.0f / 3;
  const auto at = [&](float x) {
    PictureSpec spec = Spot({x + 3, 0, 0.5f}, {x, 0, 0});
    spec.shading = ShadingModel::kLambert;
    spec.light = LightAt(4, 1);
    spec.ground = Ground{.material = White()};
    return Rendered(SceneOf(plate, White()), spec, {256, 1})[0];
  };
  const float lit = UnderSquare(4, 1) / kPi;
  EXPECT_EQ(at(-1.02f * half_width), 0);
  EXPECT_GT(at(-0.8f * half_width), 0);
  EXPECT_NEAR(at(0), lit / 2, 0.01f * lit);
  EXPECT_LT(at(0.5f * half_width), 0.85f * lit);
  EXPECT_GT(at(1.02f * half_width), 0.95f * lit);
}

TEST(RayTracer, WhiteBallInAWhiteFurnaceCannotBeSeen) {
  const Mesh ball = Ball(1, 32);
  PictureSpec spec;
  spec.width = 24;
  spec.height = 24;
  spec.shading = ShadingModel::kLambert;
  spec.camera = {{0, -4, 0}, {0, 0, 0}, {0, 0, 1}, 40};
  spec.sky = {{1, 1, 1}, {1, 1, 1}};
  spec.bounces = 2;
  for (const float value : Rendered(SceneOf(ball, White()), spec, {16, 1})) {
    // Next to its edge, triangles hide a part of the sky from interpolated
    // normals.
    EXPECT_LE(value, 1.0001f);
    EXPECT_GE(value, 0.6f);
  }
}

// The mean over passes is the albedo that the shading model's own test has.
TEST(RayTracer, MirrorInAFurnaceHasTheAlbedoOfItsModel) {
  const Mesh plane = LevelRectangle({-5, -5}, {5, 5}, 0);
  for (const float gloss : {0.0f, 0.5f, 1.0f}) {
    Material mirror = White();
    mirror.base_color = {0, 0, 0};
    mirror.specular = 1;
    mirror.gloss = gloss;
    PictureSpec spec = Spot({0, 0, 8}, {0, 0, 0});
    spec.shading = ShadingModel::kLiteral;
    spec.sky = {{1, 1, 1}, {1, 1, 1}};
    const float expected = Finish(mirror, spec.shading).SpecularAlbedo(1);
    EXPECT_NEAR(Rendered(SceneOf(plane, mirror), spec, {4096, 1})[0], expected,
                0.01f);
  }
}

TEST(RayTracer, BouncesBringLightUnderARoof) {
  // A second bounce, from the ground outside to the roof and down, is the first
  // that adds light.
  const Mesh roof = LevelRectangle({-2, -2}, {2, 2}, 1);
  float before = 0;
  for (const int bounces : {0, 2, 6}) {
    PictureSpec spec = Spot({6, 0, 0.9f}, {0, 0, 0});
    spec.shading = ShadingModel::kLambert;
    spec.sky = {{1, 1, 1}, {1, 1, 1}};
    spec.ground = Ground{.material = White()};
    spec.bounces = bounces;
    Material both = White();
    both.double_sided = true;
    const float value = Rendered(SceneOf(roof, both), spec, {1024, 1})[0];
    EXPECT_GT(value, before + 0.05f) << bounces;
    EXPECT_LT(value, 1);
    before = value;
  }
}

PictureSpec BallPicture(int width, int height) {
  PictureSpec spec;
  spec.width = width;
  spec.height = height;
  spec.seed = 5;
  const Bounds bounds = {{-1, -1, -1}, {1, 1, 1}};
  spec.camera =
      FrameCamera(bounds, {20, 25}, 30,
                  static_cast<float>(width) / static_cast<float>(height));
  spec.light = PlaceLight(bounds, {});
  spec.ground = PlaceGround(bounds, White());
  return spec;
}

TEST(RayTracer, PictureDoesNotDependOnThreads) {
  const Mesh ball = Ball(1, 12);
  const PictureSpec spec = BallPicture(61, 43);
  const std::vector<float> alone =
      Rendered(SceneOf(ball, White()), spec, {3, 1});
  EXPECT_EQ(Rendered(SceneOf(ball, White()), spec, {3, 3}), alone);
}

TEST(RayTracer, PictureDoesNotDependOnTheOrderOfRows) {
  const Mesh ball = Ball(1, 12);
  const PictureSpec spec = BallPicture(40, 20);
  const auto traced = Traced(SceneOf(ball, White()));
  const auto tracer = *RayTracer::Create(traced, traced->materials(), spec);
  std::vector<float> whole(3 * 40 * 20);
  std::vector<float> rows(whole.size());
  ASSERT_TRUE(tracer->AddPass(0, 0, 20, {}, whole).ok());
  for (int row = 19; row >= 0; --row) {
    const auto place = std::span<float>(rows).subspan(
        static_cast<std::size_t>(row) * 3 * 40, 3 * 40);
    ASSERT_TRUE(tracer->AddPass(0, row, 1, {}, place).ok());
  }
  EXPECT_EQ(rows, whole);
}

TEST(RayTracer, SeedsDifferAndPassesConverge) {
  const Mesh ball = Ball(1, 24);
  PictureSpec spec = BallPicture(24, 16);
  const auto difference = [](const std::vector<float>& a,
                             const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += static_cast<double>((a[i] - b[i]) * (a[i] - b[i]));
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
  };
  const Scene scene = SceneOf(ball, White());
  const std::vector<float> best = Rendered(scene, spec, {1024, 2});
  spec.seed = 6;
  const double few = difference(Rendered(scene, spec, {4, 1}), best);
  const double many = difference(Rendered(scene, spec, {64, 1}), best);
  EXPECT_GT(few, 0);
  EXPECT_LT(many, few / 4);
  EXPECT_LT(many, 0.02);
}

// Casts another's rays, counts them, and asks for a stop in the midst of them.
class StoppingCaster final : public RayCaster {
 public:
  StoppingCaster(std::shared_ptr<const RayCaster> caster, std::int64_t stop_at)
      : caster_(std::move(caster)), stop_at_(stop_at) {}

  bool Intersect(const Ray& ray, SurfacePoint* point) const override {
    Count();
    return caster_->Intersect(ray, point);
  }
  bool Occluded(const Ray& ray) const override {
    Count();
    return caster_->Occluded(ray);
  }

  std::stop_token token() const { return stop_.get_token(); }
  std::int64_t rays() const { return rays_; }

 private:
  void Count() const {
    if (++rays_ == stop_at_) stop_.request_stop();
  }

  const std::shared_ptr<const RayCaster> caster_;
  const std::int64_t stop_at_;
  mutable std::stop_source stop_;
  mutable std::atomic<std::int64_t> rays_ = 0;
};

// Counted in rays after the stop: a thousand of them take about a millisecond.
TEST(RayTracer, StopsWithinHundredsOfRays) {
  const Mesh ball = Ball(1, 64);
  const auto traced = Traced(SceneOf(ball, White()));
  for (const std::int64_t stop_at : {1, 1000, 100'000}) {
    const auto caster = std::make_shared<StoppingCaster>(traced, stop_at);
    const auto tracer = *RayTracer::Create(caster, traced->materials(),
                                           BallPicture(2000, 2000));
    const auto image = RenderImage(*tracer, {1000, 1}, caster->token(), {});
    EXPECT_TRUE(absl::IsCancelled(image.status())) << image.status();
    EXPECT_GE(caster->rays(), stop_at);
    EXPECT_LT(caster->rays(), stop_at + 200);
  }
}

TEST(RayTracer, TellsOfEveryPass) {
  const Mesh ball = Ball(1, 8);
  const auto traced = Traced(SceneOf(ball, White()));
  const auto tracer =
      *RayTracer::Create(traced, traced->materials(), BallPicture(8, 8));
  std::vector<int> told;
  const auto image = RenderImage(*tracer, {3, 2}, {},
                                 [&](int passes, std::span<const float> sums) {
                                   told.push_back(passes);
                                   EXPECT_EQ(sums.size(), 3u * 8 * 8);
                                 });
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(told, (std::vector<int>{1, 2, 3}));
}

TEST(RayTracer, NamesEveryFieldThatIsWrong) {
  PictureSpec spec;
  spec.width = 0;
  spec.bounces = 17;
  spec.camera.target = spec.camera.eye;
  spec.camera.field_of_view_deg = std::numeric_limits<float>::quiet_NaN();
  spec.light = AreaLight{.radiance = {-1, 0, 0}};
  spec.ground = Ground{.material = {.roughness = 2}};
  const auto tracer = RayTracer::Create(nullptr, {{.specular = -1}}, spec);
  std::vector<std::string> fields;
  for (const Violation& violation : ViolationsOf(tracer.status())) {
    fields.push_back(violation.field);
  }
  EXPECT_EQ(fields,
            (std::vector<std::string>{
                "width", "bounces", "camera.field_of_view_deg", "camera.target",
                "light.radiance.x", "ground.material.roughness",
                "ground.material.gloss", "materials[0].specular"}));
}

}  // namespace
}  // namespace terrane::core
