// What every handler works with, and how a call begins.
#ifndef TERRANE_SERVER_SERVICE_CALL_CONTEXT_H_
#define TERRANE_SERVER_SERVICE_CALL_CONTEXT_H_

#include <grpcpp/server_context.h>

#include <memory>

#include "server/actor/actor.h"
#include "server/service/buffer_pool.h"
#include "server/service/call_book.h"
#include "server/service/call_record.h"
#include "server/service/memory_watch.h"
#include "server/service/stream_gate.h"
#include "server/service/worker_pool.h"

namespace terrane::server {

// The parts of a running server; they outlive every call.
struct ServiceParts {
  Actor* actor = nullptr;
  WorkerPool* workers = nullptr;
  StreamGate* gate = nullptr;
  MemoryWatch* memory = nullptr;
  CallBook* calls = nullptr;
  std::shared_ptr<BufferPool> buffers;
};

// Begins the record of a call. Its id is the client's x-request-id (letters,
// digits, '.', '_', '-'; at most 64), else a new one; the client gets it back
// in the initial metadata. Its trace is that of the client's traceparent.
CallRecord BeginCall(const char* method, grpc::CallbackServerContext* context);

// The status of a call that gRPC cancelled: by the client, or by its deadline.
absl::Status CancelStatus(const grpc::CallbackServerContext& context);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CALL_CONTEXT_H_
