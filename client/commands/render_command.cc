#include "client/commands/render_command.h"

#include <map>

#include "client/chosen_tree.h"
#include "client/traced_picture.h"

namespace terrane::client {
namespace {

const std::map<std::string, v1::RenderStyle> kStyles = {
    {"relief", v1::RENDER_STYLE_RELIEF},
    {"hillshade", v1::RENDER_STYLE_HILLSHADE},
    {"grey", v1::RENDER_STYLE_GREY},
    {"perspective", v1::RENDER_STYLE_PERSPECTIVE},
    {"traced", v1::RENDER_STYLE_TRACED}};

}  // namespace

void AddPictureOptions(CLI::App* app, RenderCommand* command) {
  app->add_option("--style", command->style,
                  "relief (default), hillshade, grey, perspective or traced; "
                  "profiles are always plotted, trees and flowers always "
                  "traced")
      ->transform(OneOf(kStyles))
      ->type_name("NAME")
      ->group("Picture");
  app->add_option("--exaggeration", command->exaggeration,
                  "Multiplies the heights (default: 1; perspective: so that "
                  "the relief is a ninth of the width)")
      ->check(AboveZero())
      ->group("Picture");
  app->add_option("--water-level", command->water_level,
                  "Heights below are drawn as a sheet of water")
      ->group("Picture");
  app->add_option("--marks", command->marks,
                  "X,X,...: verticals in a plotted profile")
      ->delimiter(',')
      ->group("Picture");
  app->add_flag("--show-spots", command->show_spots,
                "Draw the spot heights' points and lines on a generated map")
      ->group("Picture");
  app->add_option("--light", command->light,
                  "AZIMUTH,ALTITUDE of the light in degrees (default: 315,45; "
                  "perspective: 270,45)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("AZ,ALT")
      ->group("Picture");
  app->add_option("--turn", command->turn_deg,
                  "Perspective: degrees clockwise from south")
      ->capture_default_str()
      ->group("Picture");
  app->add_option("--tilt", command->tilt_deg,
                  "Perspective: degrees above the horizon")
      ->check(CLI::Range(1.0, 90.0))
      ->capture_default_str()
      ->group("Picture");
  app->add_option("--width", command->width,
                  "Pixels (default: 1 a sample; plots and perspective 1200; "
                  "side by side 1000 each)")
      ->check(CLI::Range(16, 16384))
      ->group("Picture");
  app->add_option("--title", command->title, "Title of a plot")
      ->group("Picture");
  app->add_option("--out", command->out,
                  "PNG file to write; traced: or OpenEXR, .exr")
      ->required()
      ->check([](const std::string& path) {
        return IsTracedFile(path)
                   ? std::string()
                   : "must end in .png or .exr, got \"" + path + "\"";
      })
      ->group("Picture");
}

bool IsSurface(const RenderCommand& command) {
  return IsSurfacePreset(command.terrain.preset) ||
         !command.surface.net_file.empty();
}

bool IsTree(const RenderCommand& command) {
  return IsTreePreset(command.terrain.preset);
}

bool IsFlower(const RenderCommand& command) {
  return IsFlowerPreset(command.terrain.preset);
}

bool IsTraced(const RenderCommand& command) {
  return IsTree(command) || IsFlower(command) ||
         command.style == v1::RENDER_STYLE_TRACED;
}

SurfaceOptions SurfaceOptionsOf(const RenderCommand& command) {
  SurfaceOptions surface = command.surface;
  surface.preset = command.terrain.preset;
  surface.seed = command.terrain.seed;
  return surface;
}

RenderCommand WithView(RenderCommand command, const ChosenTerrain& terrain) {
  const v1::PresetView& view = terrain.view;
  if (!command.style.has_value()) {
    command.style = view.style() == v1::RENDER_STYLE_UNSPECIFIED
                        ? v1::RENDER_STYLE_RELIEF
                        : view.style();
  }
  if (!command.exaggeration.has_value() && view.exaggeration() > 0) {
    command.exaggeration = view.exaggeration();
  }
  if (!command.water_level.has_value() && view.has_water_level()) {
    command.water_level = view.water_level();
  }
  if (command.marks.empty()) {
    command.marks.assign(view.marks().begin(), view.marks().end());
  }
  if (command.title.empty()) command.title = terrain.title;
  return command;
}

std::optional<v1::Window> WindowToDraw(const RenderCommand& command,
                                       const ChosenTerrain& terrain,
                                       int level) {
  if (!command.extent.window.empty()) return WindowOf(command.extent.window);
  if (terrain.view.has_window() && level == terrain.view.level()) {
    return terrain.view.window();
  }
  return std::nullopt;
}

}  // namespace terrane::client
