// StreamSource: what a server stream sends, one message at a time.
//
// StreamCall (server/service/stream_call.h) decides when; a source makes the
// bytes. Belongs to one stream and is used by one worker at a time. Errors of
// both methods end the stream.
#ifndef TERRANE_SERVER_SERVICE_STREAM_SOURCE_H_
#define TERRANE_SERVER_SERVICE_STREAM_SOURCE_H_

#include <grpcpp/support/byte_buffer.h>

#include <stop_token>

#include "absl/status/statusor.h"
#include "core/terrain/terrain.h"
#include "server/service/call_record.h"

namespace terrane::server {

class StreamSource {
 public:
  virtual ~StreamSource() = default;

  // Reads and admits the request, and makes ready what its messages come from;
  // the first message.
  virtual absl::StatusOr<grpc::ByteBuffer> Open(std::stop_token stop,
                                                CallRecord* record) = 0;
  // What all messages take on one core of this machine, as such work did so
  // far. After Open.
  virtual double EstimatedSeconds() const = 0;
  // Whether every message was made. After Open.
  virtual bool AllMade() const = 0;
  // The next message.
  virtual absl::StatusOr<grpc::ByteBuffer> Next(std::stop_token stop,
                                                core::TileScratch* scratch,
                                                CallRecord* record) = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_STREAM_SOURCE_H_
