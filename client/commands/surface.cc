// `terrane surface`: meshes and height fields of surfaces into files.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <utility>

#include "client/commands/command.h"
#include "client/commands/surface_options.h"
#include "client/exit_code.h"
#include "client/output_file.h"
#include "client/surface_grid.h"
#include "client/terrain_export.h"
#include "core/codec/gltf.h"
#include "core/codec/obj.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane surface --preset surface/fig07 --size 513x513 --out s.glb
  terrane surface --net points.csv --net-columns 8 --basis bspline-clamped --out s.obj
  terrane surface --preset surface/fig02 --size 1025x1025 --out heights.tif
--out by extension: .glb .obj (meshes); .tif .png (16-bit) .exr .r16 .f32
(heights, for nets that are a graph over x and y). Exit codes: as terrain.)";

const core::Material kMaterial = {.name = "ground",
                                  .base_color = {0.6f, 0.45f, 0.26f},
                                  .roughness = 0.9f,
                                  .double_sided = true};

struct SurfaceCommand {
  ConnectionOptions connection;
  SurfaceOptions surface;
  SurfaceSize size;
  std::string out;
  std::vector<double> range;
  bool uvs = false;
  bool json = false;
  bool dry_run = false;
};

bool IsMeshFile(const std::string& path) {
  const std::filesystem::path extension =
      std::filesystem::path(path).extension();
  return extension == ".glb" || extension == ".obj";
}

int Usage(const absl::Status& status) {
  ReportStatus(status);
  return kExitUsage;
}

int PrintEstimate(const v1::StreamSurfaceRequest& request, bool json,
                  Backend* backend, std::stop_token stop) {
  v1::EstimateSurfaceRequest ask;
  *ask.mutable_request() = request;
  const absl::StatusOr<v1::EstimateSurfaceResponse> estimate =
      backend->EstimateSurface(ask, std::move(stop));
  if (!estimate.ok()) return ReportStatus(estimate.status());
  if (json) {
    std::cout << JsonLine(*estimate) << '\n';
    return kExitOk;
  }
  std::cout << fmt::format(
      "{} tiles, {} samples, {} bytes\n"
      "{} samples to generate, about {:.3g} s of one core, {} bytes of "
      "memory\n",
      estimate->tiles(), estimate->samples(), estimate->data_bytes(),
      estimate->generated_samples(), estimate->cpu_seconds(),
      estimate->memory_bytes());
  return kExitOk;
}

absl::StatusOr<std::string> EncodeMesh(const std::string& path,
                                       const core::Mesh& mesh) {
  const core::Scene scene = {{kMaterial}, {{"surface", &mesh, 0}}};
  if (std::filesystem::path(path).extension() == ".obj") {
    return core::EncodeObj(scene, "");
  }
  return core::EncodeGlb(scene);
}

absl::Status WriteMesh(const SurfaceCommand& command,
                       const v1::StreamSurfaceRequest& request,
                       Backend* backend, std::stop_token stop,
                       SurfaceSummary* summary) {
  const absl::StatusOr<SurfaceGrid> grid =
      StreamToGrid(request, backend, std::move(stop));
  if (!grid.ok()) return grid.status();
  const core::Mesh mesh = grid->MakeMesh();
  if (mesh.indices.empty()) {
    return absl::InvalidArgumentError("no sample lies above the hole level");
  }
  const absl::StatusOr<std::string> bytes = EncodeMesh(command.out, mesh);
  if (!bytes.ok()) return bytes.status();
  const absl::Status written =
      WriteFile(command.out, std::as_bytes(std::span(*bytes)));
  if (!written.ok()) return written;
  summary->add_files(command.out);
  summary->set_columns(static_cast<double>(grid->header().columns()));
  summary->set_rows(static_cast<double>(grid->header().rows()));
  summary->set_vertices(static_cast<double>(mesh.positions.size()));
  summary->set_triangles(static_cast<double>(mesh.indices.size() / 3));
  summary->set_left_out_samples(static_cast<double>(grid->left_out_samples()));
  summary->set_recipe_hash(grid->header().recipe_hash());
  summary->set_revision(grid->header().revision());
  return absl::OkStatus();
}

// What the height files know of a stream, in the words of the terrain's.
v1::StreamHeader AsTerrainHeader(const v1::SurfaceHeader& header) {
  v1::StreamHeader terrain;
  terrain.set_recipe_hash(header.recipe_hash());
  terrain.set_revision(header.revision());
  terrain.set_sampling(v1::SAMPLING_POINT);
  terrain.set_encoding(header.encoding());
  *terrain.mutable_window() = header.window();
  *terrain.mutable_frame() = header.frame();
  terrain.set_tile_columns(header.tile_columns());
  terrain.set_tile_rows(header.tile_rows());
  terrain.set_tile_size(header.tile_size());
  return terrain;
}

absl::Status WriteHeights(const SurfaceCommand& command,
                          const v1::StreamSurfaceRequest& request,
                          Backend* backend, std::stop_token stop,
                          TerrainSummary* summary) {
  SinkOptions options;
  if (!command.range.empty()) {
    options.range = HeightRange{command.range[0], command.range[1]};
  }
  TerrainExport files(command.out, TerrainExport::Files::kOne, options);
  absl::Status status = backend->StreamSurface(
      request,
      [&](const v1::SurfaceHeader& header) {
        return files.AddHeader(AsTerrainHeader(header));
      },
      [&](const v1::StreamSurfaceResponse& message) {
        return files.AddTile(message.height_tile());
      },
      std::move(stop));
  if (status.ok()) status = files.Finish();
  *summary = files.Summary();
  return status;
}

template <typename Summary>
int Report(const SurfaceCommand& command, const absl::Status& status,
           const std::string& text, const Summary& summary) {
  if (!status.ok()) return ReportStatus(status);
  std::cout << (command.json ? JsonLine(summary) : text) << '\n';
  return kExitOk;
}

int Generate(const SurfaceCommand& command,
             const v1::StreamSurfaceRequest& request, Backend* backend,
             std::stop_token stop) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                         start)
        .count();
  };
  if (IsMeshFile(command.out)) {
    SurfaceSummary summary;
    const absl::Status status =
        WriteMesh(command, request, backend, std::move(stop), &summary);
    summary.set_seconds(seconds());
    return Report(
        command, status,
        fmt::format("wrote {}\n{:.0f} vertices, {:.0f} triangles, "
                    "{:.0f} samples left out, {:.2f} s",
                    command.out, summary.vertices(), summary.triangles(),
                    summary.left_out_samples(), summary.seconds()),
        summary);
  }
  TerrainSummary summary;
  const absl::Status status =
      WriteHeights(command, request, backend, std::move(stop), &summary);
  summary.set_seconds(seconds());
  summary.set_samples_per_second(summary.samples() / summary.seconds());
  return Report(
      command, status,
      fmt::format("wrote {}\n{:.0f} x {:.0f} samples, heights {:.6g} "
                  "to {:.6g}, {:.2f} s",
                  command.out, summary.width(), summary.height(),
                  summary.minimum(), summary.maximum(), summary.seconds()),
      summary);
}

int Run(const SurfaceCommand& command, std::stop_token stop) {
  if (!command.dry_run && !IsMeshFile(command.out)) {
    const absl::StatusOr<HeightFormat> format = FormatOf(command.out);
    if (!format.ok()) {
      return Usage(absl::InvalidArgumentError(
          "--out: must end in .glb or .obj for a mesh; of heights: " +
          std::string(format.status().message())));
    }
  }
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenSurface> chosen =
      ChooseSurface(command.surface, backend.get(), stop);
  if (!chosen.ok()) return ReportStatus(chosen.status());
  v1::StreamSurfaceRequest request;
  *request.mutable_surface()->mutable_recipe() = chosen->recipe;
  const absl::Status sized = SetSize(command.size, chosen->view, &request);
  if (!sized.ok()) return Usage(sized);
  request.set_uvs(command.uvs);
  request.set_output(command.out.empty() || IsMeshFile(command.out)
                         ? v1::SURFACE_OUTPUT_MESH
                         : v1::SURFACE_OUTPUT_HEIGHTS);
  if (command.dry_run) {
    return PrintEstimate(request, command.json, backend.get(), std::move(stop));
  }
  return Generate(command, request, backend.get(), std::move(stop));
}

void AddSurfaceOptions(CLI::App* app, SurfaceCommand* command) {
  CLI::Option* preset =
      app->add_option("--preset", command->surface.preset,
                      "Preset by name; `terrane presets` lists them")
          ->group("Surface");
  app->add_option("--recipe", command->surface.recipe_file,
                  "Recipe file: a SurfaceRecipe as JSON")
      ->check(CLI::ExistingFile)
      ->excludes(preset)
      ->group("Surface");
  AddNetOptions(app, &command->surface);
  app->add_option("--seed", command->surface.seed,
                  "Other draws of the same kind: any 64-bit number")
      ->group("Surface");
  AddSizeOption(app, &command->size);
}

void AddOutputOptions(CLI::App* app, SurfaceCommand* command) {
  CLI::Option* out =
      app->add_option("--out", command->out, "File to write")->group("Output");
  app->add_flag("--uvs", command->uvs,
                "Meshes: texture coordinates t and u, too")
      ->group("Output");
  app->add_option("--range", command->range,
                  "Heights MIN,MAX of the 16-bit formats (default: the range "
                  "of all that is written)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("MIN,MAX")
      ->group("Output");
  app->add_flag("--json", command->json,
                "Print what was written as JSON on standard output")
      ->group("Output");
  CLI::Option* dry_run = app->add_flag("--dry-run", command->dry_run,
                                       "Only print samples, bytes and cost")
                             ->group("Output");
  app->parse_complete_callback([command, out, dry_run] {
    if (out->count() == 0 && dry_run->count() == 0) {
      throw CLI::RequiredError("--out");
    }
    if (!command->range.empty() && command->range[0] >= command->range[1]) {
      throw CLI::ValidationError(
          fmt::format("--range: MIN must be below MAX, got {},{}",
                      command->range[0], command->range[1]));
    }
  });
}

}  // namespace

void AddSurfaceCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand = app->add_subcommand(
      "surface", "Generate fractal free-form surfaces into files");
  const auto command = std::make_shared<SurfaceCommand>();
  AddSurfaceOptions(subcommand, command.get());
  AddOutputOptions(subcommand, command.get());
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
