// `terrane tree`: trees and forests into files.
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <utility>

#include "client/commands/command.h"
#include "client/commands/shared_options.h"
#include "client/commands/tree_files.h"
#include "client/exit_code.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane tree --preset tree/oak --seed 3 --out oak.glb
  terrane tree --preset tree/genetic --out tree.svg
  terrane tree --preset tree/birch --lod 0,1,2 --instancing nodes --out birch.glb
  terrane tree --preset tree/oak --depth 6 --foliage flower/leaf-wavy --out o.glb
  terrane tree --preset tree/spruce --forest --count 20 --first-seed 1 --out wood.csv
--out by extension: .svg .png (pictures), .glb .obj (meshes), .swc .csv (rows of
segments). Exit codes: as terrain.)";

const std::map<std::string, v1::TubeEnds> kEnds = {
    {"open", v1::TUBE_ENDS_OPEN},
    {"joined", v1::TUBE_ENDS_JOINED},
    {"closed", v1::TUBE_ENDS_CLOSED}};

const std::map<std::string, core::GltfInstancing> kInstancings = {
    {"extension", core::GltfInstancing::kExtension},
    {"nodes", core::GltfInstancing::kNodes}};

const std::map<std::string, ProgressMode> kProgressModes = {
    {"auto", ProgressMode::kAuto},
    {"none", ProgressMode::kNone},
    {"json", ProgressMode::kJson}};

struct TreeCommand {
  ConnectionOptions connection;
  TreeOptions tree;
  ForestOptions forest;
  bool is_forest = false;
  TreeFileOptions files;
  std::string foliage;  // preset
  int sides = 0;
  v1::TubeEnds ends = v1::TUBE_ENDS_UNSPECIFIED;
  bool json = false;
  bool dry_run = false;
};

int PrintEstimate(const TreeCommand& command, const ChosenTree& tree,
                  TreeBackend* backend, std::stop_token stop) {
  v1::EstimateTreeRequest ask;
  *ask.mutable_tree()->mutable_recipe() = tree.recipe;
  const absl::StatusOr<v1::EstimateTreeResponse> estimate =
      backend->EstimateTree(ask, std::move(stop));
  if (!estimate.ok()) return ReportStatus(estimate.status());
  if (command.json) {
    std::cout << JsonLine(*estimate) << '\n';
    return kExitOk;
  }
  std::cout << fmt::format(
      "{}at most {} segments in {} generations and {} leaves, {} bytes\n"
      "about {:.3g} s of one core, {} bytes of memory\n",
      command.is_forest ? "each tree: " : "", estimate->segments_most(),
      estimate->last_generation() + 1, estimate->leaves_most(),
      estimate->data_bytes_most(), estimate->cpu_seconds_most(),
      estimate->memory_bytes_most());
  return kExitOk;
}

std::string TextOf(const TreeSummary& summary) {
  std::string text;
  for (const std::string& file : summary.files()) {
    text += "wrote " + file + "\n";
  }
  if (summary.trees() != 1)
    text += fmt::format("{:.0f} trees, ", summary.trees());
  text += summary.vertices() > 0
              ? fmt::format("{:.0f} vertices, {:.0f} triangles, {:.0f} leaves",
                            summary.vertices(), summary.triangles(),
                            summary.leaves())
              : fmt::format("{:.0f} segments", summary.segments());
  return text + fmt::format(", {:.2f} s", summary.seconds());
}

absl::Status Write(const TreeCommand& command, const ChosenTree& tree,
                   Backend* backend, std::stop_token stop,
                   TreeSummary* summary) {
  TreeFileOptions files = command.files;
  files.model.tubes.set_sides(command.sides);
  files.model.tubes.set_ends(command.ends);
  if (!command.foliage.empty()) {
    v1::FlowerChoice choice;
    choice.set_preset(command.foliage);
    absl::StatusOr<FlowerModel> foliage = FlowerModel::Stream(
        choice, ProgressMode::kNone, &backend->flowers(), stop);
    if (!foliage.ok()) return foliage.status();
    files.foliage = std::make_shared<FlowerModel>(std::move(*foliage));
  }
  if (!command.is_forest) {
    return WriteTree(tree, files, &backend->trees(), std::move(stop), summary);
  }
  const absl::StatusOr<Forest> forest = Forest::Create(command.forest);
  if (!forest.ok()) return forest.status();
  return WriteForest(tree, *forest, files, &backend->trees(), std::move(stop),
                     summary);
}

int Run(const TreeCommand& command, std::stop_token stop) {
  if (!command.dry_run) {
    const absl::StatusOr<TreeFormat> format = TreeFormatOf(command.files.out);
    if (!format.ok()) {
      ReportStatus(format.status());
      return kExitUsage;
    }
  }
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenTree> tree =
      ChooseTree(command.tree, &backend->trees(), stop);
  if (!tree.ok()) return ReportStatus(tree.status());
  if (command.dry_run) {
    return PrintEstimate(command, *tree, &backend->trees(), std::move(stop));
  }
  const auto start = std::chrono::steady_clock::now();
  TreeSummary summary;
  const absl::Status status =
      Write(command, *tree, backend.get(), std::move(stop), &summary);
  if (!status.ok()) return ReportStatus(status);
  summary.set_seconds(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count());
  std::cout << (command.json ? JsonLine(summary) : TextOf(summary)) << '\n';
  return kExitOk;
}

void AddChoiceOptions(CLI::App* app, TreeOptions* tree) {
  CLI::Option* preset =
      app->add_option("--preset", tree->preset,
                      "Preset by name; `terrane presets` lists them")
          ->group("Tree");
  app->add_option("--recipe", tree->recipe_file,
                  "Recipe file: a TreeRecipe as JSON")
      ->check(CLI::ExistingFile)
      ->excludes(preset)
      ->group("Tree");
  app->add_option("--seed", tree->seed, "Any 64-bit number")->group("Tree");
  app->add_option("--depth", tree->depth,
                  "The last generation, 0 to 32; the trunk is 0")
      ->group("Tree");
  app->add_option("--dim", tree->dimensions, "2 or 3 dimensions")
      ->check(CLI::IsMember({2, 3}))
      ->group("Tree");
  app->add_option("--set", tree->settings,
                  "Any field of the recipe, such as genetic.left_share=0.2; "
                  "may be given again")
      ->type_name("FIELD=VALUE")
      ->group("Tree");
}

void AddForestOptions(CLI::App* app, TreeCommand* command) {
  ForestOptions* const forest = &command->forest;
  CLI::Option* flag =
      app->add_flag("--forest", command->is_forest,
                    "Many trees of the recipe in one .glb, .swc or .csv")
          ->group("Forest");
  CLI::Option* placements =
      app->add_option("--placements", forest->placements_file,
                      "CSV of x, y and, if there, z, seed, scale and yaw_deg")
          ->check(CLI::ExistingFile)
          ->needs(flag)
          ->group("Forest");
  CLI::Option* count =
      app->add_option("--count", forest->count, "Trees, on a square grid")
          ->check(AboveZero())
          ->needs(flag)
          ->excludes(placements)
          ->group("Forest");
  app->add_option("--first-seed", forest->first_seed,
                  "Seeds are this and on (default: 1)")
      ->needs(flag)
      ->group("Forest");
  app->add_option("--spacing", forest->spacing,
                  "Of the grid (default: three times the trunk's length)")
      ->needs(count)
      ->group("Forest");
}

void AddMeshOptions(CLI::App* app, TreeCommand* command) {
  TreeFileOptions* const files = &command->files;
  app->add_option("--lod", files->levels,
                  "Generations left out, with fewer faces and leaves; several, "
                  "such as 0,1,2, in one .glb")
      ->delimiter(',')
      ->check(CLI::Range(0, 32))
      ->type_name("N,...")
      ->group("Mesh");
  app->add_option("--sides", command->sides,
                  "Faces around the trunk, 3 to 64 (default: 12)")
      ->group("Mesh");
  app->add_option("--ends", command->ends,
                  "Of tubes: open, joined (tips and the trunk's base are "
                  "closed) or closed")
      ->transform(OneOf(kEnds))
      ->type_name("NAME")
      ->default_str("joined")
      ->group("Mesh");
  app->add_flag("--leaves,!--no-leaves", files->model.leaves,
                "Leaves, where the recipe has them (default: yes)")
      ->group("Mesh");
  app->add_option(
         "--foliage", command->foliage,
         "Flowers or leaves of a preset in the leaves' places, such as "
         "flower/leaf-wavy; in .glb and .obj")
      ->type_name("PRESET")
      ->excludes("--forest")
      ->group("Mesh");
  app->add_option("--instancing", files->instancing,
                  "Leaves in .glb: extension (EXT_mesh_gpu_instancing) or "
                  "nodes, for programs that do not know it, such as Blender")
      ->transform(OneOf(kInstancings))
      ->type_name("NAME")
      ->default_str("extension")
      ->group("Mesh");
  app->add_option("--metres-per-unit", files->metres_per_unit,
                  "What the recipe's unit is in .glb (default: 1)")
      ->check(AboveZero())
      ->group("Mesh");
}

void AddOutputOptions(CLI::App* app, TreeCommand* command) {
  TreeFileOptions* const files = &command->files;
  CLI::Option* out =
      app->add_option("--out", files->out, "File to write")->group("Output");
  app->add_option("--size", files->picture_size,
                  "Of .png, in pixels a side (default: 900)")
      ->check(CLI::Range(16, 8192))
      ->group("Output");
  app->add_flag("--json", command->json,
                "Print what was written as JSON on standard output")
      ->group("Output");
  app->add_option("--progress", files->model.progress,
                  "auto (a bar on a terminal), none or json, on standard error")
      ->transform(OneOf(kProgressModes))
      ->type_name("NAME")
      ->default_str("auto")
      ->group("Output");
  CLI::Option* dry_run =
      app->add_flag("--dry-run", command->dry_run, "Only print sizes and cost")
          ->group("Output");
  app->parse_complete_callback([out, dry_run] {
    if (out->count() == 0 && dry_run->count() == 0) {
      throw CLI::RequiredError("--out");
    }
  });
}

}  // namespace

void AddTreeCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("tree", "Grow fractal trees into files");
  const auto command = std::make_shared<TreeCommand>();
  AddChoiceOptions(subcommand, &command->tree);
  AddForestOptions(subcommand, command.get());
  AddMeshOptions(subcommand, command.get());
  AddOutputOptions(subcommand, command.get());
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
