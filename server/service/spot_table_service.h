// SpotTableService over an Actor.
#ifndef TERRANE_SERVER_SERVICE_SPOT_TABLE_SERVICE_H_
#define TERRANE_SERVER_SERVICE_SPOT_TABLE_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/spot_table.grpc.pb.h"

namespace terrane::server {

class SpotTableServiceImpl final
    : public v1::SpotTableService::CallbackService {
 public:
  explicit SpotTableServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerReadReactor<v1::UploadSpotTableRequest>* UploadSpotTable(
      grpc::CallbackServerContext* context,
      v1::UploadSpotTableResponse* response) override;
  grpc::ServerUnaryReactor* GetSpotTable(
      grpc::CallbackServerContext* context,
      const v1::GetSpotTableRequest* request,
      v1::GetSpotTableResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_SPOT_TABLE_SERVICE_H_
