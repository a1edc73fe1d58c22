// The scene of a flower: its prototypes, and the instances that stand in the
// bed.
#include "core/flower/flower_scene.h"

#include <memory>
#include <utility>

#include "core/flower/flower_generator.h"
#include "server/actor/scenes/scene_source.h"
#include "server/convert/content_hash.h"
#include "server/convert/flower_convert.h"

namespace terrane::server {
namespace {

class FlowerSceneSource : public SceneSource {
 public:
  explicit FlowerSceneSource(std::shared_ptr<const core::Flower> flower)
      : flower_(std::move(flower)),
        recipe_hash_(RecipeHash(WriteFlowerRecipe(flower_->spec()))),
        generator_(flower_),
        scene_(flower_) {}

  const std::string& recipe_hash() const override { return recipe_hash_; }

  absl::Status Advance(std::stop_token stop) override {
    const absl::Status made = generator_.Next(std::move(stop), &block_);
    if (!made.ok()) return made;
    scene_.Add(block_);
    rows_ += static_cast<std::int64_t>(block_.rows());
    return made;
  }

  double share() const override {
    return static_cast<double>(rows_) / static_cast<double>(flower_->rows());
  }
  bool Ready() const override { return generator_.Done(); }
  core::Scene scene() const override { return scene_.View(); }

 private:
  const std::shared_ptr<const core::Flower> flower_;
  const std::string recipe_hash_;
  core::FlowerGenerator generator_;
  core::InstanceBlock block_;
  std::int64_t rows_ = 0;
  core::FlowerScene scene_;
};

}  // namespace

OpenedScene OpenFlowerScene(const v1::FlowerSubject& subject,
                            const FlowerMaker& flowers,
                            const SceneRequest& request) {
  const ChosenFlower chosen = flowers.Choose(
      subject.flower(), request.prefix + "flower.flower", request.violations);
  if (!chosen.missing.ok()) return chosen.missing;
  if (!request.violations->empty()) return std::unique_ptr<SceneSource>();
  const core::FlowerEstimate estimate = core::EstimateFlower(*chosen.spec);
  const absl::Status size =
      CheckTriangles(estimate.triangles + estimate.instances, request.limits);
  if (!size.ok()) return size;
  auto flower = flowers.Make(*chosen.spec, request.stop);
  if (!flower.ok()) return flower.status();
  return std::make_unique<FlowerSceneSource>(*std::move(flower));
}

EstimatedScene EstimateFlowerScene(const v1::FlowerSubject& subject,
                                   const FlowerMaker& flowers,
                                   const SceneRequest& request) {
  v1::EstimateFlowerRequest asked;
  *asked.mutable_flower() = subject.flower();
  const auto estimate = flowers.Estimate(asked);
  if (!estimate.ok()) {
    const absl::Status moved = MoveViolations(
        estimate.status(), "", request.prefix + "flower.", request.violations);
    if (!moved.ok()) return moved;
    return core::SceneSize();
  }
  return core::SceneSize{estimate->vertices(), estimate->triangles(),
                         estimate->instances()};
}

}  // namespace terrane::server
