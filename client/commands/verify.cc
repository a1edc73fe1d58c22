// `terrane verify`: how well a height file meets spot heights.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "client/commands/command.h"
#include "client/commands/shared_options.h"
#include "client/exit_code.h"
#include "client/placed_raster.h"
#include "client/report.pb.h"
#include "client/spot_file.h"
#include "client/spot_verifier.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane verify met.tif --spots survey.csv
  terrane verify met.tif --spots survey.gpkg --field elevation --tolerance 0.05
  terrane verify tile.r16 --spots survey.csv --json
Without --tolerance every spot that lies on a sample must be its height to the
last bit of a float; with it, no spot may be off by more. Exit codes: 0 met,
1 not met or error, 2 usage, 130 interrupted.)";

struct VerifyCommand {
  std::string file;
  int band = 0;
  SpotFileOptions spots;
  std::optional<double> tolerance;
  bool json = false;
};

bool Passed(const SpotComparison& comparison, std::optional<double> tolerance) {
  return tolerance.has_value() ? comparison.worst() <= *tolerance
                               : comparison.not_nearest == 0;
}

void WriteErrors(const SpotErrors& errors, VerifyErrors* message) {
  message->set_count(static_cast<double>(errors.count()));
  message->set_worst_absolute(errors.worst());
  message->set_mean_absolute(errors.mean_absolute());
  message->set_root_mean_square(errors.root_mean_square());
  message->set_bias(errors.bias());
  if (errors.count() > 0) {
    message->set_worst_row(static_cast<double>(errors.worst_source()));
  }
}

void PrintJson(const VerifyCommand& command, const SpotComparison& comparison) {
  VerifySummary summary;
  summary.set_file(command.file);
  summary.set_spots_file(command.spots.path);
  summary.set_spots(static_cast<double>(
      comparison.compared() + comparison.outside + comparison.nodata));
  WriteErrors(comparison.on_samples, summary.mutable_on_samples());
  WriteErrors(comparison.between_samples, summary.mutable_between_samples());
  WriteErrors(comparison.with_standard_error,
              summary.mutable_with_standard_error());
  summary.set_outside(static_cast<double>(comparison.outside));
  summary.set_nodata(static_cast<double>(comparison.nodata));
  if (command.tolerance.has_value()) summary.set_tolerance(*command.tolerance);
  summary.set_passed(Passed(comparison, command.tolerance));
  std::cout << JsonLine(summary) << '\n';
}

void PrintErrors(const char* what, const SpotErrors& errors,
                 const SpotFile& spots) {
  if (errors.count() == 0) return;
  std::cout << fmt::format(
      "{} {}: worst {:.6g} ({}), mean {:.6g}, RMS {:.6g}, bias {:.6g}\n",
      errors.count(), what, errors.worst(),
      spots.PlaceOf(errors.worst_source()), errors.mean_absolute(),
      errors.root_mean_square(), errors.bias());
}

void PrintText(const VerifyCommand& command, const SpotComparison& comparison,
               const SpotFile& spots) {
  PrintErrors("on a sample", comparison.on_samples, spots);
  PrintErrors("between samples (bilinear)", comparison.between_samples, spots);
  PrintErrors("with a standard error", comparison.with_standard_error, spots);
  if (comparison.outside + comparison.nodata > 0) {
    std::cout << fmt::format("{} outside, {} where there is no data\n",
                             comparison.outside, comparison.nodata);
  }
  const bool passed = Passed(comparison, command.tolerance);
  if (command.tolerance.has_value()) {
    std::cout << fmt::format("{}: the tolerance is {}\n",
                             passed ? "met" : "not met", *command.tolerance);
  } else if (passed) {
    std::cout << "met: every spot on a sample, to the last bit of a float\n";
  } else {
    std::cout << fmt::format(
        "not met: {} of {} on a sample are not the nearest float\n",
        comparison.not_nearest, comparison.on_samples.count());
  }
}

// A verdict needs something to judge.
absl::Status CheckJudged(const VerifyCommand& command,
                         const SpotComparison& comparison) {
  if (comparison.compared() == 0) {
    return absl::InvalidArgumentError(fmt::format(
        "nothing to judge: {} spots are outside of {}, {} where it has no data",
        comparison.outside, command.file, comparison.nodata));
  }
  if (!command.tolerance.has_value() && comparison.on_samples.count() == 0) {
    return absl::InvalidArgumentError(
        "nothing to judge: no spot lies on a sample, and --tolerance is not "
        "set");
  }
  return absl::OkStatus();
}

int Run(const VerifyCommand& command) {
  ReadOptions read;
  read.band = command.band;
  const absl::StatusOr<PlacedRaster> heights = ReadHeights(command.file, read);
  if (!heights.ok()) return ReportStatus(heights.status());
  absl::StatusOr<SpotFile> spots = ReadSpotFile(command.spots, 2);
  if (!spots.ok()) return ReportStatus(spots.status());
  const absl::Status placed = TransformSpots(heights->crs, &*spots);
  if (!placed.ok()) return ReportStatus(placed);

  const SpotComparison comparison = CompareSpots(*heights, *spots);
  const absl::Status judged = CheckJudged(command, comparison);
  if (!judged.ok()) return ReportStatus(judged);
  if (command.json) {
    PrintJson(command, comparison);
  } else {
    PrintText(command, comparison, *spots);
  }
  return Passed(comparison, command.tolerance) ? kExitOk : kExitError;
}

}  // namespace

void AddVerifyCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("verify", "Compare a height file with spot heights");
  const auto command = std::make_shared<VerifyCommand>();
  subcommand
      ->add_option("file", command->file,
                   "Raster, .r16 or .f32 with the heights")
      ->check(CLI::ExistingFile)
      ->required();
  subcommand->add_option("--band", command->band, "Band of the raster, from 1")
      ->check(CLI::Range(1, 65535));
  CLI::Option* spots =
      subcommand
          ->add_option("--spots", command->spots.path,
                       "Spot heights: a CSV with a header (x,y,z), or a vector "
                       "file that GDAL reads")
          ->check(CLI::ExistingFile)
          ->required()
          ->group("Spot heights");
  AddSpotFileOptions(subcommand, spots, &command->spots);
  subcommand
      ->add_option("--tolerance", command->tolerance,
                   "Largest error that passes, in height units (default: exact "
                   "on samples)")
      ->check(NotNegative());
  subcommand->add_flag("--json", command->json, "Print JSON");
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token) { return Run(*command); };
  });
}

}  // namespace terrane::client
