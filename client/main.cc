// `terrane`: the command line. Results go to standard output, everything else
// to standard error; exit codes are in client/exit_code.h.
#include <CLI/CLI.hpp>

#include "client/commands/command.h"
#include "client/exit_code.h"
#include "client/interrupt.h"

int main(int argc, char** argv) {
  using namespace terrane::client;  // NOLINT: the program is this namespace

  // Before any thread starts, so that they all leave the signals to it.
  const Interrupt interrupt;

  CLI::App app(
      "Fractal terrain, surfaces, trees and flowers: from a server, or made "
      "here with "
      "--local.",
      "terrane");
  app.set_version_flag("--version", TERRANE_VERSION);
  app.require_subcommand(1);
  Action action;
  AddTerrainCommand(&app, &action);
  AddExportCommand(&app, &action);
  AddProfileCommand(&app, &action);
  AddHeightsCommand(&app, &action);
  AddSurfaceCommand(&app, &action);
  AddTreeCommand(&app, &action);
  AddFlowerCommand(&app, &action);
  AddRenderCommand(&app, &action);
  AddBenchCommand(&app, &action);
  AddVerifyCommand(&app, &action);
  AddPresetsCommand(&app, &action);
  AddInfoCommand(&app, &action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return action(interrupt.token());
}
