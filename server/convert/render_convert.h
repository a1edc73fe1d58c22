// A picture between the API and the core, and what a request asks of it.
//
// As surface_convert.h: every violation is collected, by its path in the
// request. Threads: any.
#ifndef TERRANE_SERVER_CONVERT_RENDER_CONVERT_H_
#define TERRANE_SERVER_CONVERT_RENDER_CONVERT_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/violations.h"
#include "core/mesh/scene.h"
#include "core/raytrace/ray_tracer.h"
#include "core/raytrace/view.h"
#include "server/actor/limits.h"
#include "terrane/v1/render.pb.h"

namespace terrane::server {

// What a valid StreamRender request asks, but for its subject.
struct RenderPlan {
  // But for the camera, the light and the ground, which the scene's box places.
  core::PictureSpec picture;
  core::Direction view;
  float field_of_view_deg = 30;
  core::LightPlace light;
  bool ground = false;
  core::Material ground_material;

  int passes = 64;
  v1::PixelEncoding encoding = v1::PIXEL_ENCODING_SRGB8;
  float exposure = 1;
  bool final_only = false;
  std::int64_t first_band = 0;

  // Rows of a band: about 65,536 pixels.
  int band_rows() const;
  int bands_of_picture() const;
  // Passes after which a picture is sent, rising; the last is `passes`.
  std::vector<int> Stages() const;
  std::int64_t bands() const;
  std::size_t bytes_per_pixel() const;
  // Of the pixels of the bands from `first` on.
  std::int64_t BytesFrom(std::int64_t first) const;
  std::int64_t pixels() const;
};

// `prefix` stands before the path of each field, such as "request.".
RenderPlan ReadRenderPlan(const v1::StreamRenderRequest& request,
                          const Limits& limits, const std::string& prefix,
                          core::Violations* violations);

// `usual` is what a message that is not there means; fields that it leaves out
// have their defaults.
core::Material ReadMaterial(const v1::RenderMaterial* material,
                            const core::Material& usual,
                            const std::string& prefix,
                            core::Violations* violations);

// The bytes of pixels whose linear values are given.
std::string EncodePixels(std::span<const float> linear, const RenderPlan& plan);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_RENDER_CONVERT_H_
