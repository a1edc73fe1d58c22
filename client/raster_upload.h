// A raster as the messages of an upload, the same for both backends.
#ifndef TERRANE_CLIENT_RASTER_UPLOAD_H_
#define TERRANE_CLIENT_RASTER_UPLOAD_H_

#include <functional>

#include "absl/status/status.h"
#include "core/grid/raster.h"
#include "terrane/v1/raster.pb.h"

namespace terrane::client {

// Hands the header and then the samples to `send`, in parts of at most 1 MiB;
// ends at its first error and answers that.
absl::Status SendRaster(
    const core::Raster& raster,
    const std::function<absl::Status(const v1::UploadRasterRequest&)>& send);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RASTER_UPLOAD_H_
