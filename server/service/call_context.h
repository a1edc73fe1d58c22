// What every handler works with, and how a call begins.
#ifndef TERRANE_SERVER_SERVICE_CALL_CONTEXT_H_
#define TERRANE_SERVER_SERVICE_CALL_CONTEXT_H_

#include <grpcpp/server_context.h>

#include <memory>

#include "server/actor/actor.h"
#include "server/service/access.h"
#include "server/service/admission.h"
#include "server/service/buffer_pool.h"
#include "server/service/call_book.h"
#include "server/service/call_record.h"
#include "server/service/call_watch.h"
#include "server/service/linger.h"
#include "server/service/memory_watch.h"
#include "server/service/stream_gate.h"
#include "server/service/worker_pool.h"

namespace terrane::server {

// The parts of a running server; they outlive every call.
struct ServiceParts {
  Actor* actor = nullptr;
  WorkerPool* workers = nullptr;
  Admission* admission = nullptr;
  StreamGate* gate = nullptr;
  CallWatch* watch = nullptr;
  MemoryWatch* memory = nullptr;
  CallBook* calls = nullptr;
  std::shared_ptr<BufferPool> buffers;
  const Access* access = nullptr;
  Linger* linger = nullptr;
};

// Begins the record of a call. Its id is the client's x-request-id (letters,
// digits, '.', '_', '-'; at most 64), else a new one; the client gets it back
// in the initial metadata. Its trace is that of the client's traceparent. A
// call that may not be made (server/service/access.h) has a status that is not
// OK, and is to be ended with it.
CallRecord BeginCall(const ServiceParts& parts, const char* method,
                     grpc::CallbackServerContext* context);

// When a call has to be over, whatever the wall clock says; max() when it has
// no deadline, or one of the next century.
CallRecord::Clock::time_point DeadlineOf(
    const grpc::CallbackServerContext& context);
// The time that a call has left until then.
Admission::TimeLeft TimeLeft(CallRecord::Clock::time_point deadline);

// The refusal of a call while memory is tight.
absl::Status ShortOfMemoryError();

// OK when a call of one task may wait for a worker as `work`, whose place and
// class are set: memory is not tight, should the call `take_memory`, and it is
// expected to end in time at the average price of its method. Fills in the rest
// of `work`, and the refusal.
absl::Status AdmitTask(const ServiceParts& parts,
                       CallRecord::Clock::time_point deadline,
                       bool takes_memory, Work* work, CallRecord* record);

// Tells the client's library when to come back, if the status says so.
void AddPushback(const absl::Status& status,
                 grpc::CallbackServerContext* context);

// The status of a call that gRPC cancelled: by the client, or by its deadline.
absl::Status CancelStatus(CallRecord::Clock::time_point deadline);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CALL_CONTEXT_H_
