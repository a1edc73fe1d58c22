#include "server/actor/spot_table_upload.h"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/violations.h"
#include "core/terrain/spec_checks.h"
#include "server/actor/upload_values.h"
#include "server/convert/content_hash.h"

namespace terrane::server {
namespace {

using core::ViolationError;

// The columns in the order in which they come.
enum Column : std::size_t { kX, kY, kHeight, kStandardError };

// What a table's id starts from (proto/terrane/v1/spot_table.proto).
void HashHeader(const v1::SpotTableHeader& header, ContentHash* hash) {
  hash->Add(std::string_view("terrane.spots.v1\0", 17));
  hash->AddNumber(static_cast<std::uint64_t>(header.rows()));
  hash->AddNumber(
      static_cast<std::uint8_t>(header.has_standard_errors() ? 1 : 0));
}

class SpotTableUploadImpl : public SpotTableUpload {
 public:
  SpotTableUploadImpl(const Limits& limits, SpotTableStore* store)
      : limits_(limits), store_(store) {}

  absl::Status Add(const v1::UploadSpotTableRequest& part) override;
  absl::StatusOr<v1::UploadSpotTableResponse> Finish() override;

 private:
  absl::Status Begin(const v1::UploadSpotTableRequest& first);

  const Limits& limits_;
  SpotTableStore* const store_;
  v1::SpotTableHeader header_;
  std::string expected_id_;
  ContentHash hash_;
  Reservation reservation_;
  std::optional<UploadValues<double>> values_;  // set by the header
};

absl::Status SpotTableUploadImpl::Add(const v1::UploadSpotTableRequest& part) {
  if (!values_.has_value()) return Begin(part);
  if (part.part_case() != v1::UploadSpotTableRequest::kChunk) {
    return ViolationError("chunk", "must be set after the first message");
  }
  hash_.Add(part.chunk());
  return values_->Add(part.chunk());
}

absl::Status SpotTableUploadImpl::Begin(
    const v1::UploadSpotTableRequest& first) {
  if (!first.has_header()) {
    return ViolationError("header", "must be set in the first message");
  }
  header_ = first.header();
  expected_id_ = first.expected_table_id();
  core::Violations violations;
  const std::string prefix = "header.";
  const core::Path root(&prefix);
  core::SpecChecks checks(limits_.recipe, 2, &violations);
  if (!checks.Integer(root.Field("rows"), header_.rows(), 1,
                      limits_.recipe.max_spots)) {
    return violations.ToStatus();
  }
  absl::StatusOr<Reservation> reservation =
      store_->Reserve("the table", SpotTableBytes(header_.rows()));
  if (!reservation.ok()) return reservation.status();
  reservation_ = *std::move(reservation);
  HashHeader(header_, &hash_);
  const std::size_t columns = header_.has_standard_errors() ? 4 : 3;
  values_.emplace("table", columns * static_cast<std::size_t>(header_.rows()));
  return absl::OkStatus();
}

// From columns to rows; every value must be finite. Ranges are those of the
// recipe that names the table.
absl::StatusOr<SpotTable> ToRows(const std::vector<double>& values,
                                 std::size_t rows) {
  constexpr const char* kNames[] = {"x", "y", "height", "standard_error"};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    return ViolationError("chunk", "must hold finite numbers, got " +
                                       core::NumberText(values[i]) + " as " +
                                       kNames[i / rows] + " of row " +
                                       std::to_string(i % rows));
  }
  const bool has_errors = values.size() > kStandardError * rows;
  SpotTable table(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    table[i].point = {values[kX * rows + i], values[kY * rows + i]};
    table[i].height = values[kHeight * rows + i];
    if (has_errors) {
      table[i].standard_error = values[kStandardError * rows + i];
    }
  }
  return table;
}

absl::StatusOr<v1::UploadSpotTableResponse> SpotTableUploadImpl::Finish() {
  if (!values_.has_value()) {
    return ViolationError("header", "must be sent, got nothing");
  }
  if (const absl::Status all = values_->CheckEnd(); !all.ok()) return all;
  const std::string table_id = hash_.Finish();
  if (!expected_id_.empty() && expected_id_ != table_id) {
    return ViolationError(
        "expected_table_id",
        "must be that of the content, " + table_id + ", got " + expected_id_);
  }
  absl::StatusOr<SpotTable> table =
      ToRows(values_->Take(), static_cast<std::size_t>(header_.rows()));
  if (!table.ok()) return table.status();

  StoredSpotTable stored;
  stored.table = std::make_shared<const SpotTable>(*std::move(table));
  stored.description.set_table_id(table_id);
  *stored.description.mutable_header() = header_;
  v1::UploadSpotTableResponse response;
  response.set_table_id(table_id);
  response.set_already_present(store_->Insert(table_id, std::move(stored),
                                              SpotTableBytes(header_.rows())));
  return response;
}

}  // namespace

std::unique_ptr<SpotTableUpload> MakeSpotTableUpload(const Limits& limits,
                                                     SpotTableStore* store) {
  return std::make_unique<SpotTableUploadImpl>(limits, store);
}

}  // namespace terrane::server
