#include "server/service/raster_service.h"

#include "server/service/unary_call.h"
#include "server/service/upload_call.h"

namespace terrane::server {

grpc::ServerReadReactor<v1::UploadRasterRequest>*
RasterServiceImpl::UploadRaster(grpc::CallbackServerContext* context,
                                v1::UploadRasterResponse* response) {
  return StartUpload(parts_, "UploadRaster", context, response,
                     parts_.actor->BeginRasterUpload());
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
