#include "client/terrain_export.h"

#include <cstring>
#include <filesystem>
#include <span>
#include <utility>

namespace terrane::client {
namespace {

core::Window WindowOf(const v1::Window& window) {
  return {window.x(), window.y(), window.width(), window.height()};
}

void Replace(const std::string& what, const std::string& by,
             std::string* text) {
  const std::size_t at = text->find(what);
  if (at != std::string::npos) text->replace(at, what.size(), by);
}

// The pattern of the tiles' names.
std::string TilePattern(const std::string& path) {
  if (path.find("{x}") != std::string::npos &&
      path.find("{y}") != std::string::npos) {
    return path;
  }
  std::filesystem::path name(path);
  const std::string extension = name.extension();
  name.replace_extension();
  return name.string() + "_x{x}_y{y}" + extension;
}

}  // namespace

TerrainExport::TerrainExport(std::string path, Files files, SinkOptions options)
    : path_(files == Files::kOne ? std::move(path) : TilePattern(path)),
      files_(files),
      options_(options) {}

absl::Status TerrainExport::AddHeader(const v1::StreamHeader& header) {
  header_ = header;
  if (files_ == Files::kOne) {
    absl::StatusOr<std::unique_ptr<HeightSink>> sink =
        OpenHeightSink(path_, LayoutOf(WindowOf(header.window())), options_);
    if (!sink.ok()) return sink.status();
    sink_ = std::move(*sink);
    return absl::OkStatus();
  }
  const std::filesystem::path folder =
      std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) {
    return absl::UnknownError("cannot create " + folder.string() + ": " +
                              error.message());
  }
  const absl::StatusOr<HeightFormat> format = FormatOf(path_);
  if (!format.ok()) return format.status();
  if (IsQuantised(*format) && !options_.range.has_value()) {
    absl::StatusOr<OutputFile> spool = OutputFile::Create(path_ + ".floats");
    if (!spool.ok()) return spool.status();
    spool_ = std::move(*spool);
  }
  return absl::OkStatus();
}

absl::Status TerrainExport::AddTile(const v1::HeightTile& tile) {
  const core::Window window = WindowOf(tile.window());
  heights_.resize(tile.data().size() / sizeof(float));
  std::memcpy(heights_.data(), tile.data().data(), tile.data().size());
  totals_.Add(tile.minimum(), tile.maximum(), tile.nodata_samples());
  samples_ += window.width * window.height;
  ++tiles_;
  if (sink_ != nullptr) {
    const core::Window inside{window.x - header_.window().x(),
                              window.y - header_.window().y(), window.width,
                              window.height};
    return sink_->Write(inside, heights_);
  }
  if (spool_.has_value()) return Spool(tile, window);
  HeightTotals totals;
  totals.Add(tile.minimum(), tile.maximum(), tile.nodata_samples());
  return WriteTileFile(tile.tile_x(), tile.tile_y(), window, totals, heights_);
}

absl::Status TerrainExport::Finish() {
  if (spool_.has_value()) return FinishSpooled();
  if (sink_ == nullptr) return absl::OkStatus();
  const absl::Status status = sink_->Finish(totals_);
  if (status.ok()) written_.push_back(path_);
  return status;
}

TerrainSummary TerrainExport::Summary() const {
  TerrainSummary summary;
  summary.mutable_files()->Assign(written_.begin(), written_.end());
  summary.set_samples(static_cast<double>(samples_));
  summary.set_width(static_cast<double>(header_.window().width()));
  summary.set_height(static_cast<double>(header_.window().height()));
  summary.set_level(header_.level());
  summary.set_tiles(static_cast<double>(tiles_));
  summary.set_minimum(totals_.range().minimum);
  summary.set_maximum(totals_.range().maximum);
  summary.set_nodata_samples(static_cast<double>(totals_.nodata_samples()));
  summary.set_recipe_hash(header_.recipe_hash());
  summary.set_revision(header_.revision());
  if (header_.has_deviation_bound()) {
    summary.set_deviation_bound(header_.deviation_bound());
  }
  if (header_.has_spots()) {
    const v1::SpotReport& report = header_.spots();
    SpotSummary* spots = summary.mutable_spots();
    spots->set_spots(static_cast<double>(report.spots()));
    spots->set_level(report.level());
    spots->set_largest_move(report.largest_move());
    spots->set_merged(static_cast<double>(report.merged()));
  }
  return summary;
}

HeightLayout TerrainExport::LayoutOf(const core::Window& window) const {
  const v1::Frame& frame = header_.frame();
  HeightLayout layout;
  layout.window = window;
  layout.level = header_.level();
  layout.sampling = header_.sampling() == v1::SAMPLING_AREA
                        ? core::Sampling::kArea
                        : core::Sampling::kPoint;
  // The header gives the place of sample (0, 0); the file starts at its window.
  layout.frame = {
      frame.origin_x() + static_cast<double>(window.x) * frame.spacing_x(),
      frame.origin_y() + static_cast<double>(window.y) * frame.spacing_y(),
      frame.spacing_x(), frame.spacing_y()};
  layout.crs = frame.crs();
  layout.tile_size = header_.tile_size();
  layout.recipe_hash = header_.recipe_hash();
  layout.revision = header_.revision();
  return layout;
}

std::string TerrainExport::TilePath(std::int64_t x, std::int64_t y) const {
  std::string path = path_;
  Replace("{x}", std::to_string(x), &path);
  Replace("{y}", std::to_string(y), &path);
  return path;
}

absl::Status TerrainExport::WriteTileFile(std::int64_t x, std::int64_t y,
                                          const core::Window& window,
                                          const HeightTotals& totals,
                                          std::span<const float> heights) {
  const std::string path = TilePath(x, y);
  const absl::StatusOr<std::unique_ptr<HeightSink>> sink =
      OpenHeightSink(path, LayoutOf(window), options_);
  if (!sink.ok()) return sink.status();
  absl::Status status =
      (*sink)->Write({0, 0, window.width, window.height}, heights);
  if (status.ok()) status = (*sink)->Finish(totals);
  if (status.ok()) written_.push_back(path);
  return status;
}

absl::Status TerrainExport::Spool(const v1::HeightTile& tile,
                                  const core::Window& window) {
  const auto bytes = std::as_bytes(std::span(tile.data()));
  const absl::Status status = spool_->WriteAt(spool_bytes_, bytes);
  if (!status.ok()) return status;
  spooled_.push_back({tile.tile_x(), tile.tile_y(), window, spool_bytes_});
  spool_bytes_ += static_cast<std::int64_t>(bytes.size());
  return absl::OkStatus();
}

absl::Status TerrainExport::FinishSpooled() {
  options_.range = totals_.range();
  for (const SpooledTile& tile : spooled_) {
    heights_.resize(
        static_cast<std::size_t>(tile.window.width * tile.window.height));
    absl::Status status = spool_->ReadAt(
        tile.offset, std::as_writable_bytes(std::span(heights_)));
    if (status.ok()) {
      status =
          WriteTileFile(tile.x, tile.y, tile.window, HeightTotals(), heights_);
    }
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace terrane::client
