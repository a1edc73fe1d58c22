#include "server/service/spot_table_service.h"

#include "server/service/unary_call.h"
#include "server/service/upload_call.h"

namespace terrane::server {

grpc::ServerReadReactor<v1::UploadSpotTableRequest>*
SpotTableServiceImpl::UploadSpotTable(grpc::CallbackServerContext* context,
                                      v1::UploadSpotTableResponse* response) {
  return StartUpload(parts_, "UploadSpotTable", context, response,
                     parts_.actor->BeginSpotTableUpload());
}

grpc::ServerUnaryReactor* SpotTableServiceImpl::GetSpotTable(
    grpc::CallbackServerContext* context,
    const v1::GetSpotTableRequest* request,
    v1::GetSpotTableResponse* response) {
  return UnaryCall::Start(parts_, "GetSpotTable", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->GetSpotTable(*request);
                          }));
}

}  // namespace terrane::server
