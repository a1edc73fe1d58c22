#include "client/commands/render_traced.h"

#include <cstring>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "client/backend.h"
#include "client/commands/render_command.h"
#include "client/output_file.h"
#include "core/codec/image_codec.h"

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

bool IsExr(const std::string& path) {
  return std::filesystem::path(path).extension() == ".exr";
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
  request->set_final_only(true);
}

// What to trace: a tree, a surface or a terrain, as the preset's name says.
absl::StatusOr<v1::StreamRenderRequest> TracedSubject(
    const RenderCommand& command, Backend* backend, std::stop_token stop) {
  v1::StreamRenderRequest request;
  if (IsTree(command)) {
    v1::TreeChoice* const tree = request.mutable_tree()->mutable_tree();
    tree->set_preset(command.terrain.preset);
    if (command.terrain.seed) tree->set_seed(*command.terrain.seed);
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

// Streams the finished picture alone. `Value` is what its encoding holds.
template <typename Value>
absl::StatusOr<core::Image<Value>> StreamPicture(
    const v1::StreamRenderRequest& request, ProgressMode mode, Backend* backend,
    std::stop_token stop) {
  core::Image<Value> image;
  ShareProgress progress(mode, "rendered", "rendering");
  const auto on_header = [&](const v1::RenderHeader& header) {
    image = core::Image<Value>(header.width(), header.height(), 3);
    return absl::OkStatus();
  };
  const auto on_part = [&](const v1::StreamRenderResponse& part) {
    if (part.has_progress()) {
      progress.Show(part.progress().share());
    } else {
      const v1::RenderBand& band = part.band();
      std::memcpy(image.Pixel(0, band.first_row()), band.pixels().data(),
                  band.pixels().size());
    }
    return absl::OkStatus();
  };
  const absl::Status status = backend->renders().StreamRender(
      request, on_header, on_part, std::move(stop));
  if (!status.ok()) return status;
  return image;
}

template <typename Value, typename Encode>
absl::StatusOr<core::EncodedImage> EncodedPicture(
    const v1::StreamRenderRequest& request, ProgressMode mode, Backend* backend,
    std::stop_token stop, const Encode& encode) {
  const auto image =
      StreamPicture<Value>(request, mode, backend, std::move(stop));
  if (!image.ok()) return image.status();
  return encode(*image);
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
      ->check(CLI::PositiveNumber)
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
  command
      ->add_flag("--ground,!--no-ground", options->ground,
                 "Traced: a plain ground or none (default: for plants)")
      ->group(group);
  command
      ->add_option("--exposure", options->exposure,
                   "Traced: multiplies the light of a PNG (default: 1)")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command
      ->add_option("--progress", options->progress,
                   "Traced: auto (a bar on a terminal), none or json")
      ->transform(OneOf(kProgressModes))
      ->type_name("MODE")
      ->group(group);
}

bool IsTracedFile(const std::string& path) {
  return IsExr(path) || std::filesystem::path(path).extension() == ".png";
}

absl::Status WriteTraced(const RenderCommand& command, std::stop_token stop) {
  if (!command.input.empty()) {
    return absl::InvalidArgumentError(
        "--style traced: must be of a preset, a recipe or a net, got the "
        "file " +
        command.input);
  }
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  absl::StatusOr<v1::StreamRenderRequest> request =
      TracedSubject(command, backend.get(), stop);
  if (!request.ok()) return request.status();
  SetPicture(command, &*request);
  const ProgressMode mode = command.traced.progress;
  absl::StatusOr<core::EncodedImage> bytes;
  if (IsExr(command.out)) {
    request->set_encoding(v1::PIXEL_ENCODING_LINEAR_FLOAT32_LE);
    bytes = EncodedPicture<float>(
        *request, mode, backend.get(), std::move(stop),
        [](const core::Image<float>& image) { return core::EncodeExr(image); });
  } else {
    bytes = EncodedPicture<std::uint8_t>(
        *request, mode, backend.get(), std::move(stop),
        [](const core::Image<std::uint8_t>& image) {
          return core::EncodePng(image);
        });
  }
  if (!bytes.ok()) return bytes.status();
  return WriteFile(command.out, std::as_bytes(std::span(*bytes)));
}

}  // namespace terrane::client
