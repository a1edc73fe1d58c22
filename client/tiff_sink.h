// A HeightSink that writes a tiled GeoTIFF through GDAL.
#ifndef TERRANE_CLIENT_TIFF_SINK_H_
#define TERRANE_CLIENT_TIFF_SINK_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/height_sink.h"

namespace terrane::client {

absl::StatusOr<std::unique_ptr<HeightSink>> OpenTiffSink(
    const std::string& path, const HeightLayout& layout,
    Compression compression);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TIFF_SINK_H_
