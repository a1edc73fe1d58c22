// The vector half of spot_file.h: a layer that GDAL reads.
#include <ogrsf_frmts.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "client/gdal_support.h"
#include "client/spot_file.h"

namespace terrane::client {
namespace {

absl::StatusOr<OGRLayer*> ChooseLayer(const std::string& path,
                                      const std::string& name,
                                      GDALDataset& dataset) {
  std::string names;
  for (OGRLayer* layer : dataset.GetLayers()) {
    if (layer->GetName() == name) return layer;
    names += names.empty() ? "" : ", ";
    names += layer->GetName();
  }
  if (!name.empty()) {
    return absl::InvalidArgumentError(path + " has no layer " + name +
                                      "; its layers are " + names);
  }
  if (dataset.GetLayerCount() != 1) {
    return absl::InvalidArgumentError(
        path +
        " must have one layer, or --spots-layer must name one; its "
        "layers are " +
        names);
  }
  return dataset.GetLayer(0);
}

// The index of a field of numbers; nothing when no name was given.
absl::StatusOr<std::optional<int>> FindField(const std::string& path,
                                             const std::string& name,
                                             OGRLayer& layer) {
  if (name.empty()) return std::nullopt;
  const OGRFeatureDefn& fields = *layer.GetLayerDefn();
  const int index = fields.GetFieldIndex(name.c_str());
  if (index < 0) {
    std::string names;
    for (int i = 0; i < fields.GetFieldCount(); ++i) {
      names += names.empty() ? "" : ", ";
      names += fields.GetFieldDefn(i)->GetNameRef();
    }
    return absl::InvalidArgumentError(path + " has no field " + name +
                                      "; its fields are " +
                                      (names.empty() ? "none" : names));
  }
  const OGRFieldType type = fields.GetFieldDefn(index)->GetType();
  if (type != OFTReal && type != OFTInteger && type != OFTInteger64) {
    return absl::InvalidArgumentError(path + ": the field " + name +
                                      " does not hold numbers");
  }
  return index;
}

std::string WktOf(const OGRSpatialReference* crs) {
  if (crs == nullptr) return "";
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  std::string result;
  if (crs->exportToWkt(&text, options) == OGRERR_NONE) result = text;
  CPLFree(text);
  return result;
}

// Turns features into spots.
class LayerReader {
 public:
  LayerReader(std::optional<int> height_field, std::optional<int> error_field,
              SpotFile* spots)
      : height_field_(height_field), error_field_(error_field), spots_(spots) {}

  absl::Status Add(OGRFeature& feature);

 private:
  absl::Status AddGeometry(OGRGeometry& geometry);
  absl::Status AddPoint(const OGRPoint& point);
  absl::Status AddLine(const OGRLineString& line);
  // Into `value`, of the feature in hand.
  absl::Status ReadField(OGRFeature& feature, std::optional<int> field,
                         double* value) const;
  absl::Status Error(const std::string& what) const {
    return absl::InvalidArgumentError(spots_->PlaceOf(feature_id_) + ": " +
                                      what);
  }
  absl::Status CheckVertex(const OGRPoint& point, double height) const {
    if (std::isfinite(point.getX()) && std::isfinite(point.getY()) &&
        std::isfinite(height)) {
      return absl::OkStatus();
    }
    return Error("must have finite coordinates and a finite height");
  }
  double HeightOf(const OGRPoint& point) const {
    return height_field_.has_value() ? field_height_ : point.getZ();
  }

  const std::optional<int> height_field_;
  const std::optional<int> error_field_;
  SpotFile* const spots_;
  // Of the feature in hand.
  std::int64_t feature_id_ = 0;
  double field_height_ = 0;
  double standard_error_ = 0;
};

absl::Status LayerReader::ReadField(OGRFeature& feature,
                                    std::optional<int> field,
                                    double* value) const {
  if (!field.has_value()) return absl::OkStatus();
  if (feature.IsFieldSetAndNotNull(*field) == 0) {
    return Error(std::string("has no value of the field ") +
                 feature.GetFieldDefnRef(*field)->GetNameRef());
  }
  *value = feature.GetFieldAsDouble(*field);
  return absl::OkStatus();
}

absl::Status LayerReader::Add(OGRFeature& feature) {
  feature_id_ = feature.GetFID();
  absl::Status status = ReadField(feature, height_field_, &field_height_);
  if (status.ok()) status = ReadField(feature, error_field_, &standard_error_);
  if (!status.ok()) return status;
  OGRGeometry* geometry = feature.GetGeometryRef();
  if (geometry == nullptr || geometry->IsEmpty()) {
    return Error("has no geometry");
  }
  if (!height_field_.has_value() && geometry->Is3D() == 0) {
    return Error("has no Z; name the field of the heights with --field");
  }
  return AddGeometry(*geometry);
}

absl::Status LayerReader::AddGeometry(OGRGeometry& geometry) {
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPoint:
      return AddPoint(*geometry.toPoint());
    case wkbLineString:
      return AddLine(*geometry.toLineString());
    case wkbMultiPoint:
    case wkbMultiLineString:
    case wkbGeometryCollection:
      for (OGRGeometry* part : *geometry.toGeometryCollection()) {
        const absl::Status status = AddGeometry(*part);
        if (!status.ok()) return status;
      }
      return absl::OkStatus();
    default:
      return Error(std::string("is a ") + geometry.getGeometryName() +
                   "; spots are points and lines");
  }
}

absl::Status LayerReader::AddPoint(const OGRPoint& point) {
  const double height = HeightOf(point);
  const absl::Status status = CheckVertex(point, height);
  if (!status.ok()) return status;
  SpotTable& table = spots_->table;
  table.x.push_back(point.getX());
  table.y.push_back(point.getY());
  table.height.push_back(height);
  if (error_field_.has_value()) {
    table.standard_error.push_back(standard_error_);
  }
  table.source.push_back(feature_id_);
  return absl::OkStatus();
}

absl::Status LayerReader::AddLine(const OGRLineString& line) {
  SpotPolyline result;
  result.standard_error = standard_error_;
  result.source = feature_id_;
  for (const OGRPoint& vertex : line) {
    const double height = HeightOf(vertex);
    const absl::Status status = CheckVertex(vertex, height);
    if (!status.ok()) return status;
    result.x.push_back(vertex.getX());
    result.y.push_back(vertex.getY());
    result.height.push_back(height);
  }
  spots_->lines.push_back(std::move(result));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<SpotFile> ReadSpotLayer(const SpotFileOptions& options) {
  RegisterGdal();
  std::error_code ignored;
  if (!std::filesystem::exists(options.path, ignored)) {
    return absl::NotFoundError("cannot read " + options.path +
                               ": no such file");
  }
  GdalErrorScope errors;
  const DatasetPtr dataset(
      GDALDataset::Open(options.path.c_str(), GDAL_OF_VECTOR));
  if (dataset == nullptr) return errors.Error("cannot read " + options.path);
  const auto layer = ChooseLayer(options.path, options.layer, *dataset);
  if (!layer.ok()) return layer.status();
  const auto height = FindField(options.path, options.field, **layer);
  if (!height.ok()) return height.status();
  const auto error = FindField(options.path, options.error_field, **layer);
  if (!error.ok()) return error.status();

  SpotFile spots;
  spots.path = options.path;
  spots.source_word = "feature";
  spots.crs = WktOf((*layer)->GetSpatialRef());
  LayerReader reader(*height, *error, &spots);
  for (const auto& feature : **layer) {
    const absl::Status status = reader.Add(*feature);
    if (!status.ok()) return status;
  }
  if (errors.failed()) return errors.Error("cannot read " + options.path);
  if (spots.table.rows() == 0 && spots.lines.empty()) {
    return absl::InvalidArgumentError(options.path + " has no features");
  }
  return spots;
}

}  // namespace terrane::client
