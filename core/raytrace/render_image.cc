#include "core/raytrace/render_image.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

namespace terrane::core {
namespace {

constexpr int kTileRows = 8;

// Adds one pass, its rows shared between `threads` threads. False when stopped.
bool AddWholePass(const RayTracer& tracer, int pass, int threads,
                  const std::stop_token& stop, std::span<float> sums) {
  const int height = tracer.spec().height;
  const std::size_t row_floats =
      3 * static_cast<std::size_t>(tracer.spec().width);
  std::atomic<int> next_row = 0;
  std::atomic<bool> stopped = false;
  const auto work = [&] {
    for (int row = next_row.fetch_add(kTileRows); row < height && !stopped;
         row = next_row.fetch_add(kTileRows)) {
      const int rows = std::min(kTileRows, height - row);
      const std::span<float> tile =
          sums.subspan(static_cast<std::size_t>(row) * row_floats,
                       static_cast<std::size_t>(rows) * row_floats);
      if (!tracer.AddPass(pass, row, rows, stop, tile).ok()) stopped = true;
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
    work();
  }
  return !stopped;
}

}  // namespace

absl::StatusOr<std::vector<float>> RenderImage(const RayTracer& tracer,
                                               const RenderPlan& plan,
                                               std::stop_token stop,
                                               const PassDone& pass_done) {
  std::vector<float> sums(3 * static_cast<std::size_t>(tracer.spec().width) *
                          static_cast<std::size_t>(tracer.spec().height));
  for (int pass = 0; pass < plan.passes; ++pass) {
    if (!AddWholePass(tracer, pass, plan.threads, stop, sums)) {
      return absl::CancelledError("rendering stopped");
    }
    if (pass_done) pass_done(pass + 1, sums);
  }
  const float passes = static_cast<float>(plan.passes);
  for (float& value : sums) value /= passes;
  return sums;
}

}  // namespace terrane::core
