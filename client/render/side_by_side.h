// Elevation models next to each other, hillshaded at the same ground scale,
// each with a caption: the whole of each above, a detail of each below.
#ifndef TERRANE_CLIENT_RENDER_SIDE_BY_SIDE_H_
#define TERRANE_CLIENT_RENDER_SIDE_BY_SIDE_H_

#include <span>
#include <string>

#include "client/render/canvas.h"
#include "core/grid/hillshade.h"

namespace terrane::client {

struct Panel {
  core::HeightView heights;
  const core::GroundScale* scale;
  std::string caption;
};

struct SideBySideOptions {
  // Of each panel, in pixels.
  int panel_width = 1000;
  // The detail shows this share of the width of the first panel.
  double detail_share = 0.16;
  core::Light light;
  double exaggeration = 1;
};

// From left to right; at least one.
Picture RenderSideBySide(std::span<const Panel> panels,
                         const SideBySideOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_SIDE_BY_SIDE_H_
