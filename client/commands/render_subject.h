// What a picture of `terrane render` is of, and the options that are for it.
#ifndef TERRANE_CLIENT_COMMANDS_RENDER_SUBJECT_H_
#define TERRANE_CLIENT_COMMANDS_RENDER_SUBJECT_H_

#include <CLI/CLI.hpp>

#include "absl/status/status.h"
#include "client/commands/render_command.h"

namespace terrane::client {

// OK unless an option was given that the picture would not heed. `parsed` is
// what the command's options came from.
absl::Status CheckOptionsAreHeeded(const CLI::App& parsed,
                                   const RenderCommand& command);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_RENDER_SUBJECT_H_
