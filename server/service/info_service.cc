#include "server/service/info_service.h"

#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerUnaryReactor* InfoServiceImpl::GetServerInfo(
    grpc::CallbackServerContext* context, const v1::GetServerInfoRequest*,
    v1::GetServerInfoResponse* response) {
  return UnaryCall::Start(parts_, "GetServerInfo", context,
                          [this, response](std::stop_token, CallRecord*) {
                            *response = parts_.actor->GetServerInfo();
                            return absl::OkStatus();
                          });
}

}  // namespace terrane::server
