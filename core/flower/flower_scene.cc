#include "core/flower/flower_scene.h"

#include <algorithm>
#include <utility>

#include "core/flower/flower_generator.h"

namespace terrane::core {

FlowerScene::FlowerScene(std::shared_ptr<const Flower> flower)
    : flower_(std::move(flower)), instances_(flower_->prototypes().size()) {}

void FlowerScene::Add(const InstanceBlock& block) {
  for (std::size_t i = 0; i < block.rows(); ++i) {
    Instances& instances = instances_[block.prototype[i]];
    instances.translations.push_back(block.translation[i]);
    instances.rotations.push_back(block.rotation[i]);
    instances.scales.push_back(block.scale[i]);
  }
}

Scene FlowerScene::View() const {
  Scene scene;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (instances_[i].count() == 0) continue;
    const FlowerPrototype& prototype = flower_->prototypes()[i];
    auto material = std::find(scene.materials.begin(), scene.materials.end(),
                              prototype.material);
    if (material == scene.materials.end()) {
      material = scene.materials.insert(material, prototype.material);
    }
    scene.objects.push_back(
        {prototype.name, &prototype.mesh,
         static_cast<std::size_t>(material - scene.materials.begin()),
         &instances_[i]});
  }
  return scene;
}

absl::StatusOr<std::unique_ptr<FlowerScene>> FlowerScene::Create(
    std::shared_ptr<const Flower> flower, std::stop_token stop) {
  auto scene = std::make_unique<FlowerScene>(flower);
  FlowerGenerator generator(std::move(flower));
  InstanceBlock block;
  while (!generator.Done()) {
    const absl::Status status = generator.Next(stop, &block);
    if (!status.ok()) return status;
    scene->Add(block);
  }
  return scene;
}

}  // namespace terrane::core
