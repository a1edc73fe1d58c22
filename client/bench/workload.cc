#include "client/bench/workload.h"

#include <algorithm>
#include <utility>

namespace terrane::client {
namespace {

// An endless terrain is asked for in this many places along each axis.
constexpr std::int64_t kPlaces = 1 << 12;

// One of the stretches of `length` samples that an axis begins at a multiple of
// its length; the last one may be shorter.
struct Stretch {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

Stretch StretchAt(std::uint32_t place, std::int64_t length,
                  std::optional<std::int64_t> samples) {
  if (!samples.has_value()) return {place % kPlaces * length, length};
  const std::int64_t stretches = (*samples + length - 1) / length;
  const std::int64_t first = place % stretches * length;
  return {first, std::min(length, *samples - first)};
}

bool Asks(const MixWeights& weights, RequestKind kind) {
  return weights[static_cast<std::size_t>(kind)] > 0;
}

}  // namespace

absl::StatusOr<Workload> Workload::Create(const WorkloadOptions& options,
                                          const MixWeights& weights,
                                          Backend* backend,
                                          std::stop_token stop) {
  Workload workload(options);
  for (const auto& [kind, dimensions, extent] :
       {std::tuple(RequestKind::kTiles, 2, &workload.terrain_),
        std::tuple(RequestKind::kProfiles, 1, &workload.profile_)}) {
    if (!Asks(weights, kind)) continue;
    const absl::StatusOr<Extent> fetched =
        workload.FetchExtent(kind, dimensions, backend, stop);
    if (!fetched.ok()) return fetched.status();
    *extent = *fetched;
  }
  // Of the others it is enough that there is such a preset.
  const auto check = [&]<typename Request>(RequestKind kind, Request request,
                                           const auto& fetch) -> absl::Status {
    if (!Asks(weights, kind)) return absl::OkStatus();
    request.set_name(workload.preset(kind));
    return fetch(request).status();
  };
  absl::Status found =
      check(RequestKind::kSurfaces, v1::GetSurfacePresetRequest(),
            [&](const auto& request) {
              return backend->GetSurfacePreset(request, stop);
            });
  if (found.ok()) {
    found = check(RequestKind::kTrees, v1::GetTreePresetRequest(),
                  [&](const auto& request) {
                    return backend->trees().GetTreePreset(request, stop);
                  });
  }
  if (found.ok()) {
    found = check(RequestKind::kFlowers, v1::GetFlowerPresetRequest(),
                  [&](const auto& request) {
                    return backend->flowers().GetFlowerPreset(request, stop);
                  });
  }
  if (!found.ok()) return found;
  return workload;
}

absl::StatusOr<Workload::Extent> Workload::FetchExtent(
    RequestKind kind, int dimensions, Backend* backend,
    std::stop_token stop) const {
  v1::GetPresetRequest request;
  request.set_name(preset(kind));
  const auto found = backend->GetPreset(request, stop);
  if (!found.ok()) return found.status();
  const v1::TerrainRecipe& recipe = found->preset().recipe();
  if ((recipe.dimensions() == 1) != (dimensions == 1)) {
    std::string text = "preset " + preset(kind);
    text += dimensions == 1 ? " is no profile" : " is a profile";
    return absl::InvalidArgumentError(text);
  }
  Extent extent;
  extent.level = options_.level.value_or(found->preset().view().level());
  if (recipe.has_domain()) {
    extent.columns = (recipe.domain().cells_x() << extent.level) + 1;
    extent.rows = (recipe.domain().cells_y() << extent.level) + 1;
  }
  return extent;
}

v1::StreamTilesRequest Workload::Tiles(const PlannedRequest& plan) const {
  const std::int64_t size = options_.tile_size;
  const Stretch x =
      StretchAt(plan.place >> 16, size * options_.tiles, terrain_.columns);
  const Stretch y = StretchAt(plan.place & 0xffff, size, terrain_.rows);
  v1::StreamTilesRequest request;
  request.mutable_terrain()->set_preset(preset(RequestKind::kTiles));
  request.mutable_terrain()->set_seed(plan.seed);
  request.set_level(terrain_.level);
  request.set_tile_size(options_.tile_size);
  v1::Window* window = request.mutable_window();
  window->set_x(x.first);
  window->set_y(y.first);
  window->set_width(x.count);
  window->set_height(y.count);
  return request;
}

v1::GetProfileRequest Workload::Profile(const PlannedRequest& plan) const {
  const Stretch x =
      StretchAt(plan.place, options_.profile_samples, profile_.columns);
  v1::GetProfileRequest request;
  request.mutable_terrain()->set_preset(preset(RequestKind::kProfiles));
  request.mutable_terrain()->set_seed(plan.seed);
  request.set_level(profile_.level);
  request.set_first(x.first);
  request.set_count(x.count);
  return request;
}

v1::StreamSurfaceRequest Workload::Surface(const PlannedRequest& plan) const {
  v1::StreamSurfaceRequest request;
  request.mutable_surface()->set_preset(preset(RequestKind::kSurfaces));
  request.mutable_surface()->set_seed(plan.seed);
  request.set_columns(options_.surface_samples);
  request.set_rows(options_.surface_samples);
  request.set_tile_size(options_.tile_size);
  return request;
}

v1::StreamTreeRequest Workload::Tree(const PlannedRequest& plan) const {
  v1::StreamTreeRequest request;
  request.mutable_tree()->set_preset(preset(RequestKind::kTrees));
  request.mutable_tree()->set_seed(plan.seed);
  if (options_.tree_depth.has_value()) {
    request.mutable_tree()->set_depth(*options_.tree_depth);
  }
  return request;
}

v1::StreamFlowerRequest Workload::Flower(const PlannedRequest& plan) const {
  v1::StreamFlowerRequest request;
  request.mutable_flower()->set_preset(preset(RequestKind::kFlowers));
  request.mutable_flower()->set_seed(plan.seed);
  return request;
}

}  // namespace terrane::client
