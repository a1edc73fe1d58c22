// FlowerModel: a flower or a bed as a scene: prototype meshes and instances.
//
// Filled from the parts of a stream and kept in memory: some 44 bytes a vertex
// of the prototypes and 40 an instance. In metres. Belongs to one thread.
#ifndef TERRANE_CLIENT_FLOWER_MODEL_H_
#define TERRANE_CLIENT_FLOWER_MODEL_H_

#include <cstdint>
#include <stop_token>
#include <vector>

#include "absl/status/statusor.h"
#include "client/flower_backend.h"
#include "client/progress.h"
#include "core/mesh/scene.h"

namespace terrane::client {

class FlowerModel {
 public:
  // Errors: those of the backend.
  static absl::StatusOr<FlowerModel> Stream(const v1::FlowerChoice& choice,
                                            ProgressMode progress,
                                            FlowerBackend* backend,
                                            std::stop_token stop);

  const v1::FlowerHeader& header() const { return header_; }
  // Vertices and triangles of all prototypes; bytes that the stream's columns
  // had.
  std::int64_t vertices() const;
  std::int64_t triangles() const;
  std::int64_t data_bytes() const { return data_bytes_; }

  // An object a prototype that has an instance. Refers to this.
  core::Scene View() const;

 private:
  struct Prototype {
    v1::PrototypeInfo info;
    core::Mesh mesh;
    core::Instances instances;
  };

  void AddPrototype(const v1::PrototypePart& part);
  void AddInstances(const v1::InstanceRows& rows);

  v1::FlowerHeader header_;
  std::vector<Prototype> prototypes_;
  std::int64_t data_bytes_ = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_FLOWER_MODEL_H_
