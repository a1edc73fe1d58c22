#include "tests/core/flower_parts.h"

namespace terrane::core {
namespace {

Material StemMaterial() {
  return MakeMaterial("stem", {0.14f, 0.28f, 0.07f}, 0.7f);
}

}  // namespace

Material MakeMaterial(const char* name, Tint color, float roughness) {
  Material material;
  material.name = name;
  material.base_color = color;
  material.roughness = roughness;
  material.double_sided = true;
  return material;
}

Material LeafMaterial() {
  return MakeMaterial("leaf", {0.10f, 0.24f, 0.06f}, 0.7f);
}

StemSpec MakeStem(double height, double radius) {
  StemSpec stem;
  stem.height = height;
  stem.radius = radius;
  stem.material = StemMaterial();
  return stem;
}

BladeSpec MakeLeaf(double width) {
  BladeSpec leaf;
  leaf.sketches = {
      {{{0.72 * width, 0.2}, {width, 0.47}, {0.52 * width, 0.8}},
       SketchEnd::kRound,
       SketchEnd::kPointed},
      {{{0.8 * width, 0.2}, {0.95 * width, 0.44}, {0.48 * width, 0.79}},
       SketchEnd::kRound,
       SketchEnd::kPointed}};
  leaf.relief = {0.12, 3, 4, 1, false};
  leaf.open = {60, -10, -50, 0};
  leaf.material = LeafMaterial();
  leaf.colors.base = {1.2f / 1.3f, 1, 0.8f};
  leaf.colors.tip = {0.75f, 0.8f, 0.75f};
  return leaf;
}

LeafGroup MakeLeaves(int count, double width, double size) {
  LeafGroup leaves;
  leaves.count = count;
  leaves.blade = MakeLeaf(width);
  leaves.size = size;
  return leaves;
}

SolidGroup MakeReceptacle(double length, double radius, double height) {
  SolidGroup solid;
  solid.organ = FlowerOrgan::kReceptacle;
  solid.filament_length = 0;
  solid.filament_radius = 0;
  solid.head_length = length;
  solid.head_radius = radius;
  solid.sides = 16;
  solid.arrangement = {ArrangementKind::kWhorl, 137.5, 0};
  solid.arrangement.height = height;
  solid.material = StemMaterial();
  return solid;
}

PetalGroup MakeSepals(int count, double width, double size) {
  PetalGroup sepals;
  sepals.organ = FlowerOrgan::kSepal;
  sepals.count = count;
  sepals.blade.sketches = {{{{width, 0.25}, {0.6 * width, 0.6}},
                            SketchEnd::kRound,
                            SketchEnd::kPointed}};
  sepals.blade.relief = {0.05, 2, 2, 1, true};
  sepals.blade.closed = {140, 40, 20, 0};
  sepals.blade.open = {60, -30, -100, 0};
  sepals.blade.steps = 2;
  sepals.blade.columns = 8;
  sepals.blade.rows = 12;
  sepals.blade.material = LeafMaterial();
  sepals.arrangement.kind = ArrangementKind::kWhorl;
  sepals.arrangement.spacing = 0.05;
  sepals.inner_size = sepals.outer_size = size;
  sepals.angle_deg = 80;
  sepals.open_angle_deg = -20;
  return sepals;
}

SolidGroup MakeStamens(int count, double length, Tint filament, Tint head) {
  SolidGroup stamens;
  stamens.count = count;
  stamens.filament_length = length;
  stamens.filament_radius = 0.012;
  stamens.head_length = 0.1;
  stamens.head_radius = 0.025;
  stamens.material = MakeMaterial("stamen", {1, 1, 1});
  stamens.filament_tint = filament;
  stamens.head_tint = head;
  return stamens;
}

PetalGroup MakeRays(int count, int layers, double width, double radius,
                    Tint color) {
  PetalGroup rays;
  rays.count = count;
  rays.blade.sketches = {{{{width, 0.25}, {1.05 * width, 0.7}},
                          SketchEnd::kPointed,
                          SketchEnd::kRound},
                         {{{0.9 * width, 0.3}, {width, 0.62}},
                          SketchEnd::kPointed,
                          SketchEnd::kPointed}};
  rays.blade.relief = {0.12, 6, 2, 1, true};
  rays.blade.open = {120, -20, -30, 0};
  rays.blade.columns = 8;
  rays.blade.rows = 16;
  rays.blade.material = MakeMaterial("ray", color);
  rays.arrangement.kind = ArrangementKind::kWhorl;
  rays.arrangement.layers = layers;
  rays.arrangement.radius = radius;
  rays.arrangement.spacing = 0.02;
  rays.angle_deg = 95;
  rays.open_angle_deg = 12;
  return rays;
}

SolidGroup MakeDiscFlorets(int count, double spacing, double dome, Tint low,
                           Tint top) {
  SolidGroup florets;
  florets.organ = FlowerOrgan::kFloret;
  florets.count = count;
  florets.arrangement.spacing = spacing;
  florets.arrangement.dome = dome;
  florets.filament_length = 2.5 * spacing;
  florets.filament_radius = 0.6 * spacing;
  florets.head_length = 2 * spacing;
  florets.head_radius = 0.75 * spacing;
  florets.inner_size = 0.75;
  florets.sides = 6;
  florets.inner_angle_deg = 90;
  florets.outer_angle_deg = 70;
  florets.material = MakeMaterial("floret", {1, 1, 1});
  florets.filament_tint = low;
  florets.head_tint = top;
  return florets;
}

}  // namespace terrane::core
