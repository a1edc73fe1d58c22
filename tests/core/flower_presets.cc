#include "tests/core/flower_presets.h"

#include <utility>

#include "tests/core/flower_parts.h"

namespace terrane::core {
namespace {

struct Preset {
  const char* name;
  FlowerSpec (*make)();
};

constexpr Preset kPresets[] = {{"rose", &Rose},
                               {"pansy", &Pansy},
                               {"water-lily", &WaterLily},
                               {"sunflower", &Sunflower},
                               {"daisy", &Daisy},
                               {"tulip", &Tulip},
                               {"lily", &Lily},
                               {"chrysanthemum", &Chrysanthemum},
                               {"leaf", &Leaf},
                               {"petal", &Petal}};

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

// One blade.
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

}  // namespace

FlowerSpec Rose() {
  FlowerSpec rose;
  PetalGroup petals;
  petals.count = 34;
  petals.blade.sketches = {
      {{{0.40, 0.24}, {0.55, 0.66}}, SketchEnd::kRound, SketchEnd::kRound},
      {{{0.37, 0.22}, {0.58, 0.70}}, SketchEnd::kRound, SketchEnd::kRound}};
  petals.blade.relief = {0.15, 4, 2, 1, true};
  petals.blade.closed = {230, 25, 70, 0, 0.2};
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
  rose.petals = {petals, MakeSepals(5, 0.13, 0.75)};
  rose.petals[1].arrangement.radius = 0.38;
  rose.petals[1].arrangement.height = -0.1;
  rose.petals[1].angle_deg = 74;
  rose.petals[1].open_angle_deg = -60;
  rose.solids = {MakeReceptacle(0.46, 0.18, -0.12)};
  rose.leaves = {MakeLeaves(6, 0.34, 1.1)};
  rose.leaves[0].leaflets = 5;
  rose.leaves[0].stalk = 1.3;
  rose.leaves[0].from = 0.2;
  rose.leaves[0].to = 0.75;
  rose.leaves[0].blade.sketches.resize(1);
  rose.leaves[0].blade.rows = 20;
  rose.leaves[0].blade.columns = 12;
  rose.stem = MakeStem(8, 0.09);
  rose.stem->variants = 1;
  rose.early = {32, 0.1, 0.6, 0.35};
  rose.full = {8, 0.7, 1, 0.6};
  return rose;
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
      MakeStamens(60, 0.3, {0.95f, 0.65f, 0.05f}, {0.95f, 0.5f, 0.02f});
  stamens.arrangement.spacing = 0.028;
  stamens.inner_angle_deg = 95;
  stamens.outer_angle_deg = 62;
  lily.solids = {stamens, MakeReceptacle(0.2, 0.32, -0.1)};
  lily.early = {26, 0.1, 0.7, 0.4};
  return lily;
}

FlowerSpec Sunflower() {
  FlowerSpec sunflower;
  sunflower.unit_m = 0.09;
  PetalGroup rays = MakeRays(40, 2, 0.15, 0.86, {0.95f, 0.52f, 0.01f});
  rays.blade.colors.base = {0.9f, 0.55f, 0.5f};
  sunflower.petals = {rays, MakeSepals(24, 0.12, 0.7)};
  sunflower.petals[1].arrangement.radius = 0.8;
  sunflower.petals[1].arrangement.height = -0.12;
  sunflower.petals[1].open_angle_deg = 0;
  SolidGroup disc = MakeReceptacle(0.1, 0.93, -0.01);
  disc.material = MakeMaterial("disc", {0.10f, 0.045f, 0.012f});
  sunflower.solids = {MakeDiscFlorets(1000, 0.03, 0.06, {0.10f, 0.04f, 0.01f},
                                      {0.26f, 0.11f, 0.02f}),
                      disc, MakeReceptacle(0.26, 0.9, -0.15)};
  sunflower.leaves = {MakeLeaves(7, 0.42, 2.2)};
  sunflower.leaves[0].stalk = 0.35;
  sunflower.stem = MakeStem(14, 0.2);
  sunflower.stem->nod_deg = 62;
  sunflower.early = {0, 0, 0.6, 0.8};
  return sunflower;
}

FlowerSpec Leaf() {
  PetalGroup leaf;
  leaf.organ = FlowerOrgan::kLeaf;
  leaf.blade = MakeLeaf(0.3);
  leaf.blade.open = {20, -5, -15, 0};
  return Single(leaf);
}

FlowerSpec Petal() {
  PetalGroup petal = Rose().petals[0];
  petal.blade.open = {40, 20, -40, 0.1};
  return Single(petal);
}

std::vector<std::string> FlowerPresetNames() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

FlowerSpec FlowerPreset(const std::string& name) {
  for (const Preset& preset : kPresets) {
    if (name == preset.name) return preset.make();
  }
  return {};
}

}  // namespace terrane::core
