#include "core/flower/instance_block.h"

namespace terrane::core {

void InstanceBlock::Clear() {
  prototype.clear();
  translation.clear();
  rotation.clear();
  scale.clear();
  organ.clear();
  n.clear();
  plant.clear();
}

void InstanceBlock::Add(const FlowerInstance& instance) {
  prototype.push_back(instance.prototype);
  translation.push_back(instance.translation);
  rotation.push_back(instance.rotation);
  scale.push_back(instance.scale);
  organ.push_back(instance.organ);
  n.push_back(instance.n);
  plant.push_back(instance.plant);
}

}  // namespace terrane::core
