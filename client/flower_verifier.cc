#include "client/flower_verifier.h"

#include "client/column_check.h"
#include "core/base/column_bytes.h"

namespace terrane::client {

absl::Status FlowerVerifier::CheckHeader(const v1::FlowerHeader& header) {
  if (has_header_ && (header.recipe_hash() != header_.recipe_hash() ||
                      header.revision() != header_.revision())) {
    return absl::FailedPreconditionError(
        "the server's answer changed between the parts of a resumed stream: "
        "another recipe or algorithm revision");
  }
  header_ = header;
  has_header_ = true;
  return absl::OkStatus();
}

absl::Status FlowerVerifier::CheckTile(
    const v1::StreamFlowerResponse& message) {
  const bool is_prototype = message.has_prototype();
  const std::int64_t part =
      is_prototype ? message.prototype().part() : message.instances().part();
  const std::string name = "part " + std::to_string(part);
  absl::Status status = CheckPlace(name, part, next_part_);
  if (status.ok()) {
    status = is_prototype ? CheckPrototype(name, message.prototype())
                          : CheckInstances(name, message.instances());
  }
  if (status.ok()) ++next_part_;
  return status;
}

absl::Status FlowerVerifier::CheckPrototype(const std::string& name,
                                            const v1::PrototypePart& part) {
  if (part.prototype() < 0 || part.prototype() >= header_.prototypes()) {
    return WrongBlock(name, "is of prototype " +
                                std::to_string(part.prototype()) + " of " +
                                std::to_string(header_.prototypes()));
  }
  if (part.has_info()) {
    info_ = part.info();
    prototype_ = part.prototype();
  }
  const auto vertices = static_cast<std::int64_t>(part.positions().size() / 12);
  const bool has_colors = part.prototype() == prototype_
                              ? info_.has_colors()
                              : !part.colors().empty();
  const absl::Status status = CheckColumns(
      name,
      {{"positions", part.positions(), 12 * vertices},
       {"normals", part.normals(), 12 * vertices},
       {"texture coordinates", part.uvs(), 8 * vertices},
       {"colours", part.colors(), has_colors ? 12 * vertices : 0},
       {"indices", part.indices(),
        static_cast<std::int64_t>(part.indices().size() / 12 * 12)}},
      part.checksum());
  if (!status.ok() || part.prototype() != prototype_) return status;
  const auto indices = static_cast<std::int64_t>(part.indices().size() / 4);
  for (std::int64_t k = 0; k < indices; ++k) {
    const std::int64_t vertex =
        core::ElementOf<std::uint32_t>(part.indices(), k);
    if (vertex >= info_.vertices()) {
      return WrongBlock(name, "has a triangle with vertex " +
                                  std::to_string(vertex) + " of " +
                                  std::to_string(info_.vertices()));
    }
  }
  return absl::OkStatus();
}

absl::Status FlowerVerifier::CheckInstances(const std::string& name,
                                            const v1::InstanceRows& rows) {
  const std::int64_t count = rows.rows();
  const absl::Status status =
      CheckColumns(name,
                   {{"prototypes", rows.prototypes(), 4 * count},
                    {"translations", rows.translations(), 12 * count},
                    {"rotations", rows.rotations(), 16 * count},
                    {"scales", rows.scales(), 12 * count},
                    {"organs", rows.organs(), count},
                    {"numbers", rows.numbers(), 4 * count},
                    {"plants", rows.plants(), 4 * count}},
                   rows.checksum());
  if (!status.ok()) return status;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t prototype =
        core::ElementOf<std::uint32_t>(rows.prototypes(), k);
    if (prototype >= header_.prototypes()) {
      return WrongBlock(name, "has an instance of prototype " +
                                  std::to_string(prototype) + " of " +
                                  std::to_string(header_.prototypes()));
    }
  }
  return absl::OkStatus();
}

absl::Status FlowerVerifier::CheckEnd() const {
  if (!has_header_) return absl::DataLossError("the stream had no header");
  if (next_part_ == header_.parts()) return absl::OkStatus();
  return absl::DataLossError("the stream ended after " +
                             std::to_string(next_part_) + " of " +
                             std::to_string(header_.parts()) + " parts");
}

}  // namespace terrane::client
