// The scene of a terrain: the samples of a window as one mesh, in the colours
// that heights and slopes have in nature.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/field_checks.h"
#include "core/mesh/float3.h"
#include "core/mesh/grid_mesh.h"
#include "server/actor/actor.h"
#include "server/actor/scenes/scene_source.h"

namespace terrane::server {
namespace {

constexpr core::Range kExaggerations = {0.001, 1000};

// Colours by height, from the lowest to the highest sample.
struct Tint {
  float height = 0;  // 0 to 1
  core::Float3 color;
};
constexpr std::array<Tint, 5> kTints = {{{0, {0.17f, 0.26f, 0.11f}},
                                         {0.30f, {0.30f, 0.36f, 0.16f}},
                                         {0.55f, {0.46f, 0.40f, 0.26f}},
                                         {0.80f, {0.50f, 0.47f, 0.43f}},
                                         {1, {0.92f, 0.93f, 0.95f}}}};
constexpr core::Float3 kRock = {0.36f, 0.33f, 0.30f};
// The normal's z where rock begins to show, and where nothing else does.
constexpr float kSteep = 0.80f;
constexpr float kSheer = 0.55f;

core::Float3 Mixed(core::Float3 a, core::Float3 b, float share) {
  return a + share * (b - a);
}

core::Float3 ColorAt(float height, float normal_z) {
  std::size_t i = 1;
  while (i + 1 < kTints.size() && height > kTints[i].height) ++i;
  const Tint& low = kTints[i - 1];
  const Tint& high = kTints[i];
  const float t = (height - low.height) / (high.height - low.height);
  const core::Float3 tint =
      Mixed(low.color, high.color, std::clamp(t, 0.0f, 1.0f));
  return Mixed(tint, kRock,
               std::clamp((kSteep - normal_z) / (kSteep - kSheer), 0.0f, 1.0f));
}

class TerrainScene : public SceneSource {
 public:
  TerrainScene(std::shared_ptr<const TileJob> job, double exaggeration)
      : job_(std::move(job)),
        window_(job_->header().window()),
        exaggeration_(exaggeration),
        heights_(static_cast<std::size_t>(window_.width() * window_.height())) {
  }

  const std::string& recipe_hash() const override {
    return job_->header().recipe_hash();
  }

  absl::Status Advance(std::stop_token stop) override {
    if (next_ == job_->total()) {
      MakeMesh();
      return absl::OkStatus();
    }
    const absl::Status made =
        job_->MakeTile(next_, std::move(stop), &scratch_, &tile_);
    if (!made.ok()) return made;
    const v1::Window& part = tile_.window();
    const auto width = static_cast<std::size_t>(part.width());
    for (std::int64_t j = 0; j < part.height(); ++j) {
      std::memcpy(heights_.data() +
                      (part.y() - window_.y() + j) * window_.width() +
                      (part.x() - window_.x()),
                  tile_.data().data() +
                      static_cast<std::size_t>(j) * width * sizeof(float),
                  width * sizeof(float));
    }
    ++next_;
    return absl::OkStatus();
  }

  double share() const override {
    return static_cast<double>(next_) / static_cast<double>(job_->total() + 1);
  }
  bool Ready() const override { return ready_; }
  core::Scene scene() const override {
    core::Material material;
    material.name = "terrain";
    material.base_color = {1, 1, 1};
    material.roughness = 1;
    material.double_sided = true;
    return {{material}, {{"terrain", &mesh_, 0, nullptr}}};
  }

 private:
  // Heights as they are drawn. Clamped at the window's edge; NaN without data.
  double HeightAt(std::int64_t i, std::int64_t j) const {
    i = std::clamp<std::int64_t>(i, 0, window_.width() - 1);
    j = std::clamp<std::int64_t>(j, 0, window_.height() - 1);
    return exaggeration_ *
           static_cast<double>(
               heights_[static_cast<std::size_t>(j * window_.width() + i)]);
  }

  core::Float3 NormalAt(std::int64_t i, std::int64_t j, double step_x,
                        double step_y) const {
    const double here = HeightAt(i, j);
    const auto slope = [&](double before, double after, double step) {
      // One-sided next to a hole.
      if (std::isnan(before)) before = here;
      if (std::isnan(after)) after = here;
      return (after - before) / (2 * step);
    };
    const double slope_x =
        slope(HeightAt(i - 1, j), HeightAt(i + 1, j), step_x);
    const double slope_y =
        slope(HeightAt(i, j - 1), HeightAt(i, j + 1), step_y);
    return core::Normalized(
        {static_cast<float>(-slope_x), static_cast<float>(-slope_y), 1});
  }

  // Heights lie about the middle of the window, so that a float holds them; x
  // and y rise with the mesh's columns and rows, whatever the frame's do.
  void MakeMesh() {
    const std::int64_t columns = window_.width();
    const std::int64_t rows = window_.height();
    const double step_x = job_->header().frame().spacing_x();
    const double step_y = job_->header().frame().spacing_y();
    const float lowest = *std::ranges::min_element(heights_, Lower());
    const double base =
        std::isnan(lowest) ? 0 : exaggeration_ * static_cast<double>(lowest);
    std::vector<core::Float3> positions;
    std::vector<core::Float3> normals;
    positions.reserve(heights_.size());
    normals.reserve(heights_.size());
    for (std::int64_t row = 0; row < rows; ++row) {
      const std::int64_t j = step_y < 0 ? rows - 1 - row : row;
      for (std::int64_t column = 0; column < columns; ++column) {
        const std::int64_t i = step_x < 0 ? columns - 1 - column : column;
        const double x =
            (static_cast<double>(i) - 0.5 * static_cast<double>(columns - 1)) *
            step_x;
        const double y =
            (static_cast<double>(j) - 0.5 * static_cast<double>(rows - 1)) *
            step_y;
        positions.push_back({static_cast<float>(x), static_cast<float>(y),
                             static_cast<float>(HeightAt(i, j) - base)});
        normals.push_back(NormalAt(i, j, step_x, step_y));
      }
    }
    heights_ = {};
    mesh_ = core::MakeGridMesh({columns, rows, positions, normals, {}});
    Paint();
    ready_ = true;
  }

  // NaN after every number.
  struct Lower {
    bool operator()(float a, float b) const {
      return std::isnan(b) ? !std::isnan(a) : a < b;
    }
  };

  void Paint() {
    float highest = 0;
    for (const core::Float3& p : mesh_.positions) {
      highest = std::max(highest, p.z);
    }
    const float scale = highest > 0 ? 1 / highest : 0;
    mesh_.colors.reserve(mesh_.positions.size());
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      mesh_.colors.push_back(
          ColorAt(scale * mesh_.positions[v].z, mesh_.normals[v].z));
    }
  }

  const std::shared_ptr<const TileJob> job_;
  const v1::Window window_;
  const double exaggeration_;
  std::vector<float> heights_;
  std::int64_t next_ = 0;
  bool ready_ = false;
  core::TileScratch scratch_;
  v1::HeightTile tile_;
  core::Mesh mesh_;
};

void CheckExaggeration(const v1::TerrainSubject& subject,
                       const SceneRequest& request) {
  if (!subject.has_exaggeration()) return;
  core::FieldChecks(request.violations)
      .Number(core::Path(&request.prefix).Field("terrain.exaggeration"),
              subject.exaggeration(), kExaggerations);
}

v1::StreamTilesRequest StreamOf(const v1::TerrainSubject& subject) {
  v1::StreamTilesRequest stream;
  *stream.mutable_terrain() = subject.terrain();
  stream.set_level(subject.level());
  if (subject.has_window()) *stream.mutable_window() = subject.window();
  return stream;
}

// What OpenTiles would open, checked before anything is made; nothing when the
// request has violations.
absl::StatusOr<std::optional<v1::Window>> CheckedWindow(
    const v1::TerrainSubject& subject, Actor* actor,
    const SceneRequest& request) {
  CheckExaggeration(subject, request);
  const std::string path = request.prefix + "terrain.";
  auto window = actor->CheckTiles(StreamOf(subject));
  if (!window.ok()) {
    const absl::Status moved =
        MoveViolations(window.status(), "", path, request.violations);
    if (!moved.ok()) return moved;
    return std::optional<v1::Window>();
  }
  if (window->width() < 2 || window->height() < 2) {
    request.violations->Add(path + "window", "must be at least 2 x 2 samples");
  }
  if (!request.violations->empty()) return std::optional<v1::Window>();
  return std::optional<v1::Window>(*std::move(window));
}

}  // namespace

OpenedScene OpenTerrainScene(const v1::TerrainSubject& subject, Actor* actor,
                             const SceneRequest& request) {
  const auto window = CheckedWindow(subject, actor, request);
  if (!window.ok()) return window.status();
  if (!window->has_value()) return std::unique_ptr<SceneSource>();
  const absl::Status checked = CheckTriangles(
      2 * ((*window)->width() - 1) * ((*window)->height() - 1), request.limits);
  if (!checked.ok()) return checked;
  const auto job = actor->OpenTiles(StreamOf(subject), request.stop);
  if (!job.ok()) {
    const absl::Status moved = MoveViolations(
        job.status(), "", request.prefix + "terrain.", request.violations);
    if (!moved.ok()) return moved;
    return std::unique_ptr<SceneSource>();
  }
  return std::make_unique<TerrainScene>(
      *job, subject.has_exaggeration() ? subject.exaggeration() : 1);
}

EstimatedScene EstimateTerrainScene(const v1::TerrainSubject& subject,
                                    Actor* actor, const SceneRequest& request) {
  const auto window = CheckedWindow(subject, actor, request);
  if (!window.ok()) return window.status();
  if (!window->has_value()) return core::SceneSize();
  v1::EstimateTilesRequest asked;
  *asked.mutable_request() = StreamOf(subject);
  const auto estimate = actor->EstimateTiles(asked, request.stop);
  if (!estimate.ok()) {
    const absl::Status moved =
        MoveViolations(estimate.status(), "request.",
                       request.prefix + "terrain.", request.violations);
    if (!moved.ok()) return moved;
    return core::SceneSize();
  }
  return core::SceneSize{estimate->samples(), 2 * estimate->samples(), 0};
}

}  // namespace terrane::server
