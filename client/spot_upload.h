// A table of spot heights as the messages of an upload, the same for both
// backends.
#ifndef TERRANE_CLIENT_SPOT_UPLOAD_H_
#define TERRANE_CLIENT_SPOT_UPLOAD_H_

#include <functional>

#include "absl/status/status.h"
#include "client/spot_table.h"
#include "terrane/v1/spot_table.pb.h"

namespace terrane::client {

// Hands the header and then the columns to `send`, in parts of at most 1 MiB;
// ends at its first error and answers that.
absl::Status SendSpotTable(
    const SpotTable& table,
    const std::function<absl::Status(const v1::UploadSpotTableRequest&)>& send);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SPOT_UPLOAD_H_
