// A traced picture into a file: PNG, or OpenEXR with linear radiance.
#ifndef TERRANE_CLIENT_TRACED_PICTURE_H_
#define TERRANE_CLIENT_TRACED_PICTURE_H_

#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "client/progress.h"
#include "client/render_backend.h"
#include "terrane/v1/render.pb.h"

namespace terrane::client {

// Whether the file named is one that traced pictures are written to.
bool IsTracedFile(const std::string& path);

// Traces the finished picture alone and writes it; `path` decides the encoding.
// Errors: those of the backend and of the file.
absl::Status WriteTracedPicture(v1::StreamRenderRequest request,
                                const std::string& path, ProgressMode mode,
                                RenderBackend* backend, std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TRACED_PICTURE_H_
