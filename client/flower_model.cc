#include "client/flower_model.h"

#include <string>
#include <utility>

#include "client/column_check.h"
#include "core/base/column_bytes.h"

namespace terrane::client {
namespace {

core::Material MaterialOf(const v1::FlowerMaterial& message) {
  core::Material material;
  material.name = message.name();
  material.base_color = {message.base_color().red(),
                         message.base_color().green(),
                         message.base_color().blue()};
  material.roughness = message.roughness();
  material.specular = message.specular();
  material.gloss = message.gloss();
  material.double_sided = message.double_sided();
  return material;
}

}  // namespace

absl::StatusOr<FlowerModel> FlowerModel::Stream(const v1::FlowerChoice& choice,
                                                ProgressMode progress,
                                                FlowerBackend* backend,
                                                std::stop_token stop) {
  v1::StreamFlowerRequest request;
  *request.mutable_flower() = choice;
  FlowerModel model;
  std::optional<Progress> bar;
  const absl::Status status = backend->StreamFlower(
      request,
      [&](const v1::FlowerHeader& header) {
        model.header_ = header;
        model.prototypes_.resize(static_cast<std::size_t>(header.prototypes()));
        bar.emplace(progress, header.rows());
        return absl::OkStatus();
      },
      [&](const v1::StreamFlowerResponse& message) {
        if (message.has_prototype()) {
          model.AddPrototype(message.prototype());
        } else {
          model.AddInstances(message.instances());
          bar->Advance(message.instances().rows());
        }
        return absl::OkStatus();
      },
      std::move(stop));
  if (!status.ok()) return status;
  return model;
}

void FlowerModel::AddPrototype(const v1::PrototypePart& part) {
  Prototype& prototype =
      prototypes_[static_cast<std::size_t>(part.prototype())];
  if (part.has_info()) prototype.info = part.info();
  core::AppendColumn(part.positions(), &prototype.mesh.positions);
  core::AppendColumn(part.normals(), &prototype.mesh.normals);
  core::AppendColumn(part.uvs(), &prototype.mesh.uvs);
  core::AppendColumn(part.colors(), &prototype.mesh.colors);
  core::AppendColumn(part.indices(), &prototype.mesh.indices);
  data_bytes_ += static_cast<std::int64_t>(
      part.positions().size() + part.normals().size() + part.uvs().size() +
      part.colors().size() + part.indices().size());
}

void FlowerModel::AddInstances(const v1::InstanceRows& rows) {
  constexpr std::int64_t kInstanceBytes = 53;
  for (std::int64_t k = 0; k < rows.rows(); ++k) {
    core::Instances& instances =
        prototypes_[core::ElementOf<std::uint32_t>(rows.prototypes(), k)]
            .instances;
    instances.translations.push_back(
        core::ElementOf<core::Float3>(rows.translations(), k));
    instances.rotations.push_back(
        core::ElementOf<core::Quaternion>(rows.rotations(), k));
    instances.scales.push_back(core::ElementOf<core::Float3>(rows.scales(), k));
  }
  data_bytes_ += rows.rows() * kInstanceBytes;
}

std::int64_t FlowerModel::vertices() const {
  std::int64_t vertices = 0;
  for (const Prototype& prototype : prototypes_) {
    vertices += prototype.info.vertices();
  }
  return vertices;
}

std::int64_t FlowerModel::triangles() const {
  std::int64_t triangles = 0;
  for (const Prototype& prototype : prototypes_) {
    triangles += prototype.info.indices() / 3;
  }
  return triangles;
}

core::Scene FlowerModel::View() const {
  core::Scene scene;
  for (const Prototype& prototype : prototypes_) {
    if (prototype.instances.count() == 0) continue;
    core::Material material = MaterialOf(prototype.info.material());
    std::size_t index = 0;
    while (index < scene.materials.size() &&
           scene.materials[index] != material) {
      ++index;
    }
    if (index == scene.materials.size()) {
      scene.materials.push_back(std::move(material));
    }
    scene.objects.push_back(
        {prototype.info.name(), &prototype.mesh, index, &prototype.instances});
  }
  return scene;
}

}  // namespace terrane::client
