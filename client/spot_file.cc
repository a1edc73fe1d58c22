#include "client/spot_file.h"

#include <ogr_spatialref.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "client/csv.h"
#include "client/gdal_support.h"

namespace terrane::client {
namespace {

absl::StatusOr<SpotFile> ReadCsvSpots(const SpotFileOptions& options,
                                      int dimensions) {
  std::ifstream file(options.path);
  if (!file) return absl::NotFoundError("cannot read " + options.path);
  const CsvColumn height{{options.field.empty() ? "z" : options.field}};
  const CsvColumn error =
      options.error_field.empty()
          ? CsvColumn{{"standard_error", "se"}, /*required=*/false}
          : CsvColumn{{options.error_field}};
  absl::StatusOr<CsvTable> table = ReadCsvColumns(
      &file, options.path, {{{"x"}}, {{"y"}, dimensions > 1}, height, error});
  if (!table.ok()) return table.status();
  SpotFile spots;
  spots.path = options.path;
  spots.table = {std::move(table->columns[0]), std::move(table->columns[1]),
                 std::move(table->columns[2]), std::move(table->columns[3]),
                 std::move(table->lines)};
  spots.table.y.resize(spots.table.rows());
  return spots;
}

// A reference system in the order x east, y north, without its heights.
absl::Status ReadCrs(const std::string& text, OGRSpatialReference* crs) {
  const GdalErrorScope errors;
  if (crs->SetFromUserInput(text.c_str()) != OGRERR_NONE) {
    return errors.Error("the CRS " + text.substr(0, 60) + " is not understood");
  }
  crs->StripVertical();
  crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return absl::OkStatus();
}

using Transformation =
    std::unique_ptr<OGRCoordinateTransformation,
                    decltype(&OGRCoordinateTransformation::DestroyCT)>;

absl::StatusOr<Transformation> MakeTransformation(const std::string& from,
                                                  const std::string& to) {
  Transformation none(nullptr, OGRCoordinateTransformation::DestroyCT);
  OGRSpatialReference source;
  OGRSpatialReference target;
  absl::Status status = ReadCrs(from, &source);
  if (status.ok()) status = ReadCrs(to, &target);
  if (!status.ok()) return status;
  if (source.IsSame(&target) != 0) return none;
  const GdalErrorScope errors;
  Transformation made(OGRCreateCoordinateTransformation(&source, &target),
                      OGRCoordinateTransformation::DestroyCT);
  if (made == nullptr) return errors.Error("there is no way between the CRSs");
  return made;
}

// The index of the first point that has no place in the target; all have one
// when it is x->size().
std::size_t Transform(OGRCoordinateTransformation* transformation,
                      std::vector<double>* x, std::vector<double>* y) {
  const GdalErrorScope quiet;
  std::vector<int> good(x->size());
  transformation->Transform(static_cast<int>(x->size()), x->data(), y->data(),
                            nullptr, good.data());
  return static_cast<std::size_t>(std::find(good.begin(), good.end(), 0) -
                                  good.begin());
}

}  // namespace

std::string SpotFile::PlaceOf(std::int64_t source) const {
  return path + " " + source_word + " " + std::to_string(source);
}

absl::StatusOr<SpotFile> ReadSpotFile(const SpotFileOptions& options,
                                      int dimensions) {
  const std::string extension = std::filesystem::path(options.path).extension();
  absl::StatusOr<SpotFile> spots = extension == ".csv" || extension == ".CSV"
                                       ? ReadCsvSpots(options, dimensions)
                                       : ReadSpotLayer(options);
  if (spots.ok() && !options.crs.empty()) spots->crs = options.crs;
  return spots;
}

absl::Status TransformSpots(const std::string& target_crs, SpotFile* spots) {
  if (spots->crs.empty() || target_crs.empty()) return absl::OkStatus();
  const absl::StatusOr<Transformation> transformation =
      MakeTransformation(spots->crs, target_crs);
  if (!transformation.ok()) return transformation.status();
  if (*transformation == nullptr) return absl::OkStatus();
  const auto no_place = [&](std::int64_t source) {
    return absl::InvalidArgumentError(spots->PlaceOf(source) +
                                      ": has no place in the terrain's CRS");
  };
  SpotTable& table = spots->table;
  const std::size_t bad = Transform(transformation->get(), &table.x, &table.y);
  if (bad < table.rows()) return no_place(table.source[bad]);
  for (SpotPolyline& line : spots->lines) {
    if (Transform(transformation->get(), &line.x, &line.y) < line.x.size()) {
      return no_place(line.source);
    }
  }
  return absl::OkStatus();
}

}  // namespace terrane::client
