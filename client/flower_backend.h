// FlowerBackend: whatever answers FlowerService; see Backend
// (client/backend.h) for threads and errors.
#ifndef TERRANE_CLIENT_FLOWER_BACKEND_H_
#define TERRANE_CLIENT_FLOWER_BACKEND_H_

#include <functional>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "terrane/v1/flower.pb.h"

namespace terrane::client {

// Takes the header, once, before any part.
using OnFlowerHeader = std::function<absl::Status(const v1::FlowerHeader&)>;
// Takes the parts in their order, each once and verified
// (client/flower_verifier.h). An error ends the stream and is its answer.
using OnFlowerPart =
    std::function<absl::Status(const v1::StreamFlowerResponse&)>;

class FlowerBackend {
 public:
  virtual ~FlowerBackend() = default;

  virtual absl::Status StreamFlower(const v1::StreamFlowerRequest& request,
                                    const OnFlowerHeader& on_header,
                                    const OnFlowerPart& on_part,
                                    std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::EstimateFlowerResponse> EstimateFlower(
      const v1::EstimateFlowerRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetFlowerPresetResponse> GetFlowerPreset(
      const v1::GetFlowerPresetRequest& request, std::stop_token stop) = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_FLOWER_BACKEND_H_
