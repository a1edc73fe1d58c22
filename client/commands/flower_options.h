// The options of a flower that `terrane flower` and `terrane render` share.
#ifndef TERRANE_CLIENT_COMMANDS_FLOWER_OPTIONS_H_
#define TERRANE_CLIENT_COMMANDS_FLOWER_OPTIONS_H_

#include <CLI/CLI.hpp>

#include "client/chosen_flower.h"

namespace terrane::client {

// Stage, plants and, as `method_name`, the method of petals.
void AddGrowthOptions(CLI::App* app, const char* method_name,
                      FlowerOptions* flower);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_FLOWER_OPTIONS_H_
