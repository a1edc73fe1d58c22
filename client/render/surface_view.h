// A shaded picture of a mesh in parallel projection, with its control net.
//
// Lit from both sides, so that folds show. Pictures are pure functions of what
// is drawn. Threads: any.
#ifndef TERRANE_CLIENT_RENDER_SURFACE_VIEW_H_
#define TERRANE_CLIENT_RENDER_SURFACE_VIEW_H_

#include <vector>

#include "client/render/canvas.h"
#include "core/grid/hillshade.h"
#include "core/mesh/mesh.h"

namespace terrane::client {

// The control points of a net, row-major; drawn with lines between neighbours.
struct ControlPolyhedron {
  int columns = 0;
  int rows = 0;
  std::vector<core::Float3> points;
};

struct SurfaceViewOptions {
  // Of the picture, in pixels; its height follows from what is seen.
  int width = 1200;
  // Where the picture would be higher than this, what is seen is drawn smaller,
  // in the middle; 0: as high as it comes.
  int most_height = 0;
  // Degrees from which the viewer looks: clockwise from south, and above the
  // horizon.
  double turn_deg = 28;
  double tilt_deg = 33;
  // Multiplies the heights.
  double exaggeration = 1;
  core::Light light = {-0.70710678118654752, 0, 0.70710678118654752};
};

// `mesh` has normals and one vertex at least; without colours it is of sand.
Picture RenderSurface(const core::Mesh& mesh, const ControlPolyhedron& net,
                      const SurfaceViewOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_SURFACE_VIEW_H_
