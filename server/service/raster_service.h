// RasterService over an Actor.
#ifndef TERRANE_SERVER_SERVICE_RASTER_SERVICE_H_
#define TERRANE_SERVER_SERVICE_RASTER_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/raster.grpc.pb.h"

namespace terrane::server {

class RasterServiceImpl final : public v1::RasterService::CallbackService {
 public:
  explicit RasterServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerReadReactor<v1::UploadRasterRequest>* UploadRaster(
      grpc::CallbackServerContext* context,
      v1::UploadRasterResponse* response) override;
  grpc::ServerUnaryReactor* GetRaster(grpc::CallbackServerContext* context,
                                      const v1::GetRasterRequest* request,
                                      v1::GetRasterResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_RASTER_SERVICE_H_
