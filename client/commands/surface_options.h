// The options of `terrane surface` and of `terrane render` that say which
// surface, and the picture of one.
#ifndef TERRANE_CLIENT_COMMANDS_SURFACE_OPTIONS_H_
#define TERRANE_CLIENT_COMMANDS_SURFACE_OPTIONS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "client/chosen_surface.h"
#include "client/commands/shared_options.h"
#include "client/render/surface_view.h"

namespace terrane::client {

// Samples along t and u; empty: the preset's view, else 257 x 257.
struct SurfaceSize {
  std::string text;  // "513x257"
};

void AddNetOptions(CLI::App* command, SurfaceOptions* options);
void AddSizeOption(CLI::App* command, SurfaceSize* size);

// Sets the columns and rows of a request.
absl::Status SetSize(const SurfaceSize& size, const v1::SurfaceView& view,
                     v1::StreamSurfaceRequest* request);

// The request for a surface, as its options and its preset's view say.
absl::StatusOr<v1::StreamSurfaceRequest> AskForSurface(
    const SurfaceOptions& surface, const SurfaceSize& size, Backend* backend,
    std::stop_token stop);

// Generates a surface and draws it; with `control_net`, or when its view says
// so, with the control polyhedron.
absl::StatusOr<Picture> DrawSurface(const SurfaceOptions& surface,
                                    const SurfaceSize& size, bool control_net,
                                    const SurfaceViewOptions& view,
                                    Backend* backend, std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_SURFACE_OPTIONS_H_
