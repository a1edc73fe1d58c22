// MessageRun: the messages of one admitted stream, one after the other.
//
// The first message is the header. A run belongs to one thread at a time; it
// makes the next message only when asked, so whoever sends them decides the
// pace. Errors: CANCELLED when the stop token was asked to, at most a
// millisecond later; the run is then over.
#ifndef TERRANE_SERVER_ACTOR_MESSAGE_RUN_H_
#define TERRANE_SERVER_ACTOR_MESSAGE_RUN_H_

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace terrane::server {

template <typename Message>
class MessageRun {
 public:
  virtual ~MessageRun() = default;

  // Of the resolved recipe that everything comes from.
  virtual const std::string& recipe_hash() const = 0;
  // What all messages take on one core of this machine, at most, as such work
  // did so far.
  virtual double EstimatedSeconds() const = 0;
  // Whether every message was made.
  virtual bool Done() const = 0;
  // Replaces *message by the next one.
  virtual absl::Status Next(std::stop_token stop, Message* message) = 0;
  // What the last message held, in the stream's own unit: rows, vertices,
  // leaves, pixels.
  virtual std::int64_t last_items() const = 0;
};

template <typename Message>
using OpenedRun = absl::StatusOr<std::unique_ptr<MessageRun<Message>>>;

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_MESSAGE_RUN_H_
