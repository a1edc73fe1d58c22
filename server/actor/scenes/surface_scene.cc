// The scene of a surface: one mesh, in one colour, seen from both sides.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/mesh/grid_mesh.h"
#include "server/actor/scenes/scene_source.h"
#include "server/convert/render_convert.h"

namespace terrane::server {
namespace {

core::Material UsualMaterial() {
  core::Material material;
  material.name = "surface";
  material.base_color = {0.62f, 0.55f, 0.46f};
  material.roughness = 0.6f;
  material.double_sided = true;
  return material;
}

// Copies the rows of a tile's column of vectors to their places in the grid.
void PlaceTile(const std::string& bytes, const v1::Window& window,
               std::int64_t columns, std::vector<core::Float3>* grid) {
  const auto width = static_cast<std::size_t>(window.width());
  for (std::int64_t j = 0; j < window.height(); ++j) {
    const std::int64_t place = (window.y() + j) * columns + window.x();
    std::memcpy(grid->data() + place,
                bytes.data() +
                    static_cast<std::size_t>(j) * width * sizeof(core::Float3),
                width * sizeof(core::Float3));
  }
}

class SurfaceScene : public SceneSource {
 public:
  SurfaceScene(std::shared_ptr<const SurfaceJob> job,
               const core::Material& material)
      : job_(std::move(job)),
        material_(material),
        positions_(static_cast<std::size_t>(job_->header().columns() *
                                            job_->header().rows())),
        normals_(positions_.size()) {}

  const std::string& recipe_hash() const override {
    return job_->header().recipe_hash();
  }

  absl::Status Advance(std::stop_token stop) override {
    const absl::Status made = job_->MakeTile(next_, std::move(stop), &message_);
    if (!made.ok()) return made;
    const v1::MeshTile& tile = message_.mesh_tile();
    const std::int64_t columns = job_->header().columns();
    PlaceTile(tile.positions(), tile.window(), columns, &positions_);
    PlaceTile(tile.normals(), tile.window(), columns, &normals_);
    if (++next_ < job_->total()) return absl::OkStatus();
    mesh_ = core::MakeGridMesh(
        {columns, job_->header().rows(), positions_, normals_, {}});
    positions_ = {};
    normals_ = {};
    return absl::OkStatus();
  }

  double share() const override {
    return static_cast<double>(next_) / static_cast<double>(job_->total());
  }
  bool Ready() const override { return next_ == job_->total(); }
  core::Scene scene() const override {
    return {{material_}, {{"surface", &mesh_, 0, nullptr}}};
  }

 private:
  const std::shared_ptr<const SurfaceJob> job_;
  const core::Material material_;
  std::vector<core::Float3> positions_;
  std::vector<core::Float3> normals_;
  std::int64_t next_ = 0;
  v1::StreamSurfaceResponse message_;
  core::Mesh mesh_;
};

core::Material MaterialOf(const v1::SurfaceSubject& subject,
                          const SceneRequest& request) {
  return ReadMaterial(subject.has_material() ? &subject.material() : nullptr,
                      UsualMaterial(), request.prefix + "surface.material.",
                      request.violations);
}

v1::StreamSurfaceRequest StreamOf(const v1::SurfaceSubject& subject) {
  v1::StreamSurfaceRequest stream;
  *stream.mutable_surface() = subject.surface();
  stream.set_columns(subject.columns());
  stream.set_rows(subject.rows());
  return stream;
}

core::SceneSize SizeOf(std::int64_t columns, std::int64_t rows) {
  return {columns * rows, 2 * (columns - 1) * (rows - 1), 0};
}

}  // namespace

OpenedScene OpenSurfaceScene(const v1::SurfaceSubject& subject,
                             const SurfaceMaker& surfaces,
                             const SceneRequest& request) {
  const core::Material material = MaterialOf(subject, request);
  auto job = surfaces.Open(StreamOf(subject));
  if (!job.ok()) {
    const absl::Status moved = MoveViolations(
        job.status(), "", request.prefix + "surface.", request.violations);
    if (!moved.ok()) return moved;
  }
  if (!request.violations->empty()) return std::unique_ptr<SceneSource>();
  const v1::SurfaceHeader& header = (*job)->header();
  const absl::Status checked = CheckTriangles(
      SizeOf(header.columns(), header.rows()).triangles, request.limits);
  if (!checked.ok()) return checked;
  return std::make_unique<SurfaceScene>(*std::move(job), material);
}

EstimatedScene EstimateSurfaceScene(const v1::SurfaceSubject& subject,
                                    const SurfaceMaker& surfaces,
                                    const SceneRequest& request) {
  MaterialOf(subject, request);
  v1::EstimateSurfaceRequest asked;
  *asked.mutable_request() = StreamOf(subject);
  const auto estimate = surfaces.Estimate(asked);
  if (!estimate.ok()) {
    const absl::Status moved =
        MoveViolations(estimate.status(), "request.",
                       request.prefix + "surface.", request.violations);
    if (!moved.ok()) return moved;
    return core::SceneSize();
  }
  return SizeOf(subject.columns(), subject.rows());
}

}  // namespace terrane::server
