// TerrainService over an Actor: one thin handler per rpc.
#ifndef TERRANE_SERVER_SERVICE_TERRAIN_SERVICE_H_
#define TERRANE_SERVER_SERVICE_TERRAIN_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/terrain.grpc.pb.h"

namespace terrane::server {

// StreamTiles is raw, so that the heights of a tile go out without a copy
// (server/service/tile_message.h); the rest are messages.
using TerrainServiceBase =
    v1::TerrainService::WithRawCallbackMethod_StreamTiles<
        v1::TerrainService::WithCallbackMethod_PrepareTerrain<
            v1::TerrainService::WithCallbackMethod_GetProfile<
                v1::TerrainService::WithCallbackMethod_GetHeights<
                    v1::TerrainService::WithCallbackMethod_EstimateTiles<
                        v1::TerrainService::WithCallbackMethod_GetPreset<
                            v1::TerrainService::Service>>>>>>;

class TerrainServiceImpl final : public TerrainServiceBase {
 public:
  explicit TerrainServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamTiles(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerWriteReactor<v1::PrepareTerrainResponse>* PrepareTerrain(
      grpc::CallbackServerContext* context,
      const v1::PrepareTerrainRequest* request) override;
  grpc::ServerUnaryReactor* GetProfile(
      grpc::CallbackServerContext* context,
      const v1::GetProfileRequest* request,
      v1::GetProfileResponse* response) override;
  grpc::ServerUnaryReactor* GetHeights(
      grpc::CallbackServerContext* context,
      const v1::GetHeightsRequest* request,
      v1::GetHeightsResponse* response) override;
  grpc::ServerUnaryReactor* EstimateTiles(
      grpc::CallbackServerContext* context,
      const v1::EstimateTilesRequest* request,
      v1::EstimateTilesResponse* response) override;
  grpc::ServerUnaryReactor* GetPreset(grpc::CallbackServerContext* context,
                                      const v1::GetPresetRequest* request,
                                      v1::GetPresetResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TERRAIN_SERVICE_H_
