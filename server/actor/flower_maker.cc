#include "server/actor/flower_maker.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/base/field_checks.h"
#include "core/flower/estimate_flower.h"
#include "core/flower/flower_generator.h"
#include "server/actor/chosen_recipe.h"
#include "server/actor/headed_run.h"
#include "server/actor/presets.h"
#include "server/convert/content_hash.h"
#include "server/convert/flower_convert.h"

namespace terrane::server {
namespace {

// Of a vertex of a prototype, until something was measured: a slow machine's.
// An instance costs about as much.
constexpr double kFirstNsPerVertex = 200;

constexpr auto kBlockRows =
    static_cast<std::int64_t>(core::FlowerGenerator::kBlockRows);

std::int64_t PrototypeParts(const core::FlowerSpec& spec) {
  std::int64_t parts = 0;
  for (const core::PrototypeKind& kind : core::PrototypeKinds(spec)) {
    parts +=
        kind.count * static_cast<std::int64_t>(PartsOfMesh(
                         static_cast<std::size_t>(kind.size.vertices),
                         static_cast<std::size_t>(3 * kind.size.triangles)));
  }
  return parts;
}

// All parts of a valid spec's stream.
std::int64_t PartsOf(const core::FlowerSpec& spec) {
  const std::int64_t rows = core::EstimateFlower(spec).instances;
  return PrototypeParts(spec) + (rows + kBlockRows - 1) / kBlockRows;
}

v1::FlowerHeader HeaderOf(const core::Flower& flower) {
  v1::FlowerHeader header;
  *header.mutable_recipe() = WriteFlowerRecipe(flower.spec());
  header.set_recipe_hash(RecipeHash(header.recipe()));
  header.set_revision(core::kFlowerRevision);
  header.set_prototypes(static_cast<int>(flower.prototypes().size()));
  header.set_rows(flower.rows());
  header.set_parts(PartsOf(flower.spec()));
  for (const std::string& warning : flower.warnings()) {
    header.add_warnings(warning);
  }
  return header;
}

// The parts of the prototypes, then those of the instances.
class FlowerRun : public HeadedRun<v1::StreamFlowerResponse, v1::FlowerHeader> {
 public:
  FlowerRun(std::shared_ptr<const core::Flower> flower, std::int64_t first_part,
            const CostMeter& meter)
      : HeadedRun(HeaderOf(*flower),
                  meter.Seconds(flower->estimate().instances)),
        flower_(std::move(flower)),
        prototype_parts_(PrototypeParts(flower_->spec())),
        part_(first_part),
        generator_(flower_, std::min(std::max<std::int64_t>(
                                         part_ - prototype_parts_, 0) *
                                         kBlockRows,
                                     flower_->rows())) {
    for (std::int64_t k = 0; k < std::min(part_, prototype_parts_); ++k) {
      Step();
    }
  }

 private:
  bool AllMade() const override { return part_ == this->header().parts(); }

  absl::Status NextPart(std::stop_token stop,
                        v1::StreamFlowerResponse* message) override {
    if (part_ < prototype_parts_) {
      v1::PrototypePart* const part = message->mutable_prototype();
      WritePrototypePart(flower_->prototypes()[prototype_], run_, part);
      part->set_part(part_++);
      part->set_prototype(static_cast<int>(prototype_));
      SetItems(static_cast<std::int64_t>(part->positions().size() /
                                         sizeof(core::Float3)));
      Step();
      return absl::OkStatus();
    }
    const absl::Status status = generator_.Next(std::move(stop), &block_);
    if (!status.ok()) return status;
    v1::InstanceRows* const rows = message->mutable_instances();
    WriteInstances(block_, rows);
    rows->set_part(part_++);
    SetItems(static_cast<std::int64_t>(block_.rows()));
    return absl::OkStatus();
  }

  // To the next run of the prototype, or to the next prototype.
  void Step() {
    const core::Mesh& mesh = flower_->prototypes()[prototype_].mesh;
    if (++run_ == PartsOfMesh(mesh.positions.size(), mesh.indices.size())) {
      run_ = 0;
      ++prototype_;
    }
  }

  const std::shared_ptr<const core::Flower> flower_;
  const std::int64_t prototype_parts_;
  std::int64_t part_;
  std::size_t prototype_ = 0;
  std::size_t run_ = 0;
  core::FlowerGenerator generator_;
  core::InstanceBlock block_;
};

}  // namespace

FlowerMaker::FlowerMaker(const Limits& limits)
    : limits_(limits), meter_(std::make_shared<CostMeter>(kFirstNsPerVertex)) {}

ChosenFlower FlowerMaker::Choose(const v1::FlowerChoice& choice,
                                 const std::string& path,
                                 core::Violations* violations) const {
  ChosenFlower chosen;
  const std::size_t before = violations->total();
  auto named = ChooseRecipe<v1::FlowerRecipe>(choice, FindFlowerPreset, path,
                                              violations);
  chosen.missing = std::move(named.missing);
  // The default of a recipe's bed, not of a choice.
  if (choice.has_plants() && choice.plants() == 0) {
    violations->Add(path + ".plants", "must be in [1, 1000000], got 0");
  }
  if (!named.recipe.has_value()) return chosen;
  v1::FlowerRecipe& recipe = *named.recipe;
  if (choice.has_stage()) recipe.set_stage(choice.stage());
  if (choice.method() != v1::PETAL_METHOD_UNSPECIFIED) {
    recipe.set_method(choice.method());
  }
  if (choice.has_plants()) recipe.mutable_bed()->set_plants(choice.plants());
  core::FlowerSpec spec =
      ReadFlowerRecipe(recipe, limits_.flower, named.prefix, violations);
  if (violations->total() == before) chosen.spec = std::move(spec);
  return chosen;
}

absl::StatusOr<std::shared_ptr<const core::Flower>> FlowerMaker::Make(
    const core::FlowerSpec& spec, const std::stop_token& stop) const {
  const auto start = std::chrono::steady_clock::now();
  auto flower = core::Flower::Create(spec, limits_.flower, stop);
  if (flower.ok()) {
    meter_->Add(std::chrono::steady_clock::now() - start,
                (*flower)->estimate().vertices);
  }
  return flower;
}

OpenedRun<v1::StreamFlowerResponse> FlowerMaker::Open(
    const v1::StreamFlowerRequest& request, const std::stop_token& stop) const {
  core::Violations violations;
  const ChosenFlower chosen = Choose(request.flower(), "flower", &violations);
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("first_part"), request.first_part(), 0,
               chosen.spec.has_value()
                   ? PartsOf(*chosen.spec)
                   : std::numeric_limits<std::int64_t>::max());
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  auto flower = Make(*chosen.spec, stop);
  if (!flower.ok()) return flower.status();
  return std::make_unique<FlowerRun>(*std::move(flower), request.first_part(),
                                     *meter_);
}

absl::StatusOr<v1::EstimateFlowerResponse> FlowerMaker::Estimate(
    const v1::EstimateFlowerRequest& request) const {
  core::Violations violations;
  const ChosenFlower chosen = Choose(request.flower(), "flower", &violations);
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  const core::FlowerEstimate estimate = core::EstimateFlower(*chosen.spec);
  v1::EstimateFlowerResponse response;
  response.set_prototypes(estimate.prototypes);
  response.set_vertices(estimate.vertices);
  response.set_triangles(estimate.triangles);
  response.set_prototype_bytes(estimate.prototype_bytes);
  response.set_instances(estimate.instances);
  response.set_instance_bytes(estimate.instance_bytes);
  response.set_control_values(estimate.control_values);
  response.set_cpu_seconds(
      meter_->Seconds(estimate.vertices + estimate.instances));
  // Two messages in hand and the block that they come from.
  response.set_memory_bytes(estimate.prototype_bytes +
                            3 * std::min(estimate.instances, kBlockRows) *
                                core::kInstanceBytes);
  return response;
}

absl::StatusOr<v1::GetFlowerPresetResponse> FlowerMaker::GetPreset(
    const v1::GetFlowerPresetRequest& request) const {
  const auto preset = FindFlowerPreset(request.name());
  if (!preset.ok()) return preset.status();
  v1::GetFlowerPresetResponse response;
  *response.mutable_preset() = **preset;
  return response;
}

}  // namespace terrane::server
