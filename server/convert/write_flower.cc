#include <algorithm>
#include <vector>

#include "core/base/column_bytes.h"
#include "server/convert/column_checksum.h"
#include "server/convert/flower_convert.h"
#include "server/convert/flower_enums.h"

namespace terrane::server {
namespace {

void WriteTint(const core::Tint& tint, v1::Tint* message) {
  message->set_red(tint[0]);
  message->set_green(tint[1]);
  message->set_blue(tint[2]);
}

void WriteMaterial(const core::Material& material,
                   v1::FlowerMaterial* message) {
  message->set_name(material.name);
  WriteTint(material.base_color, message->mutable_base_color());
  message->set_roughness(material.roughness);
  message->set_specular(material.specular);
  message->set_gloss(material.Gloss());
  message->set_double_sided(material.double_sided);
}

void WriteRelief(const core::Relief& relief, v1::Relief* message) {
  message->set_amplitude(relief.amplitude);
  message->set_frequency_x(relief.frequency_x);
  message->set_frequency_y(relief.frequency_y);
  message->set_gain(relief.gain);
  message->set_unmirrored(!relief.mirrored);
}

void WriteShape(const core::BladeShape& shape, v1::BladeShape* message) {
  message->set_across_deg(shape.across_deg);
  message->set_base_curl_deg(shape.base_curl_deg);
  message->set_tip_curl_deg(shape.tip_curl_deg);
  message->set_flare(shape.flare);
  message->set_relief(shape.relief);
}

void WriteColors(const core::BladeColors& colors, v1::BladeColors* message) {
  WriteTint(colors.base, message->mutable_base());
  WriteTint(colors.tip, message->mutable_tip());
  message->set_middle(colors.middle);
  if (colors.blotch.has_value()) {
    v1::Blotch* const blotch = message->mutable_blotch();
    WriteTint(colors.blotch->tint, blotch->mutable_tint());
    blotch->set_from(colors.blotch->from);
    blotch->set_to(colors.blotch->to);
    blotch->set_rays(colors.blotch->rays);
  }
  WriteTint(colors.margin, message->mutable_margin());
  message->set_margin_width(colors.margin_width);
}

void WriteBlade(const core::BladeSpec& blade, v1::Blade* message) {
  for (const core::Sketch& sketch : blade.sketches) {
    v1::Sketch* const written = message->add_sketches();
    for (const core::SketchPoint& point : sketch.points) {
      v1::SketchPoint* const added = written->add_points();
      added->set_x(point.x);
      added->set_y(point.y);
    }
    written->set_base(WriteEnum(kSketchEnds, sketch.base));
    written->set_tip(WriteEnum(kSketchEnds, sketch.tip));
  }
  WriteRelief(blade.relief, message->mutable_relief());
  message->set_variants(blade.variants);
  WriteShape(blade.closed, message->mutable_closed());
  WriteShape(blade.open, message->mutable_open());
  message->set_steps(blade.steps);
  message->set_columns(blade.columns);
  message->set_rows(blade.rows);
  WriteMaterial(blade.material, message->mutable_material());
  WriteColors(blade.colors, message->mutable_colors());
}

void WriteArrangement(const core::Arrangement& arrangement,
                      v1::Arrangement* message) {
  message->set_kind(WriteEnum(kArrangementKinds, arrangement.kind));
  message->set_divergence_deg(arrangement.divergence_deg);
  message->set_spacing(arrangement.spacing);
  message->set_radius(arrangement.radius);
  message->set_phase_deg(arrangement.phase_deg);
  message->set_layers(arrangement.layers);
  message->set_arc_deg(arrangement.arc_deg);
  message->set_height(arrangement.height);
  message->set_dome(arrangement.dome);
}

void WritePetals(const core::PetalGroup& group, v1::PetalGroup* message) {
  message->set_organ(WriteEnum(kFlowerOrgans, group.organ));
  message->set_count(group.count);
  WriteBlade(group.blade, message->mutable_blade());
  WriteArrangement(group.arrangement, message->mutable_arrangement());
  message->set_angle_deg(group.angle_deg);
  message->set_open_angle_deg(group.open_angle_deg);
  message->set_inner_size(group.inner_size);
  message->set_outer_size(group.outer_size);
  message->set_swirl_deg(group.swirl_deg);
}

void WriteSolids(const core::SolidGroup& group, v1::SolidGroup* message) {
  message->set_organ(WriteEnum(kFlowerOrgans, group.organ));
  message->set_count(group.count);
  WriteArrangement(group.arrangement, message->mutable_arrangement());
  message->set_inner_angle_deg(group.inner_angle_deg);
  message->set_outer_angle_deg(group.outer_angle_deg);
  message->set_inner_size(group.inner_size);
  message->set_outer_size(group.outer_size);
  message->set_filament_length(group.filament_length);
  message->set_filament_radius(group.filament_radius);
  message->set_head_length(group.head_length);
  message->set_head_radius(group.head_radius);
  message->set_sides(group.sides);
  WriteMaterial(group.material, message->mutable_material());
  WriteTint(group.filament_tint, message->mutable_filament_tint());
  WriteTint(group.head_tint, message->mutable_head_tint());
}

void WriteLeafGroup(const core::LeafGroup& group, v1::LeafGroup* message) {
  message->set_count(group.count);
  WriteBlade(group.blade, message->mutable_blade());
  message->set_from(group.from);
  message->set_to(group.to);
  message->set_angle_deg(group.angle_deg);
  message->set_size(group.size);
  message->set_divergence_deg(group.divergence_deg);
  message->set_leaflets(group.leaflets);
  message->set_stalk(group.stalk);
}

void WriteStem(const core::StemSpec& stem, v1::FlowerStem* message) {
  message->set_height(stem.height);
  message->set_radius(stem.radius);
  message->set_taper(stem.taper);
  message->set_bend(stem.bend);
  message->set_nod_deg(stem.nod_deg);
  message->set_variants(stem.variants);
  message->set_sides(stem.sides);
  message->set_rows(stem.rows);
  WriteMaterial(stem.material, message->mutable_material());
}

void WriteStage(const core::GrowthStage& stage, v1::GrowthStage* message) {
  message->set_buds(stage.buds);
  message->set_angle_ratio(stage.angle_ratio);
  message->set_size(stage.size);
  message->set_spread(stage.spread);
}

// Elements [first, first + count) of a column, those that there are.
template <typename Value>
void WriteRun(const std::vector<Value>& column, std::size_t first,
              std::size_t count, std::string* bytes) {
  const std::size_t begin = std::min(first, column.size());
  const std::size_t end = std::min(first + count, column.size());
  bytes->assign(reinterpret_cast<const char*>(column.data() + begin),
                (end - begin) * sizeof(Value));
}

}  // namespace

v1::FlowerRecipe WriteFlowerRecipe(const core::FlowerSpec& spec) {
  v1::FlowerRecipe recipe;
  recipe.set_seed(spec.seed);
  recipe.set_unit_m(spec.unit_m);
  recipe.set_method(WriteEnum(kPetalMethods, spec.method));
  for (const core::PetalGroup& group : spec.petals) {
    WritePetals(group, recipe.add_petals());
  }
  for (const core::SolidGroup& group : spec.solids) {
    WriteSolids(group, recipe.add_solids());
  }
  for (const core::LeafGroup& group : spec.leaves) {
    WriteLeafGroup(group, recipe.add_leaves());
  }
  if (spec.stem.has_value()) WriteStem(*spec.stem, recipe.mutable_stem());
  recipe.set_stage(spec.stage);
  WriteStage(spec.early, recipe.mutable_early());
  WriteStage(spec.full, recipe.mutable_full());
  recipe.set_variation(spec.variation);
  v1::FlowerBed* const bed = recipe.mutable_bed();
  bed->set_plants(spec.bed.plants);
  bed->set_layout(WriteEnum(kBedLayouts, spec.bed.layout));
  bed->set_spacing_m(spec.bed.spacing_m);
  bed->set_jitter(spec.bed.jitter);
  bed->set_turn_deg(spec.bed.turn_deg);
  return recipe;
}

std::size_t PartsOfMesh(std::size_t vertices, std::size_t indices) {
  return std::max<std::size_t>({1,
                                (vertices + kPartVertices - 1) / kPartVertices,
                                (indices + kPartIndices - 1) / kPartIndices});
}

void WritePrototypePart(const core::FlowerPrototype& prototype, std::size_t run,
                        v1::PrototypePart* part) {
  const core::Mesh& mesh = prototype.mesh;
  part->clear_info();
  if (run == 0) {
    v1::PrototypeInfo* const info = part->mutable_info();
    info->set_name(prototype.name);
    info->set_organ(WriteEnum(kFlowerOrgans, prototype.organ));
    WriteMaterial(prototype.material, info->mutable_material());
    info->set_vertices(static_cast<int>(mesh.positions.size()));
    info->set_indices(static_cast<int>(mesh.indices.size()));
    info->set_has_colors(!mesh.colors.empty());
  }
  const std::size_t first = run * kPartVertices;
  WriteRun(mesh.positions, first, kPartVertices, part->mutable_positions());
  WriteRun(mesh.normals, first, kPartVertices, part->mutable_normals());
  WriteRun(mesh.uvs, first, kPartVertices, part->mutable_uvs());
  WriteRun(mesh.colors, first, kPartVertices, part->mutable_colors());
  WriteRun(mesh.indices, run * kPartIndices, kPartIndices,
           part->mutable_indices());
  part->set_checksum(
      ColumnChecksum({&part->positions(), &part->normals(), &part->uvs(),
                      &part->colors(), &part->indices()}));
}

void WriteInstances(const core::InstanceBlock& block, v1::InstanceRows* rows) {
  rows->set_first_row(block.first_row);
  rows->set_rows(static_cast<int>(block.rows()));
  core::WriteColumn(block.prototype, rows->mutable_prototypes());
  core::WriteColumn(block.translation, rows->mutable_translations());
  core::WriteColumn(block.rotation, rows->mutable_rotations());
  core::WriteColumn(block.scale, rows->mutable_scales());
  std::string* const organs = rows->mutable_organs();
  organs->clear();
  for (const core::FlowerOrgan organ : block.organ) {
    organs->push_back(static_cast<char>(WriteEnum(kFlowerOrgans, organ)));
  }
  core::WriteColumn(block.n, rows->mutable_numbers());
  core::WriteColumn(block.plant, rows->mutable_plants());
  rows->set_checksum(ColumnChecksum(
      {&rows->prototypes(), &rows->translations(), &rows->rotations(),
       &rows->scales(), &rows->organs(), &rows->numbers(), &rows->plants()}));
}

}  // namespace terrane::server
