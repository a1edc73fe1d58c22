// UploadValues: the numbers of an upload as they come, in chunks that may be
// cut anywhere, also inside a number.
//
// Memory follows the bytes that came, not those that a header promised.
// Threads: one. Errors: INVALID_ARGUMENT naming "chunk" for more or fewer bytes
// than wanted.
#ifndef TERRANE_SERVER_ACTOR_UPLOAD_VALUES_H_
#define TERRANE_SERVER_ACTOR_UPLOAD_VALUES_H_

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "core/base/violations.h"

namespace terrane::server {

template <typename Number>
class UploadValues {
 public:
  static_assert(std::endian::native == std::endian::little,
                "the API's numbers are little-endian and kept as they come");

  // `what` is the content's name in an error: "raster".
  UploadValues(std::string what, std::size_t count)
      : what_(std::move(what)), wanted_bytes_(count * sizeof(Number)) {}

  absl::Status Add(std::string_view chunk) {
    const std::size_t end = received_bytes_ + chunk.size();
    if (end > wanted_bytes_) {
      return core::ViolationError(
          "chunk", "must end with the " + what_ + "'s " +
                       std::to_string(wanted_bytes_) + " bytes, got at least " +
                       std::to_string(end));
    }
    const std::size_t count = (end + sizeof(Number) - 1) / sizeof(Number);
    if (count > values_.capacity()) {
      values_.reserve(std::min(2 * count, wanted_bytes_ / sizeof(Number)));
    }
    values_.resize(count);
    std::memcpy(reinterpret_cast<char*>(values_.data()) + received_bytes_,
                chunk.data(), chunk.size());
    received_bytes_ = end;
    return absl::OkStatus();
  }

  // Whether all came.
  absl::Status CheckEnd() const {
    if (received_bytes_ == wanted_bytes_) return absl::OkStatus();
    return core::ViolationError(
        "chunk", "must hold " + std::to_string(wanted_bytes_) +
                     " bytes in all, got " + std::to_string(received_bytes_));
  }

  std::vector<Number> Take() { return std::move(values_); }

 private:
  std::string what_;
  std::size_t wanted_bytes_ = 0;
  std::size_t received_bytes_ = 0;
  std::vector<Number> values_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_UPLOAD_VALUES_H_
