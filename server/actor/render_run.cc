#include "server/actor/render_run.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/raytrace/ray_tracer.h"
#include "core/raytrace/traced_scene.h"
#include "server/actor/headed_run.h"
#include "server/convert/column_checksum.h"

namespace terrane::server {
namespace {

// Of a task of the worker pool: some hundred milliseconds.
constexpr std::int64_t kPathsOfTask = 65'536;
// Position, normal and colour; three indices.
constexpr std::int64_t kMeshVertexBytes = 36;
constexpr std::int64_t kMeshTriangleBytes = 12;
constexpr std::int64_t kInstanceBytes = 40;
constexpr std::int64_t kPixelBytes = 12;
// Of all the work, what making the scene is told as.
constexpr double kSceneShare = 0.1;

v1::RenderHeader HeaderOf(const SceneSource& source, const RenderPlan& plan) {
  v1::RenderHeader header;
  header.set_recipe_hash(source.recipe_hash());
  header.set_width(plan.picture.width);
  header.set_height(plan.picture.height);
  header.set_passes(plan.passes);
  header.set_encoding(plan.encoding);
  header.set_band_rows(plan.band_rows());
  header.set_bands(plan.bands());
  return header;
}

class RenderRun : public HeadedRun<v1::StreamRenderResponse, v1::RenderHeader> {
 public:
  RenderRun(std::unique_ptr<SceneSource> source, const RenderPlan& plan,
            std::shared_ptr<MemoryBudget> memory,
            std::shared_ptr<CostMeter> meter)
      : HeadedRun(HeaderOf(*source, plan),
                  meter->Seconds(plan.pixels() * plan.passes)),
        source_(std::move(source)),
        plan_(plan),
        stages_(plan.Stages()),
        memory_(std::move(memory)),
        meter_(std::move(meter)) {}

 private:
  bool AllMade() const override {
    return next_band_ == plan_.bands() || plan_.first_band == plan_.bands();
  }

  absl::Status NextPart(std::stop_token stop,
                        v1::StreamRenderResponse* message) override {
    SetItems(0);
    absl::Status made;
    if (!source_->Ready()) {
      made = source_->Advance(std::move(stop));
    } else if (tracer_ == nullptr) {
      made = Build(std::move(stop));
    } else {
      return Trace(std::move(stop), message);
    }
    if (made.ok()) message->mutable_progress()->set_share(Share());
    return made;
  }

  absl::Status Build(std::stop_token stop) {
    const core::Scene scene = source_->scene();
    const core::SceneSize size = core::SizeOf(scene);
    auto share = MemoryBudget::Take(memory_, RenderBytes(size, plan_.pixels()));
    if (!share.ok()) return share.status();
    share_ = *std::move(share);
    auto traced = core::TracedScene::Build(scene, core::TracedBytes(size),
                                           std::move(stop));
    if (!traced.ok()) return traced.status();
    const core::Bounds& bounds = (*traced)->bounds();
    core::PictureSpec picture = plan_.picture;
    picture.camera = core::FrameScene(
        scene, bounds, plan_.view, plan_.field_of_view_deg,
        static_cast<float>(picture.width) / static_cast<float>(picture.height));
    picture.light = core::PlaceLight(bounds, plan_.light);
    if (plan_.ground) {
      picture.ground = core::PlaceGround(bounds, plan_.ground_material);
    }
    auto tracer = core::RayTracer::Create(*traced, scene.materials, picture);
    if (!tracer.ok()) return tracer.status();
    tracer_ = *std::move(tracer);
    sums_.resize(3 * static_cast<std::size_t>(plan_.pixels()));
    return absl::OkStatus();
  }

  // Adds passes to the band in hand: all that it lacks, or as many as a task
  // may take. The message is the band when it is whole.
  absl::Status Trace(std::stop_token stop, v1::StreamRenderResponse* message) {
    const int bands = plan_.bands_of_picture();
    const auto stage = static_cast<std::size_t>(next_band_ / bands);
    const int first_row =
        static_cast<int>(next_band_ % bands) * plan_.band_rows();
    const int rows =
        std::min(plan_.band_rows(), plan_.picture.height - first_row);
    const std::int64_t pixels = std::int64_t{rows} * plan_.picture.width;
    const std::span<float> sums = std::span(sums_).subspan(
        3 * static_cast<std::size_t>(first_row) *
            static_cast<std::size_t>(plan_.picture.width),
        3 * static_cast<std::size_t>(pixels));

    const int begin = (stage == 0 ? 0 : stages_[stage - 1]) + band_passes_;
    const int end = static_cast<int>(std::min<std::int64_t>(
        stages_[stage],
        begin + std::max<std::int64_t>(1, kPathsOfTask / pixels)));
    const auto start = std::chrono::steady_clock::now();
    for (int pass = begin; pass < end; ++pass) {
      const absl::Status added =
          tracer_->AddPass(pass, first_row, rows, stop, sums);
      if (!added.ok()) return added;
    }
    const std::int64_t paths = pixels * (end - begin);
    meter_->Add(std::chrono::steady_clock::now() - start, paths);
    SetItems(paths);
    paths_ += paths;
    band_passes_ += end - begin;
    if (end < stages_[stage]) {
      message->mutable_progress()->set_share(Share());
      return absl::OkStatus();
    }
    band_passes_ = 0;
    const std::int64_t index = next_band_++;
    if (index < plan_.first_band) {
      message->mutable_progress()->set_share(Share());
    } else {
      WriteBand(index, end, first_row, rows, sums, message->mutable_band());
    }
    return absl::OkStatus();
  }

  void WriteBand(std::int64_t index, int passes, int first_row, int rows,
                 std::span<const float> sums, v1::RenderBand* band) const {
    std::vector<float> mean(sums.begin(), sums.end());
    for (float& value : mean) value /= static_cast<float>(passes);
    band->set_index(index);
    band->set_passes(passes);
    band->set_first_row(first_row);
    band->set_rows(rows);
    *band->mutable_pixels() = EncodePixels(mean, plan_);
    band->set_checksum(ColumnChecksum({&band->pixels()}));
  }

  double Share() const {
    if (tracer_ == nullptr) return kSceneShare * source_->share();
    return kSceneShare +
           (1 - kSceneShare) * static_cast<double>(paths_) /
               (static_cast<double>(plan_.pixels()) * plan_.passes);
  }

  const std::unique_ptr<SceneSource> source_;
  const RenderPlan plan_;
  const std::vector<int> stages_;
  const std::shared_ptr<MemoryBudget> memory_;
  const std::shared_ptr<CostMeter> meter_;

  std::unique_ptr<MemoryBudget::Share> share_;
  std::shared_ptr<const core::RayTracer> tracer_;
  std::vector<float> sums_;
  std::int64_t next_band_ = 0;
  int band_passes_ = 0;  // of the stage, that the band has
  std::int64_t paths_ = 0;
};

}  // namespace

std::int64_t RenderBytes(const core::SceneSize& size, std::int64_t pixels) {
  return core::TracedBytes(size) + kMeshVertexBytes * size.vertices +
         kMeshTriangleBytes * size.triangles + kInstanceBytes * size.instances +
         kPixelBytes * pixels;
}

std::unique_ptr<MessageRun<v1::StreamRenderResponse>> MakeRenderRun(
    std::unique_ptr<SceneSource> source, const RenderPlan& plan,
    std::shared_ptr<MemoryBudget> memory, std::shared_ptr<CostMeter> meter) {
  return std::make_unique<RenderRun>(std::move(source), plan, std::move(memory),
                                     std::move(meter));
}

}  // namespace terrane::server
