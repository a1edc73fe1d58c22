#include "tests/core/flower_parts.h"
#include "tests/core/flower_presets.h"

namespace terrane::core {

FlowerSpec Daisy() {
  FlowerSpec daisy;
  daisy.unit_m = 0.025;
  daisy.petals = {MakeRays(34, 2, 0.10, 0.34, {0.93f, 0.93f, 0.90f}),
                  MakeSepals(13, 0.1, 0.42)};
  daisy.petals[0].open_angle_deg = 5;
  daisy.petals[1].arrangement.radius = 0.2;
  daisy.petals[1].arrangement.height = -0.08;
  daisy.petals[1].open_angle_deg = 5;
  SolidGroup disc = MakeReceptacle(0.2, 0.36, 0.02);
  disc.material = MakeMaterial("disc", {0.70f, 0.42f, 0.02f});
  daisy.solids = {MakeDiscFlorets(180, 0.03, 0.16, {0.75f, 0.45f, 0.02f},
                                  {0.95f, 0.62f, 0.02f}),
                  disc, MakeReceptacle(0.2, 0.34, -0.06)};
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
      MakeStamens(6, 0.3, {0.5f, 0.6f, 0.2f}, {0.02f, 0.01f, 0.02f});
  stamens.arrangement.kind = ArrangementKind::kWhorl;
  stamens.inner_angle_deg = stamens.outer_angle_deg = 78;
  SolidGroup pistil =
      MakeStamens(1, 0.34, {0.5f, 0.6f, 0.2f}, {0.7f, 0.6f, 0.2f});
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
      MakeStamens(6, 0.72, {0.7f, 0.8f, 0.4f}, {0.45f, 0.13f, 0.02f});
  stamens.arrangement.kind = ArrangementKind::kWhorl;
  stamens.arrangement.spacing = 0.03;
  stamens.inner_angle_deg = stamens.outer_angle_deg = 76;
  SolidGroup pistil =
      MakeStamens(1, 0.82, {0.7f, 0.8f, 0.4f}, {0.4f, 0.35f, 0.1f});
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

}  // namespace terrane::core
