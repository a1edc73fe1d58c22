// An oblique view of a height field as a solid block, the way the paper's
// figures show a surface: parallel projection, tints and hillshade on top,
// walls at the sides. Heights beyond a few hundred posts a side are thinned out
// first.
#ifndef TERRANE_CLIENT_RENDER_PERSPECTIVE_H_
#define TERRANE_CLIENT_RENDER_PERSPECTIVE_H_

#include <optional>

#include "client/render/canvas.h"
#include "client/render/relief.h"
#include "core/grid/hillshade.h"

namespace terrane::client {

struct PerspectiveOptions {
  // Of the picture, in pixels; its height follows from what is seen.
  int width = 1200;
  // Degrees from which the viewer looks: clockwise from south, and above the
  // horizon.
  double turn_deg = 28;
  double tilt_deg = 33;
  // Multiplies the heights; default: so that the relief is a ninth of the
  // longer side.
  std::optional<double> exaggeration;
  // From the viewer's left, so that what faces the viewer is not in the dark.
  core::Light light = {-0.70710678118654752, 0, 0.70710678118654752};
  std::optional<double> water_level;
};

struct PerspectivePicture {
  Picture picture;
  double exaggeration = 1;  // what was used
};

PerspectivePicture RenderPerspective(const core::HeightView& heights,
                                     const core::GroundScale& scale,
                                     const PerspectiveOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_PERSPECTIVE_H_
