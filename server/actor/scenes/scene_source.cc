#include "server/actor/scenes/scene_source.h"

namespace terrane::server {

absl::Status MoveViolations(const absl::Status& status, const std::string& from,
                            const std::string& to,
                            core::Violations* violations) {
  const std::vector<core::Violation> found = core::ViolationsOf(status);
  if (found.empty()) return status;
  for (const core::Violation& one : found) {
    const std::size_t own = one.field.starts_with(from) ? from.size() : 0;
    violations->Add(to + one.field.substr(own), one.description);
  }
  return absl::OkStatus();
}

absl::Status CheckTriangles(std::int64_t triangles, const Limits& limits) {
  if (triangles <= limits.max_render_triangles) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      "a scene holds at most " + std::to_string(limits.max_render_triangles) +
      " triangles, this one has " + std::to_string(triangles) + " or more");
}

}  // namespace terrane::server
