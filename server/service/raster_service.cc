#include "server/service/raster_service.h"

#include <chrono>
#include <memory>
#include <utility>

#include "server/service/status.h"
#include "server/service/unary_call.h"

namespace terrane::server {
namespace {

// One UploadRaster rpc: reads a message, hands it to a worker (hashing a chunk
// takes milliseconds), reads the next. One of both is always under way until
// Finish, so a cancelled call ends by itself: its read fails.
class UploadCall final
    : public grpc::ServerReadReactor<v1::UploadRasterRequest> {
 public:
  UploadCall(const ServiceParts& parts, grpc::CallbackServerContext* context,
             v1::UploadRasterResponse* response)
      : parts_(parts),
        context_(context),
        response_(response),
        record_(BeginCall("UploadRaster", context)),
        upload_(parts.actor->BeginUpload()) {
    StartRead(&part_);
  }

  void OnReadDone(bool ok) override {
    parts_.workers->Submit(
        [this, ok, submitted = Clock::now()](core::TileScratch*) {
          const Clock::time_point start = Clock::now();
          record_.queued += start - submitted;
          if (ok) {
            Add(start);
          } else {
            Complete(start);
          }
        });
  }

  void OnDone() override {
    parts_.log->Write(record_);
    delete this;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void Add(Clock::time_point start) {
    const absl::Status status = upload_->Add(part_);
    record_.bytes += static_cast<std::int64_t>(part_.chunk().size());
    record_.generated += Clock::now() - start;
    if (status.ok()) {
      StartRead(&part_);
    } else {
      End(status);
    }
  }

  void Complete(Clock::time_point start) {
    if (context_->IsCancelled()) return End(CancelStatus(*context_));
    absl::StatusOr<v1::UploadRasterResponse> response = upload_->Finish();
    record_.generated += Clock::now() - start;
    if (response.ok()) *response_ = *std::move(response);
    End(response.status());
  }

  void End(absl::Status status) {
    upload_.reset();
    record_.status = std::move(status);
    Finish(ToGrpcStatus(record_.status, record_.request_id));
  }

  const ServiceParts& parts_;
  grpc::CallbackServerContext* const context_;
  v1::UploadRasterResponse* const response_;
  CallRecord record_;
  std::unique_ptr<RasterUpload> upload_;
  v1::UploadRasterRequest part_;
};

}  // namespace

grpc::ServerReadReactor<v1::UploadRasterRequest>*
RasterServiceImpl::UploadRaster(grpc::CallbackServerContext* context,
                                v1::UploadRasterResponse* response) {
  return new UploadCall(parts_, context, response);
}

grpc::ServerUnaryReactor* RasterServiceImpl::GetRaster(
    grpc::CallbackServerContext* context, const v1::GetRasterRequest* request,
    v1::GetRasterResponse* response) {
  return UnaryCall::Start(parts_, "GetRaster", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->GetRaster(*request);
                          }));
}

}  // namespace terrane::server
