// HeadedRun: a MessageRun whose header is ready before it starts.
#ifndef TERRANE_SERVER_ACTOR_HEADED_RUN_H_
#define TERRANE_SERVER_ACTOR_HEADED_RUN_H_

#include <cstdint>
#include <stop_token>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "server/actor/message_run.h"

namespace terrane::server {

template <typename Message, typename Header>
class HeadedRun : public MessageRun<Message> {
 public:
  HeadedRun(Header header, double estimated_seconds)
      : header_(std::move(header)), estimated_seconds_(estimated_seconds) {}

  const std::string& recipe_hash() const final { return header_.recipe_hash(); }

  double EstimatedSeconds() const final { return estimated_seconds_; }

  bool Done() const final { return gave_header_ && AllMade(); }

  absl::Status Next(std::stop_token stop, Message* message) final {
    if (gave_header_) return NextPart(std::move(stop), message);
    gave_header_ = true;
    *message->mutable_header() = header_;
    return absl::OkStatus();
  }

  std::int64_t last_items() const final { return items_; }

 protected:
  const Header& header() const { return header_; }
  void SetItems(std::int64_t items) { items_ = items; }

 private:
  // Whether every message but the header was made.
  virtual bool AllMade() const = 0;
  virtual absl::Status NextPart(std::stop_token stop, Message* message) = 0;

  const Header header_;
  const double estimated_seconds_;
  bool gave_header_ = false;
  std::int64_t items_ = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_HEADED_RUN_H_
