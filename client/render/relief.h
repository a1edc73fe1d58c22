// Pictures of a height field from above: shaded relief, hillshade, grey levels.
// One pixel a sample; the first row of heights is the top row of the picture.
#ifndef TERRANE_CLIENT_RENDER_RELIEF_H_
#define TERRANE_CLIENT_RENDER_RELIEF_H_

#include <optional>

#include "client/render/canvas.h"
#include "core/grid/hillshade.h"

namespace terrane::client {

enum class ReliefStyle { kRelief, kHillshade, kGrey };

struct ReliefOptions {
  ReliefStyle style = ReliefStyle::kRelief;
  core::Light light;
  // Multiplies the heights for the shading only.
  double exaggeration = 1;
  // Heights below it are drawn as a flat sheet of water.
  std::optional<double> water_level;
};

// Where the colours of heights begin and end.
struct TintRange {
  double minimum = 0;
  double maximum = 1;
};

// The range of the heights that are data and not under water.
TintRange TintRangeOf(const core::HeightView& heights,
                      std::optional<double> water_level);

// Colour of a height on land: lowland green over yellow and brown to white.
Rgb LandTint(double height, const TintRange& range);
// Colour of water, darker with depth; `range` is that of the land above it.
Rgb WaterTint(double depth, const TintRange& range);
// Colour under a light: 0 is full shadow, 1 full light, and a level plain under
// the default light keeps its tint.
Rgb Lit(const Rgb& tint, double shade, double level_shade);

Picture RenderRelief(const core::HeightView& heights,
                     const core::GroundScale& scale,
                     const ReliefOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_RELIEF_H_
