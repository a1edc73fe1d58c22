#include "server/service/info_service.h"

#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerUnaryReactor* InfoServiceImpl::GetServerInfo(
    grpc::CallbackServerContext* context, const v1::GetServerInfoRequest*,
    v1::GetServerInfoResponse* response) {
  return UnaryCall::Start(
      parts_, "GetServerInfo", context,
      Answer(
          response,
          [this](std::stop_token) -> absl::StatusOr<v1::GetServerInfoResponse> {
            return parts_.actor->GetServerInfo();
          }));
}

}  // namespace terrane::server
