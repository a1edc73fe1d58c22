#include "client/raw_heights.h"

#include <google/protobuf/util/json_util.h>

#include <bit>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>

#include "client/output_file.h"

namespace terrane::client {
namespace {

// Samples are read as they lie in the file.
static_assert(std::endian::native == std::endian::little);

absl::StatusOr<std::string> ReadWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

absl::StatusOr<HeightSidecar> ReadSidecar(const std::string& path) {
  const absl::StatusOr<std::string> text = ReadWhole(SidecarPath(path));
  if (!text.ok()) return text.status();
  HeightSidecar sidecar;
  const auto status =
      google::protobuf::util::JsonStringToMessage(*text, &sidecar);
  if (!status.ok()) {
    return absl::InvalidArgumentError(SidecarPath(path) + ": " +
                                      status.message().ToString());
  }
  return sidecar;
}

// A count that the sidecar gives: whole, and small enough to multiply.
bool IsSide(double count) {
  return count >= 1 && count <= 1 << 30 &&
         count == static_cast<double>(static_cast<std::int64_t>(count));
}

template <typename Value>
absl::StatusOr<std::vector<Value>> ReadValues(const std::string& path,
                                              std::size_t count) {
  std::vector<Value> values(count);
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(values));
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  file.read(reinterpret_cast<char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  if (file.gcount() != static_cast<std::streamsize>(bytes.size()) ||
      file.peek() != std::ifstream::traits_type::eof()) {
    return absl::InvalidArgumentError(path + " is not " +
                                      std::to_string(bytes.size()) +
                                      " bytes long, as its sidecar says");
  }
  return values;
}

absl::StatusOr<std::vector<float>> ReadAsFloats(const std::string& path,
                                                const HeightSidecar& sidecar,
                                                std::size_t count) {
  if (sidecar.encoding() == "float32-le") {
    return ReadValues<float>(path, count);
  }
  if (sidecar.encoding() != "uint16-le") {
    return absl::InvalidArgumentError(SidecarPath(path) +
                                      ": encoding: must be \"uint16-le\" or "
                                      "\"float32-le\", got \"" +
                                      sidecar.encoding() + "\"");
  }
  const absl::StatusOr<std::vector<std::uint16_t>> steps =
      ReadValues<std::uint16_t>(path, count);
  if (!steps.ok()) return steps.status();
  const double step = (sidecar.maximum() - sidecar.minimum()) / 65535;
  std::vector<float> heights;
  heights.reserve(count);
  for (const std::uint16_t value : *steps) {
    heights.push_back(static_cast<float>(sidecar.minimum() + value * step));
  }
  return heights;
}

}  // namespace

std::string SidecarPath(const std::string& path) { return path + ".json"; }

absl::Status WriteSidecar(const std::string& path,
                          const HeightSidecar& sidecar) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status =
      google::protobuf::util::MessageToJsonString(sidecar, &text, options);
  if (!status.ok()) return absl::InternalError(status.message().ToString());
  return WriteFile(SidecarPath(path), std::as_bytes(std::span(text)));
}

absl::StatusOr<PlacedRaster> ReadRawHeights(const std::string& path,
                                            std::int64_t max_samples) {
  const absl::StatusOr<HeightSidecar> sidecar = ReadSidecar(path);
  if (!sidecar.ok()) return sidecar.status();
  if (!IsSide(sidecar->width()) || !IsSide(sidecar->height()) ||
      sidecar->width() * sidecar->height() > static_cast<double>(max_samples)) {
    return absl::InvalidArgumentError(
        SidecarPath(path) + ": width and height: must be whole, at least 1, " +
        "and give at most " + std::to_string(max_samples) + " samples");
  }
  const auto width = static_cast<std::int64_t>(sidecar->width());
  const auto height = static_cast<std::int64_t>(sidecar->height());
  absl::StatusOr<std::vector<float>> values =
      ReadAsFloats(path, *sidecar, static_cast<std::size_t>(width * height));
  if (!values.ok()) return values.status();
  return PlacedRaster{{width,
                       height,
                       {sidecar->origin_x(), sidecar->origin_y(),
                        sidecar->spacing_x(), sidecar->spacing_y()},
                       std::move(*values)},
                      sidecar->crs()};
}

}  // namespace terrane::client
