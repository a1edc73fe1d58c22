// A tile as the bytes of a StreamTilesResponse, without copying its heights.
#ifndef TERRANE_SERVER_SERVICE_TILE_MESSAGE_H_
#define TERRANE_SERVER_SERVICE_TILE_MESSAGE_H_

#include <grpcpp/support/byte_buffer.h>

#include <memory>

#include "server/service/buffer_pool.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

// The message in two slices: its other fields, serialized, and tile->data()
// itself, which a client parses as one StreamTilesResponse. Takes the data out
// of the tile; it goes to `buffers` when gRPC has sent it.
grpc::ByteBuffer TakeTileMessage(std::shared_ptr<BufferPool> buffers,
                                 v1::HeightTile* tile);

// The first message of a stream.
grpc::ByteBuffer HeaderMessage(const v1::StreamHeader& header);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TILE_MESSAGE_H_
