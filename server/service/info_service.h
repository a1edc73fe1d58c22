// InfoService over an Actor.
#ifndef TERRANE_SERVER_SERVICE_INFO_SERVICE_H_
#define TERRANE_SERVER_SERVICE_INFO_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/info.grpc.pb.h"

namespace terrane::server {

class InfoServiceImpl final : public v1::InfoService::CallbackService {
 public:
  explicit InfoServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerUnaryReactor* GetServerInfo(
      grpc::CallbackServerContext* context,
      const v1::GetServerInfoRequest* request,
      v1::GetServerInfoResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_INFO_SERVICE_H_
