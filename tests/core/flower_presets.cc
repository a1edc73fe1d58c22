#include "tests/core/flower_presets.h"

#include <utility>

namespace terrane::core {
namespace {

Material MakeMaterial(const char* name, Tint color, float roughness = 0.8f) {
  Material material;
  material.name = name;
  material.base_color = color;
  material.roughness = roughness;
  material.double_sided = true;
  return material;
}

Material Green() { return MakeMaterial("leaf", {0.10f, 0.24f, 0.06f}, 0.7f); }
Material Stalk() { return MakeMaterial("stem", {0.14f, 0.28f, 0.07f}, 0.7f); }

StemSpec MakeStem(double height, double radius) {
  StemSpec stem;
  stem.height = height;
  stem.radius = radius;
  stem.material = Stalk();
  return stem;
}

// An oval leaf with a pointed tip.
BladeSpec MakeLeaf(double width) {
  BladeSpec leaf;
  leaf.sketches = {{{{0.9 * width, 0.3}, {0.85 * width, 0.62}},
                    SketchEnd::kRound,
                    SketchEnd::kPointed},
                   {{{width, 0.36}, {0.75 * width, 0.68}},
                    SketchEnd::kRound,
                    SketchEnd::kPointed}};
  leaf.relief = {0.12, 3, 4, 1, false};
  leaf.open = {60, -10, -50, 0};
  leaf.material = Green();
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
  solid.material = Stalk();
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
  sepals.blade.material = Green();
  sepals.arrangement.kind = ArrangementKind::kWhorl;
  sepals.arrangement.spacing = 0.05;
  sepals.inner_size = sepals.outer_size = size;
  sepals.angle_deg = 80;
  sepals.open_angle_deg = -20;
  return sepals;
}

FlowerSpec Rose() {
  FlowerSpec rose;
  PetalGroup petals;
  petals.count = 34;
  petals.blade.sketches = {
      {{{0.40, 0.24}, {0.55, 0.66}}, SketchEnd::kRound, SketchEnd::kRound},
      {{{0.37, 0.22}, {0.58, 0.70}}, SketchEnd::kRound, SketchEnd::kRound}};
  petals.blade.relief = {0.15, 4, 2, 1, true};
  petals.blade.closed = {260, 20, 40, 0};
  petals.blade.open = {70, 100, -110, 0.2};
  petals.blade.steps = 3;
  petals.blade.columns = 20;
  petals.blade.rows = 24;
  petals.blade.material = MakeMaterial("rose petal", {0.70f, 0.025f, 0.05f});
  petals.blade.colors.base = {0.7f, 0.4f, 0.4f};
  petals.arrangement.spacing = 0.10;
  petals.arrangement.dome = 0.45;
  petals.inner_size = 0.74;
  petals.outer_size = 1.1;
  petals.angle_deg = 90;
  petals.open_angle_deg = 5;
  petals.swirl_deg = 16;
  rose.petals = {petals, MakeSepals(5, 0.11, 0.8)};
  rose.solids = {MakeReceptacle(0.5, 0.2, -0.1)};
  rose.leaves = {MakeLeaves(6, 0.34, 1.1)};
  rose.leaves[0].leaflets = 5;
  rose.leaves[0].stalk = 1.3;
  rose.leaves[0].from = 0.2;
  rose.leaves[0].to = 0.75;
  rose.leaves[0].blade.sketches.resize(1);
  rose.leaves[0].blade.rows = 20;
  rose.leaves[0].blade.columns = 12;
  rose.stem = MakeStem(8, 0.11);
  rose.stem->variants = 1;
  rose.early = {30, 0.1, 0.6, 0.3};
  rose.full = {8, 0.7, 1, 0.6};
  return rose;
}

// A petal of the pansy's: a yellow eye, a dark face where it has one.
PetalGroup PansyPetal(int count, double width, Tint color, double blotch_to) {
  PetalGroup petal;
  petal.count = count;
  petal.blade.sketches = {{{{0.8 * width, 0.40}, {width, 0.74}},
                           SketchEnd::kPointed,
                           SketchEnd::kRound},
                          {{{0.76 * width, 0.38}, {width, 0.70}},
                           SketchEnd::kPointed,
                           SketchEnd::kRound}};
  petal.blade.relief = {0.10, 3, 1, 1, true};
  petal.blade.open = {15, 10, -30, 0.04};
  petal.blade.columns = 32;
  petal.blade.rows = 40;
  petal.blade.material = MakeMaterial("pansy petal", {1, 1, 1});
  petal.blade.colors.base = {0.95f, 0.62f, 0.03f};
  petal.blade.colors.tip = color;
  petal.blade.colors.middle = 0.14;
  if (blotch_to > 0) {
    petal.blade.colors.blotch = {{0.03f, 0.005f, 0.05f}, 0.2, blotch_to, 0.7};
  }
  petal.blade.colors.margin = {0.75f, 0.55f, 0.85f};
  petal.blade.colors.margin_width = 0.05;
  petal.arrangement.kind = ArrangementKind::kWhorl;
  petal.arrangement.spacing = 0.05;
  petal.angle_deg = 30;
  petal.open_angle_deg = 12;
  return petal;
}

FlowerSpec Pansy() {
  constexpr Tint kViolet = {0.22f, 0.05f, 0.42f};
  constexpr Tint kPale = {0.62f, 0.42f, 0.78f};
  FlowerSpec pansy;
  pansy.unit_m = 0.03;
  PetalGroup lower = PansyPetal(1, 0.66, kPale, 0.62);
  lower.arrangement.phase_deg = 270;
  lower.arrangement.height = 0.02;
  PetalGroup sides = PansyPetal(2, 0.52, kPale, 0.58);
  sides.arrangement.phase_deg = 192;
  sides.arrangement.arc_deg = 312;
  PetalGroup upper = PansyPetal(2, 0.58, kViolet, 0);
  upper.arrangement.phase_deg = 62;
  upper.arrangement.arc_deg = 112;
  upper.arrangement.height = -0.05;
  upper.open_angle_deg = 4;
  upper.swirl_deg = 7;
  pansy.petals = {lower, sides, upper, MakeSepals(5, 0.12, 0.4)};
  pansy.petals[3].arrangement.height = -0.16;
  pansy.petals[3].open_angle_deg = 0;
  SolidGroup eye;
  eye.organ = FlowerOrgan::kPistil;
  eye.filament_length = 0.06;
  eye.filament_radius = 0.03;
  eye.head_length = 0.09;
  eye.head_radius = 0.05;
  eye.arrangement.spacing = 0;
  eye.material = MakeMaterial("pistil", {0.55f, 0.65f, 0.15f});
  pansy.solids = {eye};
  pansy.leaves = {MakeLeaves(4, 0.36, 1.3)};
  pansy.leaves[0].from = 0.05;
  pansy.leaves[0].to = 0.4;
  pansy.stem = MakeStem(4, 0.06);
  pansy.stem->nod_deg = 68;
  return pansy;
}

SolidGroup Stamens(int count, double length, Tint filament, Tint head) {
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

FlowerSpec WaterLily() {
  FlowerSpec lily;
  lily.unit_m = 0.07;
  PetalGroup petals;
  petals.count = 28;
  petals.blade.sketches = {
      {{{0.15, 0.3}, {0.17, 0.62}}, SketchEnd::kPointed, SketchEnd::kPointed},
      {{{0.16, 0.34}, {0.16, 0.66}}, SketchEnd::kPointed, SketchEnd::kPointed}};
  petals.blade.relief = {0.05, 2, 1, 1, true};
  petals.blade.closed = {200, 30, 30, 0};
  petals.blade.open = {130, 70, 10, 0};
  petals.blade.steps = 3;
  petals.blade.columns = 12;
  petals.blade.material =
      MakeMaterial("water lily petal", {0.95f, 0.80f, 0.86f});
  petals.blade.colors.base = {1, 0.62f, 0.75f};
  petals.arrangement.spacing = 0.06;
  petals.inner_size = 0.72;
  petals.outer_size = 1.15;
  petals.angle_deg = 78;
  petals.open_angle_deg = -8;
  PetalGroup pads;
  pads.organ = FlowerOrgan::kLeaf;
  pads.count = 3;
  pads.blade = MakeLeaf(0.4);
  pads.blade.sketches = {
      {{{0.46, 0.16}, {0.50, 0.62}}, SketchEnd::kRound, SketchEnd::kRound}};
  pads.blade.relief = {0.05, 2, 2, 1, false};
  pads.blade.open = {0, 0, 0, -0.03};
  pads.arrangement.kind = ArrangementKind::kWhorl;
  pads.arrangement.spacing = 0.4;
  pads.arrangement.height = -0.22;
  pads.arrangement.phase_deg = 20;
  pads.inner_size = pads.outer_size = 2.6;
  pads.angle_deg = pads.open_angle_deg = 0;
  lily.petals = {petals, pads};
  SolidGroup stamens =
      Stamens(60, 0.3, {0.95f, 0.65f, 0.05f}, {0.95f, 0.5f, 0.02f});
  stamens.arrangement.spacing = 0.028;
  stamens.inner_angle_deg = 95;
  stamens.outer_angle_deg = 62;
  lily.solids = {stamens, MakeReceptacle(0.2, 0.32, -0.1)};
  lily.early = {26, 0.1, 0.7, 0.4};
  return lily;
}

PetalGroup Rays(int count, int layers, double width, double radius,
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

SolidGroup DiscFlorets(int count, double spacing, double dome, Tint low,
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

FlowerSpec Sunflower() {
  FlowerSpec sunflower;
  sunflower.unit_m = 0.09;
  PetalGroup rays = Rays(40, 2, 0.15, 0.86, {0.95f, 0.52f, 0.01f});
  rays.blade.colors.base = {0.9f, 0.55f, 0.5f};
  sunflower.petals = {rays, MakeSepals(24, 0.12, 0.7)};
  sunflower.petals[1].arrangement.radius = 0.8;
  sunflower.petals[1].arrangement.height = -0.12;
  sunflower.petals[1].open_angle_deg = 0;
  SolidGroup back = MakeReceptacle(0.2, 0.95, -0.12);
  sunflower.solids = {DiscFlorets(1000, 0.03, 0.06, {0.10f, 0.04f, 0.01f},
                                  {0.26f, 0.11f, 0.02f}),
                      back};
  sunflower.leaves = {MakeLeaves(7, 0.42, 2.2)};
  sunflower.leaves[0].stalk = 0.35;
  sunflower.stem = MakeStem(14, 0.2);
  sunflower.stem->nod_deg = 62;
  sunflower.early = {0, 0, 0.6, 0.8};
  return sunflower;
}

FlowerSpec Daisy() {
  FlowerSpec daisy;
  daisy.unit_m = 0.025;
  daisy.petals = {Rays(34, 2, 0.10, 0.34, {0.93f, 0.93f, 0.90f}),
                  MakeSepals(13, 0.1, 0.42)};
  daisy.petals[0].open_angle_deg = 5;
  daisy.petals[1].arrangement.radius = 0.2;
  daisy.petals[1].arrangement.height = -0.08;
  daisy.petals[1].open_angle_deg = 5;
  daisy.solids = {DiscFlorets(180, 0.03, 0.16, {0.75f, 0.45f, 0.02f},
                              {0.95f, 0.62f, 0.02f}),
                  MakeReceptacle(0.2, 0.38, -0.02)};
  daisy.leaves = {MakeLeaves(5, 0.18, 1.4)};
  daisy.leaves[0].to = 0.5;
  daisy.stem = MakeStem(7, 0.06);
  daisy.stem->nod_deg = 30;
  return daisy;
}

FlowerSpec Tulip() {
  FlowerSpec tulip;
  tulip.unit_m = 0.06;
  PetalGroup petals;
  petals.count = 6;
  petals.blade.sketches = {
      {{{0.40, 0.30}, {0.40, 0.66}}, SketchEnd::kRound, SketchEnd::kPointed},
      {{{0.42, 0.34}, {0.38, 0.70}}, SketchEnd::kRound, SketchEnd::kPointed}};
  petals.blade.relief = {0.06, 2, 1, 1, true};
  petals.blade.closed = {190, 90, 20, 0};
  petals.blade.open = {160, 130, -70, 0};
  petals.blade.steps = 3;
  petals.blade.columns = 20;
  petals.blade.rows = 32;
  petals.blade.material =
      MakeMaterial("tulip petal", {0.85f, 0.09f, 0.03f}, 0.6f);
  petals.blade.colors.base = {1, 1, 0.4f};
  petals.blade.colors.tip = {1, 0.8f, 0.8f};
  petals.blade.colors.margin = {1, 1, 1};
  petals.arrangement.kind = ArrangementKind::kWhorl;
  petals.arrangement.layers = 2;
  petals.arrangement.spacing = 0.06;
  petals.angle_deg = 52;
  petals.open_angle_deg = 28;
  petals.swirl_deg = 6;
  tulip.petals = {petals};
  SolidGroup stamens =
      Stamens(6, 0.3, {0.5f, 0.6f, 0.2f}, {0.02f, 0.01f, 0.02f});
  stamens.arrangement.kind = ArrangementKind::kWhorl;
  stamens.inner_angle_deg = stamens.outer_angle_deg = 78;
  SolidGroup pistil = Stamens(1, 0.34, {0.5f, 0.6f, 0.2f}, {0.7f, 0.6f, 0.2f});
  pistil.organ = FlowerOrgan::kPistil;
  pistil.filament_radius = 0.06;
  pistil.head_radius = 0.09;
  pistil.arrangement.spacing = 0;
  tulip.solids = {stamens, pistil};
  tulip.leaves = {MakeLeaves(3, 0.13, 4.2)};
  tulip.leaves[0].blade.open = {260, 10, -30, 0};
  tulip.leaves[0].from = 0.02;
  tulip.leaves[0].to = 0.12;
  tulip.leaves[0].angle_deg = 68;
  tulip.leaves[0].stalk = 0;
  tulip.stem = MakeStem(6, 0.09);
  return tulip;
}

FlowerSpec Lily() {
  FlowerSpec lily;
  lily.unit_m = 0.11;
  PetalGroup petals;
  petals.count = 6;
  petals.blade.sketches = {
      {{{0.13, 0.24}, {0.19, 0.58}}, SketchEnd::kPointed, SketchEnd::kPointed},
      {{{0.14, 0.26}, {0.21, 0.60}}, SketchEnd::kPointed, SketchEnd::kPointed}};
  petals.blade.relief = {0.10, 5, 3, 1, true};
  petals.blade.closed = {220, 10, -20, 0};
  petals.blade.open = {70, 40, -170, 0};
  petals.blade.steps = 3;
  petals.blade.columns = 16;
  petals.blade.rows = 36;
  petals.blade.material =
      MakeMaterial("lily petal", {0.95f, 0.92f, 0.92f}, 0.6f);
  petals.blade.colors.base = {0.75f, 0.85f, 0.35f};
  petals.blade.colors.tip = {0.92f, 0.42f, 0.58f};
  petals.blade.colors.middle = 0.25;
  petals.blade.colors.margin = {1, 0.92f, 0.94f};
  petals.blade.colors.margin_width = 0.07;
  petals.arrangement.kind = ArrangementKind::kWhorl;
  petals.arrangement.layers = 2;
  petals.arrangement.spacing = 0.02;
  petals.angle_deg = 82;
  petals.open_angle_deg = 48;
  lily.petals = {petals};
  SolidGroup stamens =
      Stamens(6, 0.72, {0.7f, 0.8f, 0.4f}, {0.45f, 0.13f, 0.02f});
  stamens.arrangement.kind = ArrangementKind::kWhorl;
  stamens.arrangement.spacing = 0.03;
  stamens.inner_angle_deg = stamens.outer_angle_deg = 76;
  SolidGroup pistil = Stamens(1, 0.82, {0.7f, 0.8f, 0.4f}, {0.4f, 0.35f, 0.1f});
  pistil.organ = FlowerOrgan::kPistil;
  pistil.filament_radius = 0.02;
  pistil.head_radius = 0.03;
  pistil.arrangement.spacing = 0;
  lily.solids = {stamens, pistil};
  lily.leaves = {MakeLeaves(24, 0.10, 1.1)};
  lily.leaves[0].stalk = 0;
  lily.leaves[0].from = 0.1;
  lily.leaves[0].to = 0.85;
  lily.leaves[0].angle_deg = 30;
  lily.stem = MakeStem(7, 0.05);
  lily.stem->nod_deg = 50;
  return lily;
}

FlowerSpec Chrysanthemum() {
  FlowerSpec mum;
  mum.unit_m = 0.045;
  PetalGroup petals;
  petals.count = 220;
  petals.blade.sketches = {
      {{{0.07, 0.3}, {0.10, 0.72}}, SketchEnd::kPointed, SketchEnd::kRound},
      {{{0.06, 0.3}, {0.09, 0.66}}, SketchEnd::kPointed, SketchEnd::kRound}};
  petals.blade.relief = {0.04, 6, 2, 1, true};
  petals.blade.closed = {500, 30, 120, 0};
  petals.blade.open = {420, 10, 90, 0};
  petals.blade.steps = 4;
  petals.blade.columns = 8;
  petals.blade.rows = 14;
  petals.blade.material =
      MakeMaterial("chrysanthemum petal", {0.92f, 0.55f, 0.03f});
  petals.blade.colors.base = {0.75f, 0.45f, 0.5f};
  petals.arrangement.spacing = 0.03;
  petals.arrangement.dome = 0.35;
  petals.inner_size = 0.5;
  petals.outer_size = 1.05;
  petals.angle_deg = 92;
  petals.open_angle_deg = -14;
  mum.petals = {petals, MakeSepals(16, 0.1, 0.6)};
  mum.petals[1].arrangement.height = -0.05;
  mum.petals[1].arrangement.radius = 0.2;
  mum.solids = {MakeReceptacle(0.3, 0.4, -0.05)};
  mum.leaves = {MakeLeaves(8, 0.34, 1.2)};
  mum.stem = MakeStem(7, 0.09);
  mum.early = {180, 0.2, 0.6, 0.6};
  return mum;
}

// One leaf or petal (the paper's figures 4 and 5), lying flat.
FlowerSpec Single(PetalGroup blade) {
  FlowerSpec spec;
  blade.count = 1;
  blade.arrangement.kind = ArrangementKind::kWhorl;
  blade.arrangement.spacing = 0;
  blade.arrangement.phase_deg = 90;
  blade.angle_deg = blade.open_angle_deg = 0;
  blade.blade.sketches.resize(1);
  blade.blade.steps = 1;
  blade.blade.columns = 32;
  blade.blade.rows = 48;
  spec.petals = {std::move(blade)};
  spec.variation = 0;
  return spec;
}

FlowerSpec Leaf() {
  PetalGroup leaf;
  leaf.organ = FlowerOrgan::kLeaf;
  leaf.blade = MakeLeaf(0.3);
  return Single(leaf);
}

FlowerSpec Petal() {
  PetalGroup petal = Rose().petals[0];
  petal.blade.open = {40, 20, -40, 0.1};
  return Single(petal);
}

}  // namespace

std::vector<std::string> FlowerPresetNames() {
  return {"rose",  "pansy", "water-lily",    "sunflower", "daisy",
          "tulip", "lily",  "chrysanthemum", "leaf",      "petal"};
}

FlowerSpec FlowerPreset(const std::string& name) {
  if (name == "rose") return Rose();
  if (name == "pansy") return Pansy();
  if (name == "water-lily") return WaterLily();
  if (name == "sunflower") return Sunflower();
  if (name == "daisy") return Daisy();
  if (name == "tulip") return Tulip();
  if (name == "lily") return Lily();
  if (name == "chrysanthemum") return Chrysanthemum();
  if (name == "leaf") return Leaf();
  return Petal();
}

}  // namespace terrane::core
