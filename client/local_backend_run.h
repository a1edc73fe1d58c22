// The messages of a MessageRun (server/actor/message_run.h), verified and
// handed out in this thread, as a stream from a server would be.
#ifndef TERRANE_CLIENT_LOCAL_BACKEND_RUN_H_
#define TERRANE_CLIENT_LOCAL_BACKEND_RUN_H_

#include <stop_token>

#include "absl/status/status.h"
#include "server/actor/message_run.h"

namespace terrane::client {

// `part_of` is what of a message that is no header is checked and handed on.
// `stop` is a reference, for what opens the run in the same call may read it.
template <typename Message, typename Header, typename Part, typename PartOf,
          typename Verifier>
absl::Status HandOutRun(const server::OpenedRun<Message>& run,
                        const Header& on_header, const Part& on_part,
                        const PartOf& part_of, const std::stop_token& stop,
                        Verifier* verifier) {
  if (!run.ok()) return run.status();
  Message message;
  while (!(*run)->Done()) {
    absl::Status status = (*run)->Next(stop, &message);
    if (!status.ok()) return status;
    if (message.has_header()) {
      status = verifier->CheckHeader(message.header());
      if (status.ok()) status = on_header(message.header());
    } else {
      status = verifier->CheckTile(part_of(message));
      if (status.ok()) status = on_part(part_of(message));
    }
    if (!status.ok()) return status;
  }
  return verifier->CheckEnd();
}

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_LOCAL_BACKEND_RUN_H_
