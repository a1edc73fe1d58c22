#include <algorithm>
#include <string>
#include <vector>

#include "core/base/field_checks.h"
#include "server/convert/flower_convert.h"
#include "server/convert/flower_enums.h"
#include "server/convert/non_zero.h"

namespace terrane::server {
namespace {

using core::Path;
using core::Violations;

// More groups, sketches and points than a flower may have are not read: the
// core says that they are too many.
constexpr int kMostRead = 17;

template <typename Repeated>
int CountToRead(const Repeated& repeated) {
  return std::min(repeated.size(), kMostRead);
}

core::Tint ReadTint(const v1::Tint& tint) {
  return {tint.red(), tint.green(), tint.blue()};
}

core::Material ReadMaterial(const v1::FlowerMaterial& message, const Path& path,
                            Violations* violations) {
  constexpr std::size_t kMostNameBytes = 64;
  core::Material material;
  if (message.name().size() > kMostNameBytes) {
    violations->Add(path.Field("name").Text(),
                    "must have at most " + std::to_string(kMostNameBytes) +
                        " bytes, got " + std::to_string(message.name().size()));
  }
  material.name = message.name();
  if (message.has_base_color()) {
    material.base_color = ReadTint(message.base_color());
  }
  if (message.has_roughness()) material.roughness = message.roughness();
  if (message.has_specular()) material.specular = message.specular();
  if (message.has_gloss()) material.gloss = message.gloss();
  material.double_sided = message.double_sided();
  return material;
}

core::Sketch ReadSketch(const v1::Sketch& message, const Path& path,
                        Violations* violations) {
  core::Sketch sketch;
  for (int k = 0; k < CountToRead(message.points()); ++k) {
    sketch.points.push_back({message.points(k).x(), message.points(k).y()});
  }
  sketch.base =
      ReadEnum(kSketchEnds, message.base(), path.Field("base"), violations);
  if (message.tip() != v1::SKETCH_END_UNSPECIFIED) {
    sketch.tip =
        ReadEnum(kSketchEnds, message.tip(), path.Field("tip"), violations);
  }
  return sketch;
}

core::Relief ReadRelief(const v1::Relief& message) {
  core::Relief relief;
  if (message.has_amplitude()) relief.amplitude = message.amplitude();
  if (message.has_frequency_x()) relief.frequency_x = message.frequency_x();
  if (message.has_frequency_y()) relief.frequency_y = message.frequency_y();
  ReadNonZero(message.gain(), &relief.gain);
  relief.mirrored = !message.unmirrored();
  return relief;
}

core::BladeShape ReadShape(const v1::BladeShape& message) {
  core::BladeShape shape;
  shape.across_deg = message.across_deg();
  shape.base_curl_deg = message.base_curl_deg();
  shape.tip_curl_deg = message.tip_curl_deg();
  shape.flare = message.flare();
  if (message.has_relief()) shape.relief = message.relief();
  return shape;
}

core::BladeColors ReadColors(const v1::BladeColors& message) {
  core::BladeColors colors;
  if (message.has_base()) colors.base = ReadTint(message.base());
  if (message.has_tip()) colors.tip = ReadTint(message.tip());
  ReadNonZero(message.middle(), &colors.middle);
  if (message.has_blotch()) {
    core::Blotch blotch;
    if (message.blotch().has_tint()) {
      blotch.tint = ReadTint(message.blotch().tint());
    }
    blotch.from = message.blotch().from();
    ReadNonZero(message.blotch().to(), &blotch.to);
    blotch.rays = message.blotch().rays();
    colors.blotch = blotch;
  }
  if (message.has_margin()) colors.margin = ReadTint(message.margin());
  colors.margin_width = message.margin_width();
  return colors;
}

core::BladeSpec ReadBlade(const v1::Blade& message, const Path& path,
                          Violations* violations) {
  core::BladeSpec blade;
  for (int k = 0; k < CountToRead(message.sketches()); ++k) {
    blade.sketches.push_back(ReadSketch(
        message.sketches(k),
        path.Element("sketches", static_cast<std::size_t>(k)), violations));
  }
  blade.relief = ReadRelief(message.relief());
  ReadNonZero(message.variants(), &blade.variants);
  blade.closed = ReadShape(message.closed());
  blade.open = ReadShape(message.open());
  ReadNonZero(message.steps(), &blade.steps);
  ReadNonZero(message.columns(), &blade.columns);
  ReadNonZero(message.rows(), &blade.rows);
  blade.material =
      ReadMaterial(message.material(), path.Field("material"), violations);
  blade.colors = ReadColors(message.colors());
  return blade;
}

core::Arrangement ReadArrangement(const v1::Arrangement& message,
                                  const Path& path, Violations* violations) {
  core::Arrangement arrangement;
  arrangement.kind = ReadEnum(kArrangementKinds, message.kind(),
                              path.Field("kind"), violations);
  ReadNonZero(message.divergence_deg(), &arrangement.divergence_deg);
  if (message.has_spacing()) arrangement.spacing = message.spacing();
  arrangement.radius = message.radius();
  arrangement.phase_deg = message.phase_deg();
  ReadNonZero(message.layers(), &arrangement.layers);
  ReadNonZero(message.arc_deg(), &arrangement.arc_deg);
  arrangement.height = message.height();
  arrangement.dome = message.dome();
  return arrangement;
}

core::PetalGroup ReadPetals(const v1::PetalGroup& message, const Path& path,
                            Violations* violations) {
  core::PetalGroup group;
  group.organ =
      ReadEnum(kFlowerOrgans, message.organ(), path.Field("organ"), violations);
  ReadNonZero(message.count(), &group.count);
  group.blade = ReadBlade(message.blade(), path.Field("blade"), violations);
  group.arrangement = ReadArrangement(message.arrangement(),
                                      path.Field("arrangement"), violations);
  if (message.has_angle_deg()) group.angle_deg = message.angle_deg();
  if (message.has_open_angle_deg()) {
    group.open_angle_deg = message.open_angle_deg();
  }
  ReadNonZero(message.inner_size(), &group.inner_size);
  ReadNonZero(message.outer_size(), &group.outer_size);
  group.swirl_deg = message.swirl_deg();
  return group;
}

core::SolidGroup ReadSolids(const v1::SolidGroup& message, const Path& path,
                            Violations* violations) {
  core::SolidGroup group;
  if (message.organ() != v1::FLOWER_ORGAN_UNSPECIFIED) {
    group.organ = ReadEnum(kFlowerOrgans, message.organ(), path.Field("organ"),
                           violations);
  }
  ReadNonZero(message.count(), &group.count);
  group.arrangement = ReadArrangement(message.arrangement(),
                                      path.Field("arrangement"), violations);
  if (message.has_inner_angle_deg()) {
    group.inner_angle_deg = message.inner_angle_deg();
  }
  if (message.has_outer_angle_deg()) {
    group.outer_angle_deg = message.outer_angle_deg();
  }
  ReadNonZero(message.inner_size(), &group.inner_size);
  ReadNonZero(message.outer_size(), &group.outer_size);
  if (message.has_filament_length()) {
    group.filament_length = message.filament_length();
  }
  if (message.has_filament_radius()) {
    group.filament_radius = message.filament_radius();
  }
  if (message.has_head_length()) group.head_length = message.head_length();
  if (message.has_head_radius()) group.head_radius = message.head_radius();
  ReadNonZero(message.sides(), &group.sides);
  group.material =
      ReadMaterial(message.material(), path.Field("material"), violations);
  if (message.has_filament_tint()) {
    group.filament_tint = ReadTint(message.filament_tint());
  }
  if (message.has_head_tint()) group.head_tint = ReadTint(message.head_tint());
  return group;
}

core::LeafGroup ReadLeafGroup(const v1::LeafGroup& message, const Path& path,
                              Violations* violations) {
  core::LeafGroup group;
  ReadNonZero(message.count(), &group.count);
  group.blade = ReadBlade(message.blade(), path.Field("blade"), violations);
  if (message.has_from()) group.from = message.from();
  if (message.has_to()) group.to = message.to();
  if (message.has_angle_deg()) group.angle_deg = message.angle_deg();
  ReadNonZero(message.size(), &group.size);
  if (message.has_divergence_deg()) {
    group.divergence_deg = message.divergence_deg();
  }
  ReadNonZero(message.leaflets(), &group.leaflets);
  if (message.has_stalk()) group.stalk = message.stalk();
  return group;
}

core::StemSpec ReadStem(const v1::FlowerStem& message, const Path& path,
                        Violations* violations) {
  core::StemSpec stem;
  ReadNonZero(message.height(), &stem.height);
  ReadNonZero(message.radius(), &stem.radius);
  ReadNonZero(message.taper(), &stem.taper);
  if (message.has_bend()) stem.bend = message.bend();
  stem.nod_deg = message.nod_deg();
  ReadNonZero(message.variants(), &stem.variants);
  ReadNonZero(message.sides(), &stem.sides);
  ReadNonZero(message.rows(), &stem.rows);
  stem.material =
      ReadMaterial(message.material(), path.Field("material"), violations);
  return stem;
}

core::GrowthStage ReadStage(const v1::GrowthStage& message) {
  core::GrowthStage stage;
  stage.buds = message.buds();
  if (message.has_angle_ratio()) stage.angle_ratio = message.angle_ratio();
  ReadNonZero(message.size(), &stage.size);
  ReadNonZero(message.spread(), &stage.spread);
  return stage;
}

core::BedSpec ReadBed(const v1::FlowerBed& message, const Path& path,
                      Violations* violations) {
  core::BedSpec bed;
  ReadNonZero(message.plants(), &bed.plants);
  bed.layout =
      ReadEnum(kBedLayouts, message.layout(), path.Field("layout"), violations);
  ReadNonZero(message.spacing_m(), &bed.spacing_m);
  if (message.has_jitter()) bed.jitter = message.jitter();
  if (message.has_turn_deg()) bed.turn_deg = message.turn_deg();
  return bed;
}

// The groups of one kind, by `read`.
template <typename Group, typename Message>
std::vector<Group> ReadGroups(
    const google::protobuf::RepeatedPtrField<Message>& messages,
    Group (*read)(const Message&, const Path&, Violations*), const Path& root,
    const char* name, Violations* violations) {
  std::vector<Group> groups;
  for (int k = 0; k < CountToRead(messages); ++k) {
    groups.push_back(read(messages[k],
                          root.Element(name, static_cast<std::size_t>(k)),
                          violations));
  }
  return groups;
}

}  // namespace

core::FlowerSpec ReadFlowerRecipe(const v1::FlowerRecipe& recipe,
                                  const core::FlowerLimits& limits,
                                  const std::string& prefix,
                                  core::Violations* violations) {
  const Path root(&prefix);
  core::FlowerSpec spec;
  spec.seed = recipe.seed();
  ReadNonZero(recipe.unit_m(), &spec.unit_m);
  spec.method = ReadEnum(kPetalMethods, recipe.method(), root.Field("method"),
                         violations);
  spec.petals =
      ReadGroups(recipe.petals(), ReadPetals, root, "petals", violations);
  spec.solids =
      ReadGroups(recipe.solids(), ReadSolids, root, "solids", violations);
  spec.leaves =
      ReadGroups(recipe.leaves(), ReadLeafGroup, root, "leaves", violations);
  if (recipe.has_stem())
    spec.stem = ReadStem(recipe.stem(), root.Field("stem"), violations);
  if (recipe.has_stage()) spec.stage = recipe.stage();
  if (recipe.has_early()) spec.early = ReadStage(recipe.early());
  if (recipe.has_full()) spec.full = ReadStage(recipe.full());
  if (recipe.has_variation()) spec.variation = recipe.variation();
  spec.bed = ReadBed(recipe.bed(), root.Field("bed"), violations);
  core::ValidateFlowerSpec(spec, limits, prefix, violations);
  return spec;
}

}  // namespace terrane::server
