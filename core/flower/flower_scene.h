// FlowerScene: a flower or a bed as a scene, for files and pictures.
//
// Owns the columns of instances, one set for each prototype that has any, and
// the materials; refers to the prototypes' meshes, so it shares the Flower.
// Memory: all instances of the bed. Belongs to one thread at a time.
#ifndef TERRANE_CORE_FLOWER_FLOWER_SCENE_H_
#define TERRANE_CORE_FLOWER_FLOWER_SCENE_H_

#include <memory>
#include <stop_token>
#include <vector>

#include "absl/status/statusor.h"
#include "core/flower/flower.h"
#include "core/flower/instance_block.h"
#include "core/mesh/scene.h"

namespace terrane::core {

class FlowerScene {
 public:
  explicit FlowerScene(std::shared_ptr<const Flower> flower);
  FlowerScene(const FlowerScene&) = delete;
  FlowerScene& operator=(const FlowerScene&) = delete;

  void Add(const InstanceBlock& block);

  // Objects and materials in the prototypes' order, those without an instance
  // left out. Refers to this.
  Scene View() const;

  // The whole flower. Errors: CANCELLED.
  static absl::StatusOr<std::unique_ptr<FlowerScene>> Create(
      std::shared_ptr<const Flower> flower, std::stop_token stop);

 private:
  std::shared_ptr<const Flower> flower_;
  std::vector<Instances> instances_;  // by prototype
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_FLOWER_SCENE_H_
