#include "server/service/terrain_service.h"

#include <utility>

#include "server/service/prepare_call.h"
#include "server/service/stream_call.h"
#include "server/service/terrain_source.h"
#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerWriteReactor<grpc::ByteBuffer>* TerrainServiceImpl::StreamTiles(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  return StreamCall::Start(parts_, "StreamTiles", context,
                           MakeTerrainSource(parts_, *request));
}

grpc::ServerWriteReactor<v1::PrepareTerrainResponse>*
TerrainServiceImpl::PrepareTerrain(grpc::CallbackServerContext* context,
                                   const v1::PrepareTerrainRequest* request) {
  return PrepareCall::Start(parts_, context, request);
}

grpc::ServerUnaryReactor* TerrainServiceImpl::GetProfile(
    grpc::CallbackServerContext* context, const v1::GetProfileRequest* request,
    v1::GetProfileResponse* response) {
  return UnaryCall::Start(
      parts_, "GetProfile", context,
      Answer(response, [this, request](std::stop_token stop) {
        return parts_.actor->GetProfile(*request, std::move(stop));
      }));
}

grpc::ServerUnaryReactor* TerrainServiceImpl::GetHeights(
    grpc::CallbackServerContext* context, const v1::GetHeightsRequest* request,
    v1::GetHeightsResponse* response) {
  return UnaryCall::Start(
      parts_, "GetHeights", context,
      Answer(response, [this, request](std::stop_token stop) {
        return parts_.actor->GetHeights(*request, std::move(stop));
      }));
}

grpc::ServerUnaryReactor* TerrainServiceImpl::EstimateTiles(
    grpc::CallbackServerContext* context,
    const v1::EstimateTilesRequest* request,
    v1::EstimateTilesResponse* response) {
  return UnaryCall::Start(
      parts_, "EstimateTiles", context,
      Answer(response, [this, request](std::stop_token stop) {
        return parts_.actor->EstimateTiles(*request, std::move(stop));
      }));
}

grpc::ServerUnaryReactor* TerrainServiceImpl::GetPreset(
    grpc::CallbackServerContext* context, const v1::GetPresetRequest* request,
    v1::GetPresetResponse* response) {
  return UnaryCall::Start(parts_, "GetPreset", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->GetPreset(*request);
                          }));
}

}  // namespace terrane::server
