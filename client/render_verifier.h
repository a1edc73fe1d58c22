// RenderVerifier: every band of a picture is held against what must come, so
// that nothing wrong reaches a file: order, rows, size, checksum.
//
// Belongs to one stream and one thread. Errors: DATA_LOSS, naming what came and
// what was expected; FAILED_PRECONDITION when a resumed stream is another's.
#ifndef TERRANE_CLIENT_RENDER_VERIFIER_H_
#define TERRANE_CLIENT_RENDER_VERIFIER_H_

#include <cstdint>

#include "absl/status/status.h"
#include "terrane/v1/render.pb.h"

namespace terrane::client {

class RenderVerifier {
 public:
  explicit RenderVerifier(const v1::StreamRenderRequest& request)
      : next_index_(request.first_band()) {}

  // The header of the stream, or of its resumption: that one must announce the
  // same picture.
  absl::Status CheckHeader(const v1::RenderHeader& header);
  bool has_header() const { return has_header_; }
  // A message that holds a band, or progress.
  absl::Status CheckTile(const v1::StreamRenderResponse& message);
  absl::Status CheckEnd() const;
  // Index of the band that must come next: where to resume.
  std::int64_t next_index() const { return next_index_; }

 private:
  v1::RenderHeader header_;
  bool has_header_ = false;
  std::int64_t next_index_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_VERIFIER_H_
