// The options of `terrane render`, and what follows from them alone.
#ifndef TERRANE_CLIENT_COMMANDS_RENDER_COMMAND_H_
#define TERRANE_CLIENT_COMMANDS_RENDER_COMMAND_H_

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "client/commands/render_traced.h"
#include "client/commands/shared_options.h"
#include "client/commands/surface_options.h"
#include "client/render/perspective.h"

namespace terrane::client {

struct RenderCommand {
  ConnectionOptions connection;
  TerrainOptions terrain;
  ExtentOptions extent;
  std::string input;
  std::vector<std::string> side_by_side;
  int band = 0;
  std::string out;
  std::optional<v1::RenderStyle> style;
  std::optional<double> exaggeration;
  std::optional<double> water_level;
  std::vector<double> marks;
  bool show_spots = false;
  std::vector<double> light;  // azimuth, altitude; empty: by style
  double turn_deg = PerspectiveOptions().turn_deg;
  double tilt_deg = PerspectiveOptions().tilt_deg;
  std::optional<int> width;
  std::string title;
  // Surfaces.
  SurfaceOptions surface;
  SurfaceSize size;
  bool control_net = false;
  TracedOptions traced;
};

// Those that say how the picture looks and where it goes.
void AddPictureOptions(CLI::App* app, RenderCommand* command);

// What a preset's name or a net chooses.
bool IsSurface(const RenderCommand& command);
bool IsTree(const RenderCommand& command);
// Trees always are.
bool IsTraced(const RenderCommand& command);

SurfaceOptions SurfaceOptionsOf(const RenderCommand& command);

// The preset's view, where no option says otherwise.
RenderCommand WithView(RenderCommand command, const ChosenTerrain& terrain);

// The window that was asked for, or the one that the preset shows.
std::optional<v1::Window> WindowToDraw(const RenderCommand& command,
                                       const ChosenTerrain& terrain, int level);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_RENDER_COMMAND_H_
