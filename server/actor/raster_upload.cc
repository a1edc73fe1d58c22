#include "server/actor/raster_upload.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/grid/height_codec.h"
#include "core/terrain/spec_checks.h"
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
  absl::Status AddChunk(const std::string& chunk);
  // Turns the header's nodata value into NaN; finite samples only otherwise.
  absl::Status CleanSamples();
  StoredRaster Describe(const std::string& raster_id);

  std::size_t wanted_bytes() const {
    return static_cast<std::size_t>(header_.width() * header_.height()) *
           sizeof(float);
  }

  const Limits& limits_;
  RasterStore* const store_;
  bool begun_ = false;
  v1::RasterHeader header_;
  std::string expected_id_;
  ContentHash hash_;
  RasterStore::Reservation reservation_;
  std::shared_ptr<core::Raster> raster_;
  std::size_t received_bytes_ = 0;
};

absl::Status RasterUploadImpl::Add(const v1::UploadRasterRequest& part) {
  if (!begun_) return Begin(part);
  if (part.part_case() != v1::UploadRasterRequest::kChunk) {
    return ViolationError("chunk", "must be set after the first message");
  }
  return AddChunk(part.chunk());
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

  absl::StatusOr<RasterStore::Reservation> reservation =
      store_->Reserve(static_cast<std::int64_t>(wanted_bytes()));
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  WriteFrame(frame, header_.frame().crs(), header_.mutable_frame());
  HashHeader(header_, frame, &hash_);
  raster_ = std::make_shared<core::Raster>();
  raster_->width = header_.width();
  raster_->height = header_.height();
  raster_->frame = frame;
  begun_ = true;
  return absl::OkStatus();
}

absl::Status RasterUploadImpl::AddChunk(const std::string& chunk) {
  if (chunk.size() > wanted_bytes() - received_bytes_) {
    return ViolationError(
        "chunk", "must end with the raster's " +
                     std::to_string(wanted_bytes()) + " bytes, got at least " +
                     std::to_string(received_bytes_ + chunk.size()));
  }
  hash_.Add(chunk);
  // Memory follows the bytes that came, not those that a header promised.
  const std::size_t end = received_bytes_ + chunk.size();
  const std::size_t samples = (end + sizeof(float) - 1) / sizeof(float);
  if (samples > raster_->values.capacity()) {
    raster_->values.reserve(
        std::min(2 * samples, wanted_bytes() / sizeof(float)));
  }
  raster_->values.resize(samples);
  std::memcpy(reinterpret_cast<char*>(raster_->values.data()) + received_bytes_,
              chunk.data(), chunk.size());
  received_bytes_ = end;
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
  if (received_bytes_ != wanted_bytes()) {
    return ViolationError(
        "chunk", "must hold " + std::to_string(wanted_bytes()) +
                     " bytes in all, got " + std::to_string(received_bytes_));
  }
  const std::string raster_id = hash_.Finish();
  if (!expected_id_.empty() && expected_id_ != raster_id) {
    return ViolationError(
        "expected_raster_id",
        "must be that of the content, " + raster_id + ", got " + expected_id_);
  }
  if (const absl::Status clean = CleanSamples(); !clean.ok()) return clean;
  v1::UploadRasterResponse response;
  response.set_raster_id(raster_id);
  response.set_already_present(store_->Insert(Describe(raster_id)));
  return response;
}

}  // namespace

std::unique_ptr<RasterUpload> MakeRasterUpload(const Limits& limits,
                                               RasterStore* store) {
  return std::make_unique<RasterUploadImpl>(limits, store);
}

}  // namespace terrane::server
