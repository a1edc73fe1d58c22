#include "server/service/call_record.h"

namespace terrane::server {

const char* NameOf(CallClass call_class) {
  switch (call_class) {
    case CallClass::kInteractive:
      return "interactive";
    case CallClass::kBatch:
      return "batch";
  }
  return "";
}

const char* NameOf(Refusal refusal) {
  switch (refusal) {
    case Refusal::kStreams:
      return "streams";
    case Refusal::kDeadline:
      return "deadline";
    case Refusal::kMemory:
      return "memory";
    case Refusal::kClientLimit:
      return "client_limit";
    case Refusal::kConnections:
      return "connections";
  }
  return "";
}

}  // namespace terrane::server
