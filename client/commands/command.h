// The subcommands of `terrane`, one file each. Adding one declares its options;
// parsing the command line fills them and sets the action to run.
#ifndef TERRANE_CLIENT_COMMANDS_COMMAND_H_
#define TERRANE_CLIENT_COMMANDS_COMMAND_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <stop_token>

namespace terrane::client {

// Runs the chosen subcommand; answers the exit code (client/exit_code.h).
using Action = std::function<int(std::stop_token)>;

void AddTerrainCommand(CLI::App* app, Action* action);
void AddExportCommand(CLI::App* app, Action* action);
void AddProfileCommand(CLI::App* app, Action* action);
void AddHeightsCommand(CLI::App* app, Action* action);
void AddSurfaceCommand(CLI::App* app, Action* action);
void AddTreeCommand(CLI::App* app, Action* action);
void AddFlowerCommand(CLI::App* app, Action* action);
void AddRenderCommand(CLI::App* app, Action* action);
void AddBenchCommand(CLI::App* app, Action* action);
void AddVerifyCommand(CLI::App* app, Action* action);
void AddPresetsCommand(CLI::App* app, Action* action);
void AddInfoCommand(CLI::App* app, Action* action);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_COMMAND_H_
