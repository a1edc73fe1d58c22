// Every limit of the service in one place: read by validation, published by
// InfoService.GetServerInfo, printed by `terrane-server --help`.
#ifndef TERRANE_SERVER_ACTOR_LIMITS_H_
#define TERRANE_SERVER_ACTOR_LIMITS_H_

#include <cstdint>

#include "core/flower/validate_flower.h"
#include "core/grid/lattice_window.h"
#include "core/terrain/validate.h"
#include "core/tree/validate.h"

namespace terrane::server {

struct Limits {
  std::int64_t max_request_bytes = 4 << 20;
  int max_level = core::kMaxLevel;
  int max_tile_size = 1025;
  std::int64_t max_stream_samples = std::int64_t{1} << 36;
  int max_points = 100'000;
  int max_profile_samples = 400'000;
  core::SpecLimits recipe;
  std::int64_t max_raster_samples = std::int64_t{1} << 26;
  std::int64_t raster_store_bytes = std::int64_t{1} << 30;
  int max_concurrent_streams = 64;
  std::int64_t prepared_bytes = std::int64_t{2} << 30;
  core::TreeLimits tree;
  std::int64_t max_forest_trees = 1'000'000;
  std::int64_t max_forest_segments = 1'000'000'000;
  core::FlowerLimits flower;
  std::int64_t max_render_pixels = std::int64_t{1} << 23;
  int max_render_passes = 4096;
  std::int64_t max_render_triangles = 4'000'000;
  // Of the scenes and pictures of all streams together.
  std::int64_t render_bytes = std::int64_t{2} << 30;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_LIMITS_H_
