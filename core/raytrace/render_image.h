// A whole picture, pass after pass, on several threads.
//
// Threads share the rows of a pass and wait for each other before the next one,
// so the picture is whole after every pass, and does not depend on their
// number.
#ifndef TERRANE_CORE_RAYTRACE_RENDER_IMAGE_H_
#define TERRANE_CORE_RAYTRACE_RENDER_IMAGE_H_

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/raytrace/ray_tracer.h"

namespace terrane::core {

struct RenderPlan {
  int passes = 64;  // at least 1
  int threads = 1;  // at least 1
};

// Called on the caller's thread after every pass: how many there were, and the
// sum of them, three floats a pixel.
using PassDone = std::function<void(int passes, std::span<const float> sums)>;

// The mean of the passes: linear red, green, blue, three floats a pixel,
// row-major, top row first. Errors: CANCELLED within a millisecond of `stop`.
absl::StatusOr<std::vector<float>> RenderImage(const RayTracer& tracer,
                                               const RenderPlan& plan,
                                               std::stop_token stop,
                                               const PassDone& pass_done);

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_RENDER_IMAGE_H_
