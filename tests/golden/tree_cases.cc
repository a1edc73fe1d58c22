#include "tests/golden/tree_cases.h"

#include <sstream>
#include <utility>

namespace terrane::core {
namespace {

class TreeList {
 public:
  // A tree with RELATIVE lengths, changed.
  template <typename Change>
  void Add(std::string name, int dimensions, int depth, Change change) {
    TreeSpec spec;
    spec.dimensions = dimensions;
    spec.depth = depth;
    spec.length_mode = LengthMode::kRelative;
    // Every case a tree of its own.
    spec.seed = 1'000'003 * static_cast<std::int64_t>(trees_.size()) - 7;
    change(&spec);
    trees_.push_back({std::move(name), spec});
  }
  std::vector<GoldenTree> Take() { return std::move(trees_); }

 private:
  std::vector<GoldenTree> trees_;
};

void AddForms(TreeList* list) {
  list->Add("absolute_2d", 2, 7,
            [](TreeSpec* s) { s->length_mode = LengthMode::kAbsolute; });
  list->Add("absolute_3d", 3, 7,
            [](TreeSpec* s) { s->length_mode = LengthMode::kAbsolute; });
  list->Add("relative_2d", 2, 8, [](TreeSpec*) {});
  list->Add("relative_3d", 3, 10, [](TreeSpec*) {});
  list->Add("plain_sympodial", 2, 9,
            [](TreeSpec* s) { s->form = TreeForm::kPlain; });
  list->Add("plain_monopodial", 2, 9, [](TreeSpec* s) {
    s->form = TreeForm::kPlain;
    s->plain = {0.65, 35, 0.6};
  });
  list->Add("cantor_strict", 2, 8,
            [](TreeSpec* s) { s->form = TreeForm::kCantor; });
  list->Add("cantor_statistical", 2, 8, [](TreeSpec* s) {
    s->form = TreeForm::kCantor;
    s->cantor.statistical = true;
  });
}

void AddControls(TreeList* list) {
  list->Add("all_monopodial", 2, 7,
            [](TreeSpec* s) { s->genetic.monopodial_share = 1; });
  list->Add("all_sympodial", 2, 8,
            [](TreeSpec* s) { s->genetic.monopodial_share = 0; });
  list->Add("all_left", 2, 7, [](TreeSpec* s) { s->genetic.left_share = 1; });
  list->Add("dense", 2, 7,
            [](TreeSpec* s) { s->genetic.density = Wanted::kHigh; });
  list->Add("sparse", 2, 7,
            [](TreeSpec* s) { s->genetic.density = Wanted::kLow; });
  list->Add("features", 3, 7, [](TreeSpec* s) {
    s->genetic.lengths = Wanted::kHigh;
    s->genetic.angles = Wanted::kLow;
    s->genetic.counts = Wanted::kHigh;
    s->genetic.gaps = Wanted::kHigh;
  });
  list->Add("population_2", 3, 7, [](TreeSpec* s) {
    s->genetic.population = 2;
    s->genetic.leader = true;
  });
  list->Add("population_64", 3, 7,
            [](TreeSpec* s) { s->genetic.population = 64; });
  list->Add("rates", 2, 7, [](TreeSpec* s) {
    s->genetic.crossover_rate = 0.9;
    s->genetic.mutation_rate = 0.3;
  });
  list->Add("trunk", 3, 7, [](TreeSpec* s) { s->genetic.trunk = 0x13579BDF; });
  list->Add("twigs_end", 2, 9,
            [](TreeSpec* s) { s->genetic.twigs_end = true; });
}

void AddShapes(TreeList* list) {
  list->Add("conifer", 3, 6, [](TreeSpec* s) {
    s->genetic.monopodial_share = 1;
    s->genetic.leader = true;
    s->genetic.angle_min_deg = 60;
    s->genetic.angle_max_deg = 85;
    s->genetic.ratio_min = 0.3;
    s->genetic.ratio_max = 0.8;
    s->genetic.crown_taper = 0.5;
    s->genetic.azimuth_spread_deg = 45;
  });
  list->Add("bent", 3, 7, [](TreeSpec* s) { s->bending = {5, 1.2, 0.4}; });
  list->Add("bent_flat", 2, 7, [](TreeSpec* s) { s->bending = {3, 0, 2}; });
  list->Add("pipes_2.3", 3, 7, [](TreeSpec* s) {
    s->pipe_exponent = 2.3;
    s->trunk_radius = 40;
  });
  list->Add("cut", 3, 20, [](TreeSpec* s) { s->max_segments = 5000; });
  list->Add("leaves", 3, 6, [](TreeSpec* s) { s->leaves.emplace(); });
  list->Add("leaves_flat", 2, 6, [](TreeSpec* s) {
    s->leaves = LeafSpec{2, 0.8, 35, 0.5};
  });
  list->Add("ruled_by_axis", 3, 7, [](TreeSpec* s) {
    s->genetic.leader = true;
    s->genetic.lateral_share = 0.45;
    s->genetic.least_length = 8;
    s->bending = {3, 0.8, 0.2, 0.9};
  });
  list->Add("leaves_all_over", 3, 6, [](TreeSpec* s) {
    s->bending.pieces = 2;
    s->leaves =
        LeafSpec{.count = 2, .size = 9, .generations = 3, .every_piece = true};
  });
}

}  // namespace

std::string GoldenTree::Parameters() const {
  std::ostringstream text;
  text << spec.dimensions << "-D seed " << spec.seed << " depth " << spec.depth;
  if (spec.max_segments > 0) text << " of " << spec.max_segments << " rows";
  if (spec.bending.pieces > 1) text << " pieces " << spec.bending.pieces;
  if (spec.leaves.has_value()) text << " leaves " << spec.leaves->count;
  return text.str();
}

std::vector<GoldenTree> GoldenTrees() {
  TreeList list;
  AddForms(&list);
  AddControls(&list);
  AddShapes(&list);
  return list.Take();
}

}  // namespace terrane::core
