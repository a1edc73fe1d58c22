#include "client/commands/render_traced.h"

#include <cstdint>
#include <map>
#include <utility>

#include "client/backend.h"
#include "client/chosen_flower.h"
#include "client/chosen_tree.h"
#include "client/commands/render_command.h"
#include "client/traced_picture.h"
#include "client/tree_model.h"

namespace terrane::client {
namespace {

const std::map<std::string, v1::ShadingModel> kShadings = {
    {"conserving", v1::SHADING_MODEL_CONSERVING},
    {"literal", v1::SHADING_MODEL_LITERAL},
    {"lambert", v1::SHADING_MODEL_LAMBERT},
    {"blinn-phong", v1::SHADING_MODEL_BLINN_PHONG}};

const std::map<std::string, ProgressMode> kProgressModes = {
    {"auto", ProgressMode::kAuto},
    {"none", ProgressMode::kNone},
    {"json", ProgressMode::kJson}};

void SetMaterial(const core::Material& material, v1::RenderMaterial* message) {
  v1::LinearColor* const color = message->mutable_base_color();
  color->set_red(material.base_color[0]);
  color->set_green(material.base_color[1]);
  color->set_blue(material.base_color[2]);
  message->set_roughness(material.roughness);
  message->set_specular(material.specular);
  message->set_gloss(material.Gloss());
}

// What the options say of the picture, whatever it shows.
void SetPicture(const RenderCommand& command,
                v1::StreamRenderRequest* request) {
  const TracedOptions& options = command.traced;
  request->mutable_view()->set_turn_deg(command.turn_deg);
  request->mutable_view()->set_tilt_deg(command.tilt_deg);
  if (!command.light.empty()) {
    // Azimuths are counted from north, turns from south.
    request->mutable_light()->set_turn_deg(command.light[0] - 180);
    request->mutable_light()->set_tilt_deg(command.light[1]);
  }
  if (command.width) request->set_width(*command.width);
  if (options.height) request->set_height(*options.height);
  if (options.passes) request->set_passes(*options.passes);
  if (options.bounces) request->set_bounces(*options.bounces);
  if (options.shading) request->set_shading(*options.shading);
  if (options.ground) request->set_ground(*options.ground);
  if (options.exposure) request->set_exposure(*options.exposure);
}

// A tree as its preset wants to be looked at.
absl::Status SetTree(const RenderCommand& command, TreeBackend* backend,
                     std::stop_token stop, v1::TreeSubject* subject) {
  TreeOptions options;
  options.preset = command.terrain.preset;
  options.seed = command.terrain.seed;
  const absl::StatusOr<ChosenTree> tree =
      ChooseTree(options, backend, std::move(stop));
  if (!tree.ok()) return tree.status();
  *subject->mutable_tree()->mutable_recipe() = tree->recipe;
  const absl::StatusOr<TreeLook> look = TreeLook::Create(tree->view);
  if (!look.ok()) return look.status();
  SetMaterial(look->materials()[TreeLook::kBark], subject->mutable_bark());
  SetMaterial(look->materials()[TreeLook::kLeaf], subject->mutable_leaf());
  v1::LeafShape* const shape = subject->mutable_leaf_shape();
  shape->set_width(tree->view.leaf_width());
  shape->set_blades(tree->view.leaf_blades());
  shape->set_spread_deg(tree->view.leaf_spread_deg());
  return absl::OkStatus();
}

// What to trace: a tree, a flower, a surface or a terrain, as the preset's name
// says.
absl::StatusOr<v1::StreamRenderRequest> TracedSubject(
    const RenderCommand& command, Backend* backend, std::stop_token stop) {
  v1::StreamRenderRequest request;
  if (IsTree(command)) {
    const absl::Status set = SetTree(command, &backend->trees(),
                                     std::move(stop), request.mutable_tree());
    if (!set.ok()) return set;
    return request;
  }
  if (IsFlower(command)) {
    FlowerOptions flower = command.flower;
    flower.preset = command.terrain.preset;
    flower.seed = command.terrain.seed;
    const absl::StatusOr<v1::FlowerChoice> choice = ChooseFlower(flower);
    if (!choice.ok()) return choice.status();
    *request.mutable_flower()->mutable_flower() = *choice;
    return request;
  }
  if (IsSurface(command)) {
    const absl::StatusOr<v1::StreamSurfaceRequest> surface =
        AskForSurface(SurfaceOptionsOf(command), command.size, backend, stop);
    if (!surface.ok()) return surface.status();
    v1::SurfaceSubject* const subject = request.mutable_surface();
    *subject->mutable_surface() = surface->surface();
    subject->set_columns(surface->columns());
    subject->set_rows(surface->rows());
    return request;
  }
  const absl::StatusOr<ChosenTerrain> terrain =
      ChooseTerrain(command.terrain, command.extent.level, backend, stop);
  if (!terrain.ok()) return terrain.status();
  const RenderCommand viewed = WithView(command, *terrain);
  v1::TerrainSubject* const subject = request.mutable_terrain();
  *subject->mutable_terrain() = terrain->choice;
  subject->set_level(terrain->level);
  if (viewed.exaggeration) subject->set_exaggeration(*viewed.exaggeration);
  const std::optional<v1::Window> window =
      WindowToDraw(command, *terrain, terrain->level);
  if (window.has_value()) *subject->mutable_window() = *window;
  return request;
}

}  // namespace

void AddTracedOptions(CLI::App* command, TracedOptions* options) {
  const char* const group = "Traced picture";
  command
      ->add_option("--height", options->height,
                   "Traced: pixels from top to bottom (default: 600)")
      ->check(CLI::Range(16, 16384))
      ->group(group);
  command
      ->add_option("--passes", options->passes,
                   "Traced: samples a pixel (default: 64)")
      ->check(AboveZero())
      ->group(group);
  command
      ->add_option("--bounces", options->bounces,
                   "Traced: surfaces that light comes along after the first, 0 "
                   "to 16 (default: 1)")
      ->group(group);
  command
      ->add_option("--shading", options->shading,
                   "Traced: conserving (default), literal, lambert or "
                   "blinn-phong")
      ->transform(OneOf(kShadings))
      ->type_name("NAME")
      ->group(group);
  // Not add_flag: CLI11 would count in the optional, and set it from the start.
  command
      ->add_flag_function(
          "--ground,!--no-ground",
          [options](std::int64_t count) { options->ground = count > 0; },
          "Traced: a plain ground or none (default: for plants)")
      ->group(group);
  command
      ->add_option("--exposure", options->exposure,
                   "Traced: multiplies the light of a PNG (default: 1)")
      ->check(AboveZero())
      ->group(group);
  command
      ->add_option("--progress", options->progress,
                   "Traced: auto (a bar on a terminal), none or json")
      ->transform(OneOf(kProgressModes))
      ->type_name("MODE")
      ->group(group);
}

absl::Status WriteTraced(const RenderCommand& command, std::stop_token stop) {
  const std::string& file = command.side_by_side.empty()
                                ? command.input
                                : command.side_by_side.front();
  if (!file.empty()) {
    return absl::InvalidArgumentError(
        "--style traced: must be of a preset, a recipe or a net, got the "
        "file " +
        file);
  }
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  absl::StatusOr<v1::StreamRenderRequest> request =
      TracedSubject(command, backend.get(), stop);
  if (!request.ok()) return request.status();
  SetPicture(command, &*request);
  return WriteTracedPicture(*std::move(request), command.out,
                            command.traced.progress, &backend->renders(),
                            std::move(stop));
}

}  // namespace terrane::client
