// The traced pictures of `terrane render`: RenderService's, into a PNG or
// OpenEXR file.
#ifndef TERRANE_CLIENT_COMMANDS_RENDER_TRACED_H_
#define TERRANE_CLIENT_COMMANDS_RENDER_TRACED_H_

#include <CLI/CLI.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "client/progress.h"
#include "terrane/v1/render.pb.h"

namespace terrane::client {

struct TracedOptions {
  std::optional<int> height;
  std::optional<int> passes;
  std::optional<int> bounces;
  std::optional<v1::ShadingModel> shading;
  std::optional<bool> ground;
  std::optional<double> exposure;
  ProgressMode progress = ProgressMode::kAuto;
};

void AddTracedOptions(CLI::App* command, TracedOptions* options);

// Whether the file named is one that traced pictures are written to.
bool IsTracedFile(const std::string& path);

struct RenderCommand;

// Traces what the options of `terrane render` choose and writes the picture; a
// file .exr holds linear radiance. Errors: those of the backend and of the
// file.
absl::Status WriteTraced(const RenderCommand& command, std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_RENDER_TRACED_H_
