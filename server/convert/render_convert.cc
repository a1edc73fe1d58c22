#include "server/convert/render_convert.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/base/field_checks.h"
#include "core/raytrace/tone.h"
#include "server/convert/enum_table.h"

namespace terrane::server {
namespace {

constexpr int kDefaultWidth = 800;
constexpr int kDefaultHeight = 600;
constexpr int kDefaultPasses = 64;
constexpr int kBandPixels = 65'536;
constexpr core::Direction kDefaultView = {28, 20};

constexpr core::Range kTurns = {-360, 360};
constexpr core::Range kTilts = {-90, 90};
constexpr core::Range kShares = {0, 1};
constexpr core::Range kRadiances = {0, 1000};
constexpr core::Range kFactors = {0.001, 1000};

constexpr EnumTable<v1::ShadingModel, core::ShadingModel, 4> kShadingModels{{
    {v1::SHADING_MODEL_CONSERVING, core::ShadingModel::kConserving},
    {v1::SHADING_MODEL_LITERAL, core::ShadingModel::kLiteral},
    {v1::SHADING_MODEL_LAMBERT, core::ShadingModel::kLambert},
    {v1::SHADING_MODEL_BLINN_PHONG, core::ShadingModel::kBlinnPhong},
}};

// To itself: read for the check alone.
constexpr EnumTable<v1::PixelEncoding, v1::PixelEncoding, 2> kPixelEncodings{{
    {v1::PIXEL_ENCODING_SRGB8, v1::PIXEL_ENCODING_SRGB8},
    {v1::PIXEL_ENCODING_LINEAR_FLOAT32_LE,
     v1::PIXEL_ENCODING_LINEAR_FLOAT32_LE},
}};

// The default color of a ground.
core::Material UsualGround() {
  core::Material material;
  material.base_color = {0.6f, 0.6f, 0.6f};
  return material;
}

core::Float3 ReadColor(const v1::LinearColor& color, const core::Path& path,
                       const core::Range& range, core::FieldChecks* checks) {
  checks->Number(path.Field("red"), static_cast<double>(color.red()), range);
  checks->Number(path.Field("green"), static_cast<double>(color.green()),
                 range);
  checks->Number(path.Field("blue"), static_cast<double>(color.blue()), range);
  return {color.red(), color.green(), color.blue()};
}

void ReadDirection(bool has_turn, double turn_deg, bool has_tilt,
                   double tilt_deg, const core::Path& path,
                   core::FieldChecks* checks, core::Direction* direction) {
  if (has_turn) direction->turn_deg = turn_deg;
  if (has_tilt) direction->tilt_deg = tilt_deg;
  checks->Number(path.Field("turn_deg"), direction->turn_deg, kTurns);
  checks->Number(path.Field("tilt_deg"), direction->tilt_deg, kTilts);
}

void ReadView(const v1::RenderView& view, const core::Path& path,
              core::FieldChecks* checks, RenderPlan* plan) {
  plan->view = kDefaultView;
  ReadDirection(view.has_turn_deg(), view.turn_deg(), view.has_tilt_deg(),
                view.tilt_deg(), path, checks, &plan->view);
  if (!view.has_field_of_view_deg()) return;
  checks->Number(path.Field("field_of_view_deg"), view.field_of_view_deg(),
                 {1, 120});
  plan->field_of_view_deg = static_cast<float>(view.field_of_view_deg());
}

void ReadLight(const v1::RenderLight& light, const core::Path& path,
               core::FieldChecks* checks, RenderPlan* plan) {
  core::LightPlace& place = plan->light;
  ReadDirection(light.has_turn_deg(), light.turn_deg(), light.has_tilt_deg(),
                light.tilt_deg(), path, checks, &place.direction);
  if (light.has_distance()) place.distance = light.distance();
  if (light.has_half_side()) place.half_side = light.half_side();
  checks->Number(path.Field("distance"), place.distance, {1.5, 1000});
  checks->Number(path.Field("half_side"), place.half_side, {0.001, 100});
  core::Sky& sky = plan->picture.sky;
  if (light.has_irradiance()) {
    place.irradiance = ReadColor(light.irradiance(), path.Field("irradiance"),
                                 kRadiances, checks);
  }
  if (light.has_zenith()) {
    sky.zenith =
        ReadColor(light.zenith(), path.Field("zenith"), kRadiances, checks);
  }
  if (light.has_horizon()) {
    sky.horizon =
        ReadColor(light.horizon(), path.Field("horizon"), kRadiances, checks);
  }
}

// Checks a number whose 0 stands for its default.
int ReadSize(int value, int usual, int most, const core::Path& path,
             core::FieldChecks* checks) {
  if (value == 0) return usual;
  return checks->Integer(path, value, 1, most) ? value : usual;
}

}  // namespace

int RenderPlan::band_rows() const {
  return std::clamp(kBandPixels / picture.width, 1, picture.height);
}

int RenderPlan::bands_of_picture() const {
  return (picture.height + band_rows() - 1) / band_rows();
}

std::vector<int> RenderPlan::Stages() const {
  std::vector<int> stages;
  for (int pass = 1; !final_only && pass < passes; pass *= 2) {
    stages.push_back(pass);
  }
  stages.push_back(passes);
  return stages;
}

std::int64_t RenderPlan::bands() const {
  return static_cast<std::int64_t>(Stages().size()) * bands_of_picture();
}

std::size_t RenderPlan::bytes_per_pixel() const {
  return encoding == v1::PIXEL_ENCODING_SRGB8 ? 3 : 3 * sizeof(float);
}

std::int64_t RenderPlan::BytesFrom(std::int64_t first) const {
  const std::int64_t bands = bands_of_picture();
  const std::int64_t rows =
      (this->bands() - first) / bands * picture.height +
      (first % bands == 0
           ? 0
           : picture.height - first % bands * std::int64_t{band_rows()});
  return rows * picture.width * static_cast<std::int64_t>(bytes_per_pixel());
}

std::int64_t RenderPlan::pixels() const {
  return std::int64_t{picture.width} * picture.height;
}

core::Material ReadMaterial(const v1::RenderMaterial* material,
                            const core::Material& usual,
                            const std::string& prefix,
                            core::Violations* violations) {
  if (material == nullptr) return usual;
  core::Material read;
  read.double_sided = usual.double_sided;
  core::FieldChecks checks(violations);
  const core::Path root(&prefix);
  if (!material->has_base_color()) {
    checks.Violate(root.Field("base_color"), "must be set");
  }
  const core::Float3 color = ReadColor(
      material->base_color(), root.Field("base_color"), kShares, &checks);
  read.base_color = {color.x, color.y, color.z};
  if (material->has_roughness()) read.roughness = material->roughness();
  if (material->has_specular()) read.specular = material->specular();
  checks.Number(root.Field("roughness"), static_cast<double>(read.roughness),
                kShares);
  checks.Number(root.Field("specular"), static_cast<double>(read.specular),
                kShares);
  if (material->has_gloss()) {
    read.gloss = material->gloss();
    checks.Number(root.Field("gloss"), static_cast<double>(material->gloss()),
                  kShares);
  }
  return read;
}

RenderPlan ReadRenderPlan(const v1::StreamRenderRequest& request,
                          const Limits& limits, const std::string& prefix,
                          core::Violations* violations) {
  RenderPlan plan;
  core::FieldChecks checks(violations);
  const core::Path root(&prefix);
  core::PictureSpec& picture = plan.picture;
  const std::size_t before = violations->total();
  picture.width = ReadSize(request.width(), kDefaultWidth,
                           core::kMaxPictureSide, root.Field("width"), &checks);
  picture.height =
      ReadSize(request.height(), kDefaultHeight, core::kMaxPictureSide,
               root.Field("height"), &checks);
  if (plan.pixels() > limits.max_render_pixels) {
    checks.Violate(root.Field("width"),
                   "must be such that width * height is at most " +
                       std::to_string(limits.max_render_pixels) + ", got " +
                       std::to_string(plan.pixels()));
  }
  plan.passes =
      ReadSize(request.passes(), kDefaultPasses, limits.max_render_passes,
               root.Field("passes"), &checks);
  const bool knows_bands = violations->total() == before;
  if (request.has_bounces()) {
    checks.Integer(root.Field("bounces"), request.bounces(), 0,
                   core::kMaxBounces);
    picture.bounces = request.bounces();
  }
  picture.seed = request.seed();
  picture.shading = ReadEnum(kShadingModels, request.shading(),
                             root.Field("shading"), violations);
  plan.encoding = ReadEnum(kPixelEncodings, request.encoding(),
                           root.Field("encoding"), violations);
  if (request.has_exposure()) {
    checks.Number(root.Field("exposure"), request.exposure(), kFactors);
    plan.exposure = static_cast<float>(request.exposure());
  }
  ReadView(request.view(), root.Field("view"), &checks, &plan);
  ReadLight(request.light(), root.Field("light"), &checks, &plan);
  plan.ground = request.has_ground()
                    ? request.ground()
                    : request.has_tree() || request.has_flower();
  plan.ground_material = ReadMaterial(
      request.has_ground_material() ? &request.ground_material() : nullptr,
      UsualGround(), prefix + "ground_material.", violations);
  plan.final_only = request.final_only();
  plan.first_band = request.first_band();
  checks.Integer(
      root.Field("first_band"), plan.first_band, 0,
      knows_bands ? plan.bands() : std::numeric_limits<std::int64_t>::max());
  return plan;
}

std::string EncodePixels(std::span<const float> linear,
                         const RenderPlan& plan) {
  std::string bytes(linear.size() / 3 * plan.bytes_per_pixel(), '\0');
  if (plan.encoding == v1::PIXEL_ENCODING_SRGB8) {
    core::ToSrgb8(
        linear, plan.exposure,
        {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()});
  } else {
    std::memcpy(bytes.data(), linear.data(), bytes.size());
  }
  return bytes;
}

}  // namespace terrane::server
