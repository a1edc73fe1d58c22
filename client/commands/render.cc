// `terrane render`: pictures of height files, profiles and presets, as PNG.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>

#include "client/chosen_spots.h"
#include "client/commands/command.h"
#include "client/commands/flower_options.h"
#include "client/commands/render_command.h"
#include "client/commands/render_subject.h"
#include "client/commands/render_traced.h"
#include "client/commands/shared_options.h"
#include "client/csv.h"
#include "client/exit_code.h"
#include "client/memory_stream.h"
#include "client/output_file.h"
#include "client/placed_raster.h"
#include "client/render/perspective.h"
#include "client/render/plot.h"
#include "client/render/relief.h"
#include "client/render/side_by_side.h"
#include "core/codec/image_codec.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane render finer.tif --out relief.png
  terrane render finer.tif --style perspective --water-level 300 --out block.png
  terrane render profile.csv --out plot.png
  terrane render --preset fbm/fig06b --out fig06b.png
  terrane render --side-by-side model.tif finer.tif --out both.png
  terrane render --preset demo/alps --style traced --out alps.png
  terrane render --preset flower/rose --stage 0.6 --out rose.png
A preset brings its own style, level, water and marks; options override them.)";

// What is drawn pixel by pixel in memory.
constexpr std::int64_t kMaxSamples = std::int64_t{1} << 27;

core::Light LightOf(const RenderCommand& command, const core::Light& usual) {
  if (command.light.empty()) return usual;
  const double azimuth = command.light[0] * std::numbers::pi / 180;
  const double altitude = command.light[1] * std::numbers::pi / 180;
  return {std::sin(azimuth) * std::cos(altitude),
          std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
}

absl::Status WritePicture(const std::string& path, const Picture& picture) {
  const absl::StatusOr<core::EncodedImage> bytes = core::EncodePng(picture);
  if (!bytes.ok()) return bytes.status();
  return WriteFile(path, std::as_bytes(std::span(*bytes)));
}

core::HeightView ViewOf(const core::Raster& raster) {
  return {raster.width, raster.height, raster.values};
}

// Pixels that are squares on the ground, or as wide as asked for.
Picture WithSquarePixels(Picture picture, const core::GroundSpacing& spacing,
                         std::optional<int> width) {
  const double pixel = std::max(spacing.x, spacing.y);
  const int natural = std::max(
      static_cast<int>(std::lround(picture.width * spacing.x / pixel)), 1);
  const int chosen = width.value_or(natural);
  const int height =
      std::max(static_cast<int>(std::lround(picture.height * spacing.y / pixel *
                                            chosen / natural)),
               1);
  if (chosen == picture.width && height == picture.height) return picture;
  return Resized(picture, chosen, height);
}

absl::StatusOr<Picture> DrawRaster(const RenderCommand& command,
                                   v1::RenderStyle style, PlacedRaster placed) {
  PutNorthUp(&placed);
  const absl::StatusOr<core::GroundScale> scale = GroundScaleOf(placed);
  if (!scale.ok()) return scale.status();
  const core::HeightView view = ViewOf(placed.raster);
  if (style == v1::RENDER_STYLE_PERSPECTIVE) {
    PerspectiveOptions options;
    options.width = command.width.value_or(options.width);
    options.turn_deg = command.turn_deg;
    options.tilt_deg = command.tilt_deg;
    options.exaggeration = command.exaggeration;
    options.light = LightOf(command, options.light);
    options.water_level = command.water_level;
    PerspectivePicture result = RenderPerspective(view, *scale, options);
    std::cerr << fmt::format("terrane: heights are drawn {:.3g} times\n",
                             result.exaggeration);
    return std::move(result.picture);
  }
  ReliefOptions options;
  options.style = style == v1::RENDER_STYLE_HILLSHADE ? ReliefStyle::kHillshade
                  : style == v1::RENDER_STYLE_GREY    ? ReliefStyle::kGrey
                                                      : ReliefStyle::kRelief;
  options.light = LightOf(command, options.light);
  options.exaggeration = command.exaggeration.value_or(1);
  options.water_level = command.water_level;
  return WithSquarePixels(RenderRelief(view, *scale, options),
                          scale->Row(placed.raster.height / 2), command.width);
}

absl::StatusOr<Picture> DrawProfile(const RenderCommand& command,
                                    const std::vector<Series>& series) {
  PlotOptions options;
  options.width = command.width.value_or(options.width);
  options.title = command.title;
  options.x_label = "x";
  options.y_label = "height";
  options.marks = command.marks;
  options.water_level = command.water_level;
  return RenderPlot(series, options);
}

constexpr Rgb kMacroLine{0.62, 0.66, 0.72};
constexpr Rgb kHeightLine{0.13, 0.32, 0.55};

absl::StatusOr<Picture> DrawCsv(const RenderCommand& command) {
  std::ifstream file(command.input);
  if (!file) return absl::NotFoundError("cannot read " + command.input);
  const auto table = ReadCsv(&file, command.input, 2);
  if (!table.ok()) return table.status();
  std::vector<Series> series;
  if (table->size() > 2) {
    series.push_back({"macro shape", (*table)[0], (*table)[2], kMacroLine, 2});
  }
  series.push_back({"height", (*table)[0], (*table)[1], kHeightLine, 1.6});
  return DrawProfile(command, series);
}

absl::StatusOr<Picture> DrawFile(const RenderCommand& command) {
  if (std::filesystem::path(command.input).extension() == ".csv") {
    return DrawCsv(command);
  }
  ReadOptions read;
  read.band = command.band;
  read.max_samples = kMaxSamples;
  absl::StatusOr<PlacedRaster> placed = ReadHeights(command.input, read);
  if (!placed.ok()) return placed.status();
  return DrawRaster(command, command.style.value_or(v1::RENDER_STYLE_RELIEF),
                    *std::move(placed));
}

absl::StatusOr<Picture> DrawGeneratedProfile(const RenderCommand& command,
                                             const ChosenTerrain& terrain,
                                             int level, Backend* backend,
                                             std::stop_token stop) {
  v1::GetProfileRequest request;
  *request.mutable_terrain() = terrain.choice;
  request.set_level(level);
  if (terrain.view.has_window() && level == terrain.view.level()) {
    request.set_first(terrain.view.window().x());
    request.set_count(terrain.view.window().width());
  }
  const absl::StatusOr<v1::GetProfileResponse> profile =
      backend->GetProfile(request, stop);
  if (!profile.ok()) return profile.status();
  Series height{"height", {}, {}, kHeightLine, 1.6};
  Series macro{"macro shape", {}, {}, kMacroLine, 2};
  for (int i = 0; i < profile->heights_size(); ++i) {
    height.x.push_back(profile->first_x() + i * profile->step_x());
    height.y.push_back(profile->heights(i));
    macro.y.push_back(profile->macro_heights(i));
  }
  macro.x = height.x;
  return DrawProfile(command, {macro, height});
}

constexpr Rgb kSpot{0.85, 0.20, 0.15};
constexpr Rgb kSpotRim{1, 1, 1};
constexpr Rgb kSpotLine{0.12, 0.30, 0.62};

// The points and lines of the spot heights over a map of the samples in
// `frame`.
Picture WithSpots(const Picture& map, const core::Frame& frame,
                  double pixels_per_sample_x, double pixels_per_sample_y,
                  const ChosenTerrain& terrain) {
  Canvas canvas(map.width, map.height, kSpotRim);
  canvas.Paste(map, 0, 0);
  const auto pixel = [&](double x, double y) -> PixelPoint {
    return {
        ((x - frame.origin_x) / frame.spacing_x + 0.5) * pixels_per_sample_x,
        ((y - frame.origin_y) / frame.spacing_y + 0.5) * pixels_per_sample_y};
  };
  for (const v1::SpotLine& line : terrain.recipe.spots().lines()) {
    for (int i = 1; i < line.vertices_size(); ++i) {
      const v1::Point& from = line.vertices(i - 1);
      const v1::Point& to = line.vertices(i);
      canvas.DrawLine(pixel(from.x(), from.y()), pixel(to.x(), to.y()), 1.6,
                      kSpotLine);
    }
  }
  const auto draw_point = [&](double x, double y) {
    const PixelPoint at = pixel(x, y);
    canvas.DrawLine(at, at, 8, kSpotRim);
    canvas.DrawLine(at, at, 5, kSpot);
  };
  for (const v1::SpotHeight& point : terrain.recipe.spots().points()) {
    draw_point(point.x(), point.y());
  }
  if (terrain.spots != nullptr) {
    const SpotTable& table = terrain.spots->table;
    for (std::size_t i = 0; i < table.rows(); ++i) {
      draw_point(table.x[i], table.y[i]);
    }
  }
  return canvas.picture();
}

absl::StatusOr<Picture> DrawGeneratedField(const RenderCommand& command,
                                           const ChosenTerrain& terrain,
                                           int level, Backend* backend,
                                           std::stop_token stop) {
  v1::StreamTilesRequest request;
  *request.mutable_terrain() = terrain.choice;
  request.set_level(level);
  request.set_sampling(command.extent.sampling);
  const std::optional<v1::Window> window =
      WindowToDraw(command, terrain, level);
  if (window.has_value()) *request.mutable_window() = *window;
  absl::StatusOr<PlacedRaster> placed =
      StreamToMemory(request, kMaxSamples, backend, stop);
  if (!placed.ok()) return placed.status();
  if (!command.show_spots) {
    return DrawRaster(command, *command.style, *std::move(placed));
  }
  if (command.style == v1::RENDER_STYLE_PERSPECTIVE) {
    return absl::InvalidArgumentError(
        "--show-spots: must be a map from above, got --style perspective");
  }
  PutNorthUp(&*placed);
  const absl::StatusOr<Picture> map =
      DrawRaster(command, *command.style, *placed);
  if (!map.ok()) return map.status();
  const core::Raster& raster = placed->raster;
  return WithSpots(*map, raster.frame,
                   map->width / static_cast<double>(raster.width),
                   map->height / static_cast<double>(raster.height), terrain);
}

absl::StatusOr<Picture> DrawGenerated(const RenderCommand& command,
                                      std::stop_token stop) {
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  const absl::StatusOr<ChosenTerrain> terrain =
      ChooseTerrain(command.terrain, command.extent.level, backend.get(), stop);
  if (!terrain.ok()) return terrain.status();
  const absl::StatusOr<std::optional<v1::SpotReport>> spots =
      PrepareSpots(*terrain, ProgressMode::kAuto, backend.get(), stop);
  if (!spots.ok()) return spots.status();
  PrintSpotReport(*spots, *terrain);
  const RenderCommand viewed = WithView(command, *terrain);
  const int level = terrain->level;
  return terrain->recipe.dimensions() == 1
             ? DrawGeneratedProfile(viewed, *terrain, level, backend.get(),
                                    stop)
             : DrawGeneratedField(viewed, *terrain, level, backend.get(), stop);
}

absl::StatusOr<Picture> DrawSurfacePicture(const RenderCommand& command,
                                           std::stop_token stop) {
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  SurfaceViewOptions options;
  options.width = command.width.value_or(options.width);
  options.turn_deg = command.turn_deg;
  options.tilt_deg = command.tilt_deg;
  options.exaggeration = command.exaggeration.value_or(1);
  options.light = LightOf(command, options.light);
  return DrawSurface(SurfaceOptionsOf(command), command.size,
                     command.control_net, options, backend.get(),
                     std::move(stop));
}

std::string CaptionOf(const std::string& path, const PlacedRaster& placed,
                      const core::GroundScale& scale) {
  const core::GroundSpacing& spacing = scale.Row(placed.raster.height / 2);
  return fmt::format("{}   {} x {} samples of {:.1f} x {:.1f} m",
                     std::filesystem::path(path).filename().string(),
                     placed.raster.width, placed.raster.height, spacing.x,
                     spacing.y);
}

absl::StatusOr<Picture> DrawSideBySide(const RenderCommand& command) {
  std::vector<PlacedRaster> placed;
  std::vector<core::GroundScale> scales;
  for (const std::string& path : command.side_by_side) {
    ReadOptions read;
    read.band = command.band;
    read.max_samples = kMaxSamples;
    absl::StatusOr<PlacedRaster> one = ReadHeights(path, read);
    if (!one.ok()) return one.status();
    PutNorthUp(&*one);
    const absl::StatusOr<core::GroundScale> scale = GroundScaleOf(*one);
    if (!scale.ok()) return scale.status();
    placed.push_back(*std::move(one));
    scales.push_back(*scale);
  }
  SideBySideOptions options;
  options.panel_width = command.width.value_or(options.panel_width);
  options.light = LightOf(command, options.light);
  options.exaggeration = command.exaggeration.value_or(1);
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    panels.push_back(
        {ViewOf(placed[i].raster), &scales[i],
         CaptionOf(command.side_by_side[i], placed[i], scales[i])});
  }
  return RenderSideBySide(panels, options);
}

int Run(const RenderCommand& command, std::stop_token stop) {
  if (IsTraced(command)) {
    return ReportStatus(WriteTraced(command, std::move(stop)));
  }
  if (!command.out.ends_with(".png")) {
    return ReportStatus(absl::InvalidArgumentError(
        "--out: must end in .png unless traced, got \"" + command.out + "\""));
  }
  if (!Canvas::HasFont()) {
    std::cerr << "terrane: font DejaVuSans not found (package "
                 "fonts-dejavu-core): pictures have no text\n";
  }
  const absl::StatusOr<Picture> picture =
      !command.side_by_side.empty() ? DrawSideBySide(command)
      : !command.input.empty()      ? DrawFile(command)
      : IsSurface(command)          ? DrawSurfacePicture(command, stop)
                                    : DrawGenerated(command, stop);
  if (!picture.ok()) return ReportStatus(picture.status());
  return ReportStatus(WritePicture(command.out, *picture));
}

}  // namespace

void AddRenderCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("render", "Draw heights as a PNG picture");
  const auto command = std::make_shared<RenderCommand>();
  CLI::Option* input =
      subcommand
          ->add_option("input", command->input,
                       "Raster, .r16, .f32 or profile .csv to draw")
          ->check(CLI::ExistingFile);
  subcommand
      ->add_option(
          "--side-by-side", command->side_by_side,
          "Two to four elevation models: hillshades at the same ground "
          "scale")
      ->check(CLI::ExistingFile)
      ->expected(2, 4)
      ->excludes(input);
  subcommand->add_option("--band", command->band, "Band of the raster, from 1")
      ->check(CLI::Range(1, 65535));
  AddPictureOptions(subcommand, command.get());
  AddRecipeOptions(subcommand, &command->terrain);
  AddExtentOptions(subcommand, &command->extent);
  AddNetOptions(subcommand, &command->surface);
  AddSizeOption(subcommand, &command->size);
  AddTracedOptions(subcommand, &command->traced);
  AddGrowthOptions(subcommand, "--petal-method", &command->flower);
  subcommand
      ->add_flag("--control-net", command->control_net,
                 "Draw the control polyhedron of a surface, too")
      ->group("Surface");
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->footer(kFooter);
  subcommand->final_callback([command, subcommand, action] {
    const absl::Status heeded = CheckOptionsAreHeeded(*subcommand, *command);
    if (!heeded.ok()) throw CLI::ValidationError(std::string(heeded.message()));
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
