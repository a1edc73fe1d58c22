// `terrane flower`: flowers and beds of them into files.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include "client/chosen_flower.h"
#include "client/commands/command.h"
#include "client/commands/flower_options.h"
#include "client/commands/shared_options.h"
#include "client/exit_code.h"
#include "client/flower_model.h"
#include "client/report.pb.h"
#include "client/scene_files.h"
#include "client/traced_picture.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane flower --preset flower/rose --out rose.glb
  terrane flower --preset flower/rose --stage 0.3 --seed 7 --out bud.obj
  terrane flower --preset flower/daisy --plants 100 --out bed.glb
  terrane flower --preset flower/rose --method bezier --instancing nodes --out b.glb
  terrane flower --preset flower/pansy --out pansy.png
--out by extension: .glb .obj (with an .mtl beside it), in metres; .png .exr, ray
traced (terrane render has more to say of pictures). Exit codes: as terrain.)";

const std::map<std::string, core::GltfInstancing> kInstancings = {
    {"extension", core::GltfInstancing::kExtension},
    {"nodes", core::GltfInstancing::kNodes}};

const std::map<std::string, ProgressMode> kProgressModes = {
    {"auto", ProgressMode::kAuto},
    {"none", ProgressMode::kNone},
    {"json", ProgressMode::kJson}};

struct FlowerCommand {
  ConnectionOptions connection;
  FlowerOptions flower;
  std::string out;
  core::GltfInstancing instancing = core::GltfInstancing::kExtension;
  int picture_size = 800;  // pixels a side
  ProgressMode progress = ProgressMode::kAuto;
  bool json = false;
  bool dry_run = false;
};

absl::Status CheckOut(const std::string& path) {
  const std::filesystem::path extension =
      std::filesystem::path(path).extension();
  if (extension == ".glb" || extension == ".obj" || IsTracedFile(path)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      "--out: must end in .glb, .obj, .png or .exr, got \"" + path + "\"");
}

int PrintEstimate(const FlowerCommand& command, const v1::FlowerChoice& choice,
                  FlowerBackend* backend, std::stop_token stop) {
  v1::EstimateFlowerRequest ask;
  *ask.mutable_flower() = choice;
  const absl::StatusOr<v1::EstimateFlowerResponse> estimate =
      backend->EstimateFlower(ask, std::move(stop));
  if (!estimate.ok()) return ReportStatus(estimate.status());
  if (command.json) {
    std::cout << JsonLine(*estimate) << '\n';
    return kExitOk;
  }
  std::cout << fmt::format(
      "{} prototypes of {} vertices and {} triangles, {} bytes\n"
      "{} instances, {} bytes\n"
      "{} control values\n"
      "about {:.3g} s of one core, {} bytes of memory\n",
      estimate->prototypes(), estimate->vertices(), estimate->triangles(),
      estimate->prototype_bytes(), estimate->instances(),
      estimate->instance_bytes(), estimate->control_values(),
      estimate->cpu_seconds(), estimate->memory_bytes());
  return kExitOk;
}

// What made the file, for asset.extras.
std::string OriginOf(const v1::FlowerHeader& header) {
  v1::FlowerHeader origin;
  *origin.mutable_recipe() = header.recipe();
  origin.set_recipe_hash(header.recipe_hash());
  origin.set_revision(header.revision());
  return JsonLine(origin);
}

FlowerSummary Summary(const FlowerModel& model,
                      const std::vector<std::string>& files) {
  const v1::FlowerHeader& header = model.header();
  FlowerSummary summary;
  for (const std::string& file : files) summary.add_files(file);
  summary.set_plants(header.recipe().bed().plants());
  summary.set_prototypes(header.prototypes());
  summary.set_vertices(static_cast<double>(model.vertices()));
  summary.set_triangles(static_cast<double>(model.triangles()));
  summary.set_instances(static_cast<double>(header.rows()));
  summary.set_data_bytes(static_cast<double>(model.data_bytes()));
  *summary.mutable_warnings() = header.warnings();
  summary.set_recipe_hash(header.recipe_hash());
  summary.set_revision(header.revision());
  return summary;
}

std::string TextOf(const FlowerSummary& summary) {
  std::string text;
  for (const std::string& file : summary.files()) {
    text += "wrote " + file + "\n";
  }
  if (summary.plants() != 1) {
    text += fmt::format("{:.0f} plants, ", summary.plants());
  }
  return text + fmt::format(
                    "{:.0f} prototypes with {:.0f} vertices, {:.0f} "
                    "instances, {:.0f} bytes, {:.2f} s",
                    summary.prototypes(), summary.vertices(),
                    summary.instances(), summary.data_bytes(),
                    summary.seconds());
}

int Draw(const FlowerCommand& command, const v1::FlowerChoice& choice,
         RenderBackend* backend, std::stop_token stop) {
  v1::StreamRenderRequest request;
  *request.mutable_flower()->mutable_flower() = choice;
  request.set_width(command.picture_size);
  request.set_height(command.picture_size);
  const absl::Status drawn =
      WriteTracedPicture(std::move(request), command.out, command.progress,
                         backend, std::move(stop));
  if (!drawn.ok()) return ReportStatus(drawn);
  FlowerSummary summary;
  summary.add_files(command.out);
  std::cout << (command.json ? JsonLine(summary) : "wrote " + command.out)
            << '\n';
  return kExitOk;
}

int Generate(const FlowerCommand& command, const v1::FlowerChoice& choice,
             FlowerBackend* backend, std::stop_token stop) {
  const auto start = std::chrono::steady_clock::now();
  const absl::StatusOr<FlowerModel> model =
      FlowerModel::Stream(choice, command.progress, backend, std::move(stop));
  if (!model.ok()) return ReportStatus(model.status());
  for (const std::string& warning : model->header().warnings()) {
    std::cerr << "terrane: warning: " << warning << '\n';
  }
  std::vector<std::string> files;
  const absl::Status written = WriteScene(
      command.out, model->View(),
      {.instancing = command.instancing, .extras = OriginOf(model->header())},
      &files);
  if (!written.ok()) return ReportStatus(written);
  FlowerSummary summary = Summary(*model, files);
  summary.set_seconds(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count());
  std::cout << (command.json ? JsonLine(summary) : TextOf(summary)) << '\n';
  return kExitOk;
}

int Run(const FlowerCommand& command, std::stop_token stop) {
  const absl::StatusOr<v1::FlowerChoice> choice = ChooseFlower(command.flower);
  const absl::Status out =
      command.dry_run ? absl::OkStatus() : CheckOut(command.out);
  for (const absl::Status& status : {choice.status(), out}) {
    if (status.ok()) continue;
    ReportStatus(status);
    return kExitUsage;
  }
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  if (command.dry_run) {
    return PrintEstimate(command, *choice, &backend->flowers(),
                         std::move(stop));
  }
  if (IsTracedFile(command.out)) {
    return Draw(command, *choice, &backend->renders(), std::move(stop));
  }
  return Generate(command, *choice, &backend->flowers(), std::move(stop));
}

void AddOutputOptions(CLI::App* app, FlowerCommand* command) {
  CLI::Option* out =
      app->add_option("--out", command->out, "File to write")->group("Output");
  app->add_option("--instancing", command->instancing,
                  "Petals in .glb: extension (EXT_mesh_gpu_instancing) or "
                  "nodes, for programs that do not know it, such as Blender")
      ->transform(OneOf(kInstancings))
      ->type_name("NAME")
      ->default_str("extension")
      ->group("Output");
  app->add_option("--size", command->picture_size,
                  "Of pictures, in pixels a side (default: 800)")
      ->check(CLI::Range(16, 8192))
      ->group("Output");
  app->add_flag("--json", command->json,
                "Print what was written as JSON on standard output")
      ->group("Output");
  app->add_option("--progress", command->progress,
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

void AddFlowerOptions(CLI::App* app, FlowerOptions* flower) {
  CLI::Option* preset =
      app->add_option("--preset", flower->preset,
                      "Preset by name; `terrane presets` lists them")
          ->group("Flower");
  app->add_option("--recipe", flower->recipe_file,
                  "Recipe file: a FlowerRecipe as JSON")
      ->check(CLI::ExistingFile)
      ->excludes(preset)
      ->group("Flower");
  app->add_option("--seed", flower->seed, "Any 64-bit number")->group("Flower");
  AddGrowthOptions(app, "--method", flower);
}

}  // namespace

void AddFlowerCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand = app->add_subcommand(
      "flower", "Make flowers, or beds of them, into files");
  const auto command = std::make_shared<FlowerCommand>();
  AddFlowerOptions(subcommand, &command->flower);
  AddOutputOptions(subcommand, command.get());
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
