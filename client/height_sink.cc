#include "client/height_sink.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "client/output_file.h"
#include "client/raw_heights.h"
#include "client/tiff_sink.h"
#include "core/codec/image_codec.h"
#include "core/grid/height_codec.h"

namespace terrane::client {
namespace {

// Samples are written as they lie in memory.
static_assert(std::endian::native == std::endian::little);

// .png and .exr are built in memory: 1 GiB of floats.
constexpr std::int64_t kMaxImageSamples = std::int64_t{1} << 28;

struct NamedFormat {
  const char* extension;
  HeightFormat format;
};
constexpr std::array<NamedFormat, 6> kFormats = {{
    {".tif", HeightFormat::kTiff},
    {".tiff", HeightFormat::kTiff},
    {".f32", HeightFormat::kF32},
    {".r16", HeightFormat::kR16},
    {".png", HeightFormat::kPng},
    {".exr", HeightFormat::kExr},
}};

// A file of floats in row-major order that is written in any order.
class FloatFile {
 public:
  FloatFile(OutputFile file, std::int64_t width)
      : file_(std::move(file)), width_(width) {}

  absl::Status Write(const core::Window& rectangle,
                     std::span<const float> heights) {
    const auto columns = static_cast<std::size_t>(rectangle.width);
    for (std::int64_t j = 0; j < rectangle.height; ++j) {
      const auto row =
          heights.subspan(static_cast<std::size_t>(j) * columns, columns);
      const std::int64_t at = (rectangle.y + j) * width_ + rectangle.x;
      const absl::Status status =
          file_.WriteAt(at * std::int64_t{sizeof(float)}, std::as_bytes(row));
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status ReadRow(std::int64_t row, std::span<float> heights) const {
    return file_.ReadAt(row * width_ * std::int64_t{sizeof(float)},
                        std::as_writable_bytes(heights));
  }

  OutputFile& file() { return file_; }

 private:
  OutputFile file_;
  std::int64_t width_;
};

HeightSidecar SidecarOf(const std::string& path, const HeightLayout& layout,
                        const char* encoding, const HeightRange& range) {
  HeightSidecar sidecar;
  sidecar.set_file(std::filesystem::path(path).filename());
  sidecar.set_encoding(encoding);
  sidecar.set_width(static_cast<double>(layout.window.width));
  sidecar.set_height(static_cast<double>(layout.window.height));
  sidecar.set_minimum(range.minimum);
  sidecar.set_maximum(range.maximum);
  sidecar.set_origin_x(layout.frame.origin_x);
  sidecar.set_origin_y(layout.frame.origin_y);
  sidecar.set_spacing_x(layout.frame.spacing_x);
  sidecar.set_spacing_y(layout.frame.spacing_y);
  sidecar.set_crs(layout.crs);
  sidecar.set_sampling(layout.sampling == core::Sampling::kPoint ? "point"
                                                                 : "area");
  sidecar.set_level(layout.level);
  sidecar.set_window_x(static_cast<double>(layout.window.x));
  sidecar.set_window_y(static_cast<double>(layout.window.y));
  sidecar.set_recipe_hash(layout.recipe_hash);
  sidecar.set_revision(layout.revision);
  return sidecar;
}

class F32Sink : public HeightSink {
 public:
  F32Sink(FloatFile floats, HeightLayout layout)
      : floats_(std::move(floats)), layout_(std::move(layout)) {}

  absl::Status Write(const core::Window& rectangle,
                     std::span<const float> heights) override {
    return floats_.Write(rectangle, heights);
  }

  absl::Status Finish(const HeightTotals& totals) override {
    const std::string path = floats_.file().path();
    const absl::Status status = floats_.file().Commit();
    if (!status.ok()) return status;
    HeightSidecar sidecar =
        SidecarOf(path, layout_, "float32-le", totals.range());
    sidecar.set_nodata_samples(static_cast<double>(totals.nodata_samples()));
    return WriteSidecar(path, sidecar);
  }

 private:
  FloatFile floats_;
  HeightLayout layout_;
};

// Collects the heights in a temporary file of floats and makes the real file
// from it at the end, when the range of all heights is known.
class SpoolSink : public HeightSink {
 public:
  SpoolSink(FloatFile spool, std::string path, HeightFormat format,
            HeightLayout layout, std::optional<HeightRange> range)
      : spool_(std::move(spool)),
        path_(std::move(path)),
        format_(format),
        layout_(std::move(layout)),
        range_(range) {}

  absl::Status Write(const core::Window& rectangle,
                     std::span<const float> heights) override {
    return spool_.Write(rectangle, heights);
  }

  absl::Status Finish(const HeightTotals& totals) override {
    if (format_ == HeightFormat::kExr) return WriteExr();
    HeightRange range = range_.value_or(totals.range());
    // A plain has no range of its own; any height above it will do.
    if (range.minimum == range.maximum) range.maximum = range.minimum + 1;
    const absl::Status status =
        format_ == HeightFormat::kPng ? WritePng(range) : WriteR16(range);
    if (!status.ok()) return status;
    HeightSidecar sidecar = SidecarOf(
        path_, layout_,
        format_ == HeightFormat::kPng ? "uint16-png" : "uint16-le", range);
    sidecar.set_nodata_samples(static_cast<double>(nodata_));
    sidecar.set_clipped_samples(static_cast<double>(clipped_));
    return WriteSidecar(path_, sidecar);
  }

 private:
  void Quantise(std::span<const float> heights, const HeightRange& range,
                std::span<std::uint16_t> steps) {
    clipped_ +=
        core::EncodeUint16(heights, range.minimum, range.maximum, steps);
    nodata_ += core::MeasureHeights(heights).nodata_samples;
  }

  absl::Status WriteR16(const HeightRange& range) {
    absl::StatusOr<OutputFile> file = OutputFile::Create(path_);
    if (!file.ok()) return file.status();
    std::vector<float> row(static_cast<std::size_t>(layout_.window.width));
    std::vector<std::uint16_t> steps(row.size());
    const std::span<const std::byte> bytes = std::as_bytes(std::span(steps));
    for (std::int64_t j = 0; j < layout_.window.height; ++j) {
      absl::Status status = spool_.ReadRow(j, row);
      if (!status.ok()) return status;
      Quantise(row, range, steps);
      status =
          file->WriteAt(j * static_cast<std::int64_t>(bytes.size()), bytes);
      if (!status.ok()) return status;
    }
    return file->Commit();
  }

  absl::Status WritePng(const HeightRange& range) {
    core::Image<std::uint16_t> image(static_cast<int>(layout_.window.width),
                                     static_cast<int>(layout_.window.height),
                                     1);
    std::vector<float> row(static_cast<std::size_t>(image.width));
    for (int j = 0; j < image.height; ++j) {
      const absl::Status status = spool_.ReadRow(j, row);
      if (!status.ok()) return status;
      Quantise(row, range, {image.Pixel(0, j), row.size()});
    }
    const absl::StatusOr<core::EncodedImage> bytes = core::EncodePng(image);
    if (!bytes.ok()) return bytes.status();
    return WriteFile(path_, std::as_bytes(std::span(*bytes)));
  }

  absl::Status WriteExr() {
    core::Image<float> image(static_cast<int>(layout_.window.width),
                             static_cast<int>(layout_.window.height), 1);
    for (int j = 0; j < image.height; ++j) {
      const absl::Status status = spool_.ReadRow(
          j, {image.Pixel(0, j), static_cast<std::size_t>(image.width)});
      if (!status.ok()) return status;
    }
    const absl::StatusOr<core::EncodedImage> bytes = core::EncodeExr(image);
    if (!bytes.ok()) return bytes.status();
    return WriteFile(path_, std::as_bytes(std::span(*bytes)));
  }

  FloatFile spool_;
  std::string path_;
  HeightFormat format_;
  HeightLayout layout_;
  std::optional<HeightRange> range_;
  std::int64_t clipped_ = 0;
  std::int64_t nodata_ = 0;
};

absl::Status CheckImageSize(const std::string& path,
                            const core::Window& window) {
  if (window.width <= kMaxImageSamples / window.height) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      path + ": .png and .exr hold at most " +
      std::to_string(kMaxImageSamples) + " samples, got " +
      std::to_string(window.width) + " x " + std::to_string(window.height) +
      "; .tif, .r16 and .f32 have no such limit");
}

}  // namespace

absl::StatusOr<HeightFormat> FormatOf(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  for (const NamedFormat& named : kFormats) {
    if (extension == named.extension) return named.format;
  }
  return absl::InvalidArgumentError(
      "--out: must end in .tif, .png, .exr, .r16 or .f32, got \"" + path +
      "\"");
}

bool IsQuantised(HeightFormat format) {
  return format == HeightFormat::kPng || format == HeightFormat::kR16;
}

void HeightTotals::Add(float minimum, float maximum,
                       std::int64_t nodata_samples) {
  nodata_samples_ += nodata_samples;
  if (std::isnan(minimum)) return;
  if (!range_.has_value()) range_ = HeightRange{minimum, maximum};
  range_->minimum = std::min<double>(range_->minimum, minimum);
  range_->maximum = std::max<double>(range_->maximum, maximum);
}

absl::StatusOr<std::unique_ptr<HeightSink>> OpenHeightSink(
    const std::string& path, const HeightLayout& layout,
    const SinkOptions& options) {
  const absl::StatusOr<HeightFormat> format = FormatOf(path);
  if (!format.ok()) return format.status();
  if (*format == HeightFormat::kTiff) {
    return OpenTiffSink(path, layout, options.compression);
  }
  if (*format == HeightFormat::kPng || *format == HeightFormat::kExr) {
    const absl::Status status = CheckImageSize(path, layout.window);
    if (!status.ok()) return status;
  }
  const bool direct = *format == HeightFormat::kF32;
  absl::StatusOr<OutputFile> file =
      OutputFile::Create(direct ? path : path + ".floats");
  if (!file.ok()) return file.status();
  FloatFile floats(std::move(*file), layout.window.width);
  if (direct) return std::make_unique<F32Sink>(std::move(floats), layout);
  return std::make_unique<SpoolSink>(std::move(floats), path, *format, layout,
                                     options.range);
}

}  // namespace terrane::client
