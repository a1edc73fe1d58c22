#include "server/actor/raster_upload.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/grid/height_codec.h"
#include "core/terrain/spec_checks.h"
#include "server/actor/upload_values.h"
#include "server/convert/content_hash.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

using core::ViolationError;

// What a raster's id starts from (proto/terrane/v1/raster.proto).
void HashHeader(const v1::RasterHeader& header, const core::Frame& frame,
                ContentHash* hash) {
  hash->Add(std::string_view("terrane.raster.v1\0", 18));
  hash->AddNumber(static_cast<std::uint64_t>(header.width()));
  hash->AddNumber(static_cast<std::uint64_t>(header.height()));
  hash->AddNumber(frame.origin_x);
  hash->AddNumber(frame.origin_y);
  hash->AddNumber(frame.spacing_x);
  hash->AddNumber(frame.spacing_y);
  hash->AddNumber(static_cast<std::uint8_t>(header.has_nodata() ? 1 : 0));
  hash->AddNumber(header.has_nodata() ? header.nodata() : 0.0F);
}

class RasterUploadImpl : public RasterUpload {
 public:
  RasterUploadImpl(const Limits& limits, RasterStore* store)
      : limits_(limits), store_(store) {}

  absl::Status Add(const v1::UploadRasterRequest& part) override;
  absl::StatusOr<v1::UploadRasterResponse> Finish() override;

 private:
  absl::Status Begin(const v1::UploadRasterRequest& first);
  // Turns the header's nodata value into NaN; finite samples only otherwise.
  absl::Status CleanSamples();
  StoredRaster Describe(const std::string& raster_id);

  const Limits& limits_;
  RasterStore* const store_;
  bool begun_ = false;
  v1::RasterHeader header_;
  std::string expected_id_;
  ContentHash hash_;
  Reservation reservation_;
  std::optional<UploadValues<float>> values_;
  std::shared_ptr<core::Raster> raster_;
};

absl::Status RasterUploadImpl::Add(const v1::UploadRasterRequest& part) {
  if (!begun_) return Begin(part);
  if (part.part_case() != v1::UploadRasterRequest::kChunk) {
    return ViolationError("chunk", "must be set after the first message");
  }
  hash_.Add(part.chunk());
  return values_->Add(part.chunk());
}

absl::Status RasterUploadImpl::Begin(const v1::UploadRasterRequest& first) {
  if (!first.has_header()) {
    return ViolationError("header", "must be set in the first message");
  }
  header_ = first.header();
  expected_id_ = first.expected_raster_id();
  core::Violations violations;
  const std::string prefix = "header.";
  const core::Path root(&prefix);
  core::SpecChecks checks(limits_.recipe, 2, &violations);
  constexpr std::int64_t kMaxSide = std::int64_t{1} << 20;
  const bool width_good =
      checks.Integer(root.Field("width"), header_.width(), 2, kMaxSide);
  const bool height_good =
      checks.Integer(root.Field("height"), header_.height(), 2, kMaxSide);
  if (width_good && height_good &&
      header_.width() * header_.height() > limits_.max_raster_samples) {
    violations.Add("header",
                   "must have at most " +
                       std::to_string(limits_.max_raster_samples) +
                       " samples, got " +
                       std::to_string(header_.width() * header_.height()));
  }
  const core::Path frame_path = root.Field("frame");
  const core::Frame frame = ReadFrame(header_.frame(), frame_path, &violations);
  core::ValidateFrame(frame_path, frame, &checks);
  if (!violations.empty()) return violations.ToStatus();

  const auto samples =
      static_cast<std::size_t>(header_.width() * header_.height());
  absl::StatusOr<Reservation> reservation = store_->Reserve(
      "the raster", static_cast<std::int64_t>(samples * sizeof(float)));
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  WriteFrame(frame, header_.frame().crs(), header_.mutable_frame());
  HashHeader(header_, frame, &hash_);
  values_.emplace("raster", samples);
  raster_ = std::make_shared<core::Raster>();
  raster_->width = header_.width();
  raster_->height = header_.height();
  raster_->frame = frame;
  begun_ = true;
  return absl::OkStatus();
}

absl::Status RasterUploadImpl::CleanSamples() {
  const bool has_nodata = header_.has_nodata();
  const float nodata = header_.nodata();
  for (std::size_t i = 0; i < raster_->values.size(); ++i) {
    float& value = raster_->values[i];
    if (has_nodata && value == nodata) {
      value = std::numeric_limits<float>::quiet_NaN();
    }
    if (std::isinf(value)) {
      return ViolationError(
          "chunk",
          "must hold finite samples, NaN or the nodata value, got "
          "infinity at sample " +
              std::to_string(i));
    }
  }
  return absl::OkStatus();
}

StoredRaster RasterUploadImpl::Describe(const std::string& raster_id) {
  const core::HeightStats stats = core::MeasureHeights(raster_->values);
  StoredRaster stored;
  stored.raster = raster_;
  stored.description.set_raster_id(raster_id);
  *stored.description.mutable_header() = header_;
  stored.description.mutable_range()->set_minimum(stats.minimum);
  stored.description.mutable_range()->set_maximum(stats.maximum);
  stored.description.set_nodata_samples(stats.nodata_samples);
  return stored;
}

absl::StatusOr<v1::UploadRasterResponse> RasterUploadImpl::Finish() {
  if (!begun_) return ViolationError("header", "must be sent, got nothing");
  if (const absl::Status all = values_->CheckEnd(); !all.ok()) return all;
  const std::string raster_id = hash_.Finish();
  if (!expected_id_.empty() && expected_id_ != raster_id) {
    return ViolationError(
        "expected_raster_id",
        "must be that of the content, " + raster_id + ", got " + expected_id_);
  }
  raster_->values = values_->Take();
  if (const absl::Status clean = CleanSamples(); !clean.ok()) return clean;
  v1::UploadRasterResponse response;
  response.set_raster_id(raster_id);
  response.set_already_present(
      store_->Insert(raster_id, Describe(raster_id), RasterBytes(*raster_)));
  return response;
}

}  // namespace

std::unique_ptr<RasterUpload> MakeRasterUpload(const Limits& limits,
                                               RasterStore* store) {
  return std::make_unique<RasterUploadImpl>(limits, store);
}

}  // namespace terrane::server
