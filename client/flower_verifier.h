// FlowerVerifier: every part of StreamFlower is held against what must come, so
// that nothing wrong reaches a file: order, sizes of columns, checksums,
// triangles and prototypes that are there.
//
// Belongs to one stream and one thread. Errors: DATA_LOSS, naming what came and
// what was expected; FAILED_PRECONDITION when a resumed stream is another's.
#ifndef TERRANE_CLIENT_FLOWER_VERIFIER_H_
#define TERRANE_CLIENT_FLOWER_VERIFIER_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "terrane/v1/flower.pb.h"

namespace terrane::client {

class FlowerVerifier {
 public:
  explicit FlowerVerifier(const v1::StreamFlowerRequest& request)
      : next_part_(request.first_part()) {}

  absl::Status CheckHeader(const v1::FlowerHeader& header);
  absl::Status CheckTile(const v1::StreamFlowerResponse& message);
  absl::Status CheckEnd() const;
  bool has_header() const { return has_header_; }
  // Where to resume.
  std::int64_t next_index() const { return next_part_; }

 private:
  absl::Status CheckPrototype(const std::string& name,
                              const v1::PrototypePart& part);
  absl::Status CheckInstances(const std::string& name,
                              const v1::InstanceRows& rows);

  std::int64_t next_part_;
  bool has_header_ = false;
  v1::FlowerHeader header_;
  // Of the prototype in hand; of a stream resumed inside it nothing is known.
  v1::PrototypeInfo info_;
  int prototype_ = -1;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_FLOWER_VERIFIER_H_
