// What surface_options.h declares.
#include <utility>

#include "client/commands/surface_options.h"
#include "client/surface_grid.h"

namespace terrane::client {
namespace {

constexpr std::int64_t kDefaultSide = 257;

const std::map<std::string, v1::SplineBasis> kBases = {
    {"bezier", v1::SPLINE_BASIS_BEZIER},
    {"bspline-uniform", v1::SPLINE_BASIS_BSPLINE_UNIFORM},
    {"bspline-clamped", v1::SPLINE_BASIS_BSPLINE_CLAMPED},
    {"bilinear", v1::SPLINE_BASIS_BILINEAR},
    {"bicubic-hermite", v1::SPLINE_BASIS_BICUBIC_HERMITE}};

const std::map<std::string, v1::SurfaceMethod> kMethods = {
    {"1", v1::SURFACE_METHOD_PRODUCTS},
    {"2", v1::SURFACE_METHOD_ALONG_T},
    {"3", v1::SURFACE_METHOD_TWO_FACTORS},
    {"4", v1::SURFACE_METHOD_TWO_TERMS}};

ControlPolyhedron PolyhedronOf(const v1::SurfaceNet& net) {
  ControlPolyhedron polyhedron{net.columns(), net.rows(), {}};
  for (const v1::Vector3& point : net.points()) {
    polyhedron.points.push_back({static_cast<float>(point.x()),
                                 static_cast<float>(point.y()),
                                 static_cast<float>(point.z())});
  }
  return polyhedron;
}

}  // namespace

void AddNetOptions(CLI::App* command, SurfaceOptions* options) {
  CLI::Option* net =
      command
          ->add_option("--net", options->net_file,
                       "Control points, row by row: a CSV of x,y,z or an OBJ "
                       "file")
          ->check(CLI::ExistingFile)
          ->excludes("--preset")
          ->excludes("--recipe")
          ->group("Surface");
  command
      ->add_option("--net-columns", options->net_columns,
                   "Points in a row of --net (default: as many as rows)")
      ->check(CLI::Range(2, 64))
      ->needs(net)
      ->group("Surface");
  command
      ->add_option("--basis", options->basis,
                   "bezier, bspline-uniform, bspline-clamped, bilinear or "
                   "bicubic-hermite")
      ->transform(OneOf(kBases))
      ->type_name("NAME")
      ->group("Surface");
  command
      ->add_option("--degree", options->degree, "Of the two B-splines, 1 to 5")
      ->group("Surface");
  command->add_option("--method", options->method, "The paper's method, 1 to 4")
      ->transform(OneOf(kMethods))
      ->type_name("1-4")
      ->group("Surface");
}

void AddSizeOption(CLI::App* command, SurfaceSize* size) {
  command
      ->add_option("--size", size->text,
                   "Samples COLUMNSxROWS of a surface along t and u (default: "
                   "the preset's view, else 257x257)")
      ->type_name("CxR")
      ->group("Surface");
}

absl::Status SetSize(const SurfaceSize& size, const v1::SurfaceView& view,
                     v1::StreamSurfaceRequest* request) {
  if (size.text.empty()) {
    request->set_columns(view.columns() > 0 ? view.columns() : kDefaultSide);
    request->set_rows(view.rows() > 0 ? view.rows() : kDefaultSide);
    return absl::OkStatus();
  }
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  const std::vector<std::string> parts = CLI::detail::split(size.text, 'x');
  if (parts.size() != 2 || !CLI::detail::lexical_cast(parts[0], columns) ||
      !CLI::detail::lexical_cast(parts[1], rows)) {
    return absl::InvalidArgumentError(
        "--size: must be COLUMNSxROWS, such as 513x513, got \"" + size.text +
        "\"");
  }
  request->set_columns(columns);
  request->set_rows(rows);
  return absl::OkStatus();
}

absl::StatusOr<v1::StreamSurfaceRequest> AskForSurface(
    const SurfaceOptions& surface, const SurfaceSize& size, Backend* backend,
    std::stop_token stop) {
  const absl::StatusOr<ChosenSurface> chosen =
      ChooseSurface(surface, backend, std::move(stop));
  if (!chosen.ok()) return chosen.status();
  v1::StreamSurfaceRequest request;
  *request.mutable_surface()->mutable_recipe() = chosen->recipe;
  const absl::Status sized = SetSize(size, chosen->view, &request);
  if (!sized.ok()) return sized;
  return request;
}

absl::StatusOr<Picture> DrawSurface(const SurfaceOptions& surface,
                                    const SurfaceSize& size, bool control_net,
                                    const SurfaceViewOptions& view,
                                    Backend* backend, std::stop_token stop) {
  const absl::StatusOr<ChosenSurface> chosen =
      ChooseSurface(surface, backend, stop);
  if (!chosen.ok()) return chosen.status();
  v1::StreamSurfaceRequest request;
  *request.mutable_surface()->mutable_recipe() = chosen->recipe;
  const absl::Status sized = SetSize(size, chosen->view, &request);
  if (!sized.ok()) return sized;
  const absl::StatusOr<SurfaceGrid> grid =
      StreamToGrid(request, backend, std::move(stop));
  if (!grid.ok()) return grid.status();
  const core::Mesh mesh = grid->MakeMesh();
  if (mesh.indices.empty()) {
    return absl::InvalidArgumentError("no sample lies above the hole level");
  }
  const bool draw_net = control_net || chosen->view.control_net();
  return RenderSurface(
      mesh, draw_net ? PolyhedronOf(chosen->recipe.net()) : ControlPolyhedron(),
      view);
}

}  // namespace terrane::client
