#include "server/convert/tree_convert.h"

#include <optional>

#include "core/base/column_bytes.h"
#include "core/base/field_checks.h"
#include "core/tree/estimate.h"
#include "server/convert/column_checksum.h"
#include "server/convert/enum_table.h"
#include "server/convert/non_zero.h"

namespace terrane::server {
namespace {

using core::Path;

constexpr EnumTable<v1::TreeForm, core::TreeForm, 3> kForms{{
    {v1::TREE_FORM_GENETIC, core::TreeForm::kGenetic},
    {v1::TREE_FORM_PLAIN, core::TreeForm::kPlain},
    {v1::TREE_FORM_CANTOR, core::TreeForm::kCantor},
}};

constexpr EnumTable<v1::LengthMode, core::LengthMode, 2> kLengthModes{{
    {v1::LENGTH_MODE_ABSOLUTE, core::LengthMode::kAbsolute},
    {v1::LENGTH_MODE_RELATIVE, core::LengthMode::kRelative},
}};

constexpr EnumTable<v1::Wanted, core::Wanted, 3> kWanted{{
    {v1::WANTED_ANY, core::Wanted::kAny},
    {v1::WANTED_LOW, core::Wanted::kLow},
    {v1::WANTED_HIGH, core::Wanted::kHigh},
}};

constexpr EnumTable<v1::TubeEnds, core::TubeEnds, 3> kTubeEnds{{
    {v1::TUBE_ENDS_JOINED, core::TubeEnds::kJoined},
    {v1::TUBE_ENDS_OPEN, core::TubeEnds::kOpen},
    {v1::TUBE_ENDS_CLOSED, core::TubeEnds::kClosed},
}};

std::optional<core::Wanted> ReadFeature(v1::Wanted value, const Path& path,
                                        core::Violations* violations) {
  const core::Wanted wanted = ReadEnum(kWanted, value, path, violations);
  if (value == v1::WANTED_UNSPECIFIED) return std::nullopt;
  return wanted;
}

core::GeneticSpec ReadGenetic(const v1::GeneticGrowth& genetic,
                              const Path& path, core::Violations* violations) {
  core::GeneticSpec spec;
  if (genetic.has_trunk()) spec.trunk = genetic.trunk();
  if (genetic.has_monopodial_share()) {
    spec.monopodial_share = genetic.monopodial_share();
  }
  if (genetic.has_left_share()) spec.left_share = genetic.left_share();
  spec.density =
      ReadEnum(kWanted, genetic.density(), path.Field("density"), violations);
  spec.lengths =
      ReadFeature(genetic.lengths(), path.Field("lengths"), violations);
  spec.angles = ReadFeature(genetic.angles(), path.Field("angles"), violations);
  spec.counts = ReadFeature(genetic.counts(), path.Field("counts"), violations);
  spec.gaps = ReadFeature(genetic.gaps(), path.Field("gaps"), violations);
  ReadNonZero(genetic.population(), &spec.population);
  if (genetic.has_crossover_rate()) {
    spec.crossover_rate = genetic.crossover_rate();
  }
  if (genetic.has_mutation_rate()) spec.mutation_rate = genetic.mutation_rate();
  spec.twigs_end = genetic.twigs_end();
  ReadNonZero(genetic.angle_min_deg(), &spec.angle_min_deg);
  ReadNonZero(genetic.angle_max_deg(), &spec.angle_max_deg);
  ReadNonZero(genetic.ratio_min(), &spec.ratio_min);
  ReadNonZero(genetic.ratio_max(), &spec.ratio_max);
  spec.crown_taper = genetic.crown_taper();
  spec.leader = genetic.leader();
  if (genetic.has_azimuth_spread_deg()) {
    spec.azimuth_spread_deg = genetic.azimuth_spread_deg();
  }
  ReadNonZero(genetic.lateral_share(), &spec.lateral_share);
  spec.least_length = genetic.least_length();
  return spec;
}

core::PlainSpec ReadPlain(const v1::PlainGrowth& plain) {
  core::PlainSpec spec;
  ReadNonZero(plain.contraction(), &spec.contraction);
  if (plain.has_angle_deg()) spec.angle_deg = plain.angle_deg();
  ReadNonZero(plain.offset(), &spec.offset);
  return spec;
}

core::LeafSpec ReadLeaves(const v1::TreeLeaves& leaves) {
  core::LeafSpec spec;
  ReadNonZero(leaves.count(), &spec.count);
  ReadNonZero(leaves.size_share(), &spec.size_share);
  if (leaves.has_angle_deg()) spec.angle_deg = leaves.angle_deg();
  if (leaves.has_size_variation()) {
    spec.size_variation = leaves.size_variation();
  }
  spec.size = leaves.size();
  ReadNonZero(leaves.generations(), &spec.generations);
  spec.every_piece = leaves.every_piece();
  return spec;
}

void WriteGenetic(const core::TreeSpec& tree, v1::GeneticGrowth* genetic) {
  const core::GeneticSpec& spec = tree.genetic;
  const auto feature = [&spec](const std::optional<core::Wanted>& wanted) {
    return WriteEnum(kWanted, wanted.value_or(spec.density));
  };
  genetic->set_trunk(core::TrunkChromosome(tree));
  genetic->set_monopodial_share(spec.monopodial_share);
  genetic->set_left_share(spec.left_share);
  genetic->set_density(WriteEnum(kWanted, spec.density));
  genetic->set_lengths(feature(spec.lengths));
  genetic->set_angles(feature(spec.angles));
  genetic->set_counts(feature(spec.counts));
  genetic->set_gaps(feature(spec.gaps));
  genetic->set_population(spec.population);
  genetic->set_crossover_rate(spec.crossover_rate);
  genetic->set_mutation_rate(spec.mutation_rate);
  genetic->set_twigs_end(spec.twigs_end);
  genetic->set_angle_min_deg(spec.angle_min_deg);
  genetic->set_angle_max_deg(spec.angle_max_deg);
  genetic->set_ratio_min(spec.ratio_min);
  genetic->set_ratio_max(spec.ratio_max);
  genetic->set_crown_taper(spec.crown_taper);
  genetic->set_leader(spec.leader);
  genetic->set_azimuth_spread_deg(spec.azimuth_spread_deg);
  genetic->set_lateral_share(spec.lateral_share);
  genetic->set_least_length(spec.least_length);
}

void WriteForm(const core::TreeSpec& spec, v1::TreeRecipe* recipe) {
  switch (spec.form) {
    case core::TreeForm::kGenetic:
      WriteGenetic(spec, recipe->mutable_genetic());
      return;
    case core::TreeForm::kPlain:
      recipe->mutable_plain()->set_contraction(spec.plain.contraction);
      recipe->mutable_plain()->set_angle_deg(spec.plain.angle_deg);
      recipe->mutable_plain()->set_offset(spec.plain.offset);
      return;
    case core::TreeForm::kCantor:
      recipe->mutable_cantor()->set_statistical(spec.cantor.statistical);
      if (spec.cantor.statistical) {
        WriteGenetic(spec, recipe->mutable_genetic());
      }
      return;
  }
}

}  // namespace

core::TreeSpec ReadTreeRecipe(const v1::TreeRecipe& recipe,
                              const core::TreeLimits& limits,
                              const std::string& prefix,
                              core::Violations* violations) {
  const Path root(&prefix);
  core::TreeSpec spec;
  spec.form = ReadEnum(kForms, recipe.form(), root.Field("form"), violations);
  ReadNonZero(recipe.dimensions(), &spec.dimensions);
  spec.seed = recipe.seed();
  if (recipe.has_depth()) spec.depth = recipe.depth();
  spec.max_segments = recipe.max_segments();
  spec.length_mode = ReadEnum(kLengthModes, recipe.length_mode(),
                              root.Field("length_mode"), violations);
  ReadNonZero(recipe.trunk_length(), &spec.trunk_length);
  if (recipe.trunk_radius() != 0) spec.trunk_radius = recipe.trunk_radius();
  ReadNonZero(recipe.pipe_exponent(), &spec.pipe_exponent);
  spec.genetic =
      ReadGenetic(recipe.genetic(), root.Field("genetic"), violations);
  spec.plain = ReadPlain(recipe.plain());
  spec.cantor.statistical = recipe.cantor().statistical();
  ReadNonZero(recipe.bending().pieces(), &spec.bending.pieces);
  spec.bending.gravity = recipe.bending().gravity();
  spec.bending.light = recipe.bending().light();
  spec.bending.stiffness = recipe.bending().stiffness();
  if (recipe.has_leaves()) spec.leaves = ReadLeaves(recipe.leaves());
  core::ValidateTreeSpec(spec, limits, prefix, violations);
  return spec;
}

v1::TreeRecipe WriteTreeRecipe(const core::TreeSpec& spec) {
  v1::TreeRecipe recipe;
  recipe.set_form(WriteEnum(kForms, spec.form));
  recipe.set_dimensions(spec.dimensions);
  recipe.set_seed(spec.seed);
  recipe.set_depth(spec.depth);
  recipe.set_max_segments(spec.max_segments);
  recipe.set_length_mode(WriteEnum(kLengthModes, spec.length_mode));
  recipe.set_trunk_length(spec.trunk_length);
  recipe.set_trunk_radius(spec.trunk_radius.value_or(0));
  recipe.set_pipe_exponent(spec.pipe_exponent);
  WriteForm(spec, &recipe);
  recipe.mutable_bending()->set_pieces(spec.bending.pieces);
  recipe.mutable_bending()->set_gravity(spec.bending.gravity);
  recipe.mutable_bending()->set_light(spec.bending.light);
  recipe.mutable_bending()->set_stiffness(spec.bending.stiffness);
  if (spec.leaves.has_value()) {
    recipe.mutable_leaves()->set_count(spec.leaves->count);
    recipe.mutable_leaves()->set_size_share(spec.leaves->size_share);
    recipe.mutable_leaves()->set_angle_deg(spec.leaves->angle_deg);
    recipe.mutable_leaves()->set_size_variation(spec.leaves->size_variation);
    recipe.mutable_leaves()->set_size(spec.leaves->size);
    recipe.mutable_leaves()->set_generations(spec.leaves->generations);
    recipe.mutable_leaves()->set_every_piece(spec.leaves->every_piece);
  }
  return recipe;
}

core::TubeSpec ReadTubeOptions(const v1::TubeOptions& options,
                               const std::string& prefix,
                               core::Violations* violations) {
  core::TubeSpec spec;
  const Path root(&prefix);
  ReadNonZero(options.sides(), &spec.sides);
  ReadNonZero(options.least_sides(), &spec.least_sides);
  if (options.has_last_generation()) {
    spec.last_generation = options.last_generation();
  }
  spec.ends =
      ReadEnum(kTubeEnds, options.ends(), root.Field("ends"), violations);
  ReadNonZero(options.texture_length(), &spec.texture_length);
  ReadNonZero(options.texture_repeats(), &spec.texture_repeats);
  core::ValidateTubeSpec(spec, prefix, violations);
  return spec;
}

void WriteSegments(const core::SegmentBlock& block, v1::SegmentRows* rows) {
  rows->set_first_row(block.first_row);
  rows->set_first_generation(block.first_generation);
  rows->set_rows(static_cast<int>(block.rows()));
  core::WriteColumn(block.parent, rows->mutable_parents());
  core::WriteColumn(block.start, rows->mutable_starts());
  core::WriteColumn(block.end, rows->mutable_ends());
  core::WriteColumn(block.radius_start, rows->mutable_radius_starts());
  core::WriteColumn(block.radius_end, rows->mutable_radius_ends());
  core::WriteColumn(block.flags, rows->mutable_flags());
  core::WriteColumn(block.attach, rows->mutable_attaches());
  core::WriteColumn(block.chromosome, rows->mutable_chromosomes());
  core::WriteColumn(block.extension, rows->mutable_extensions());
  rows->clear_marks();
  for (const core::GenerationMark& mark : block.marks) {
    v1::GenerationMark* const written = rows->add_marks();
    written->set_generation(mark.generation);
    written->set_end_row(mark.end_row);
  }
  rows->set_checksum(ColumnChecksum(
      {&rows->parents(), &rows->starts(), &rows->ends(), &rows->radius_starts(),
       &rows->radius_ends(), &rows->flags(), &rows->attaches(),
       &rows->chromosomes(), &rows->extensions()}));
}

void WriteTubes(const core::Mesh& mesh, std::int64_t index,
                v1::TubeBlock* block) {
  block->set_index(index);
  block->set_vertices(static_cast<int>(mesh.positions.size()));
  core::WriteColumn(mesh.positions, block->mutable_positions());
  core::WriteColumn(mesh.normals, block->mutable_normals());
  core::WriteColumn(mesh.uvs, block->mutable_uvs());
  core::WriteColumn(mesh.indices, block->mutable_indices());
  block->set_checksum(ColumnChecksum({&block->positions(), &block->normals(),
                                      &block->uvs(), &block->indices()}));
}

void WriteLeaves(const core::LeafBlock& block, std::int64_t first_leaf,
                 v1::LeafRows* rows) {
  rows->set_first_leaf(first_leaf);
  rows->set_leaves(static_cast<int>(block.count()));
  core::WriteColumn(block.row, rows->mutable_rows());
  core::WriteColumn(block.position, rows->mutable_positions());
  core::WriteColumn(block.direction, rows->mutable_directions());
  core::WriteColumn(block.normal, rows->mutable_normals());
  core::WriteColumn(block.size, rows->mutable_sizes());
  rows->set_checksum(
      ColumnChecksum({&rows->rows(), &rows->positions(), &rows->directions(),
                      &rows->normals(), &rows->sizes()}));
}

}  // namespace terrane::server
