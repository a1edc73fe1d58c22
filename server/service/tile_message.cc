#include "server/service/tile_message.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/slice.h>

#include <string>
#include <utility>

namespace terrane::server {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedOutputStream;

constexpr std::uint32_t kTileTag =
    WireFormatLite::MakeTag(v1::StreamTilesResponse::kTileFieldNumber,
                            WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
constexpr std::uint32_t kDataTag =
    WireFormatLite::MakeTag(v1::HeightTile::kDataFieldNumber,
                            WireFormatLite::WIRETYPE_LENGTH_DELIMITED);

// Bytes that gRPC holds until they are sent.
struct HeldBytes {
  std::unique_ptr<std::string> data;
  std::shared_ptr<BufferPool> buffers;
};

void Release(void* held_bytes) {
  const std::unique_ptr<HeldBytes> held(static_cast<HeldBytes*>(held_bytes));
  held->buffers->Give(std::move(held->data));
}

// Everything of the message before its heights. `fields` is the tile without
// them; the heights are put last, where a parser takes any field.
std::string Head(const v1::HeightTile& fields, std::size_t data_size) {
  const std::size_t size_of_data_size =
      CodedOutputStream::VarintSize32(static_cast<std::uint32_t>(data_size));
  const std::size_t tile_size = fields.ByteSizeLong() +
                                CodedOutputStream::VarintSize32(kDataTag) +
                                size_of_data_size + data_size;
  std::string head;
  google::protobuf::io::StringOutputStream sink(&head);
  CodedOutputStream out(&sink);
  out.WriteTag(kTileTag);
  out.WriteVarint32(static_cast<std::uint32_t>(tile_size));
  fields.SerializeWithCachedSizes(&out);
  out.WriteTag(kDataTag);
  out.WriteVarint32(static_cast<std::uint32_t>(data_size));
  out.Trim();
  return head;
}

}  // namespace

grpc::ByteBuffer TakeTileMessage(std::shared_ptr<BufferPool> buffers,
                                 v1::HeightTile* tile) {
  auto held = std::make_unique<HeldBytes>();
  held->data.reset(tile->release_data());
  held->buffers = std::move(buffers);
  std::string* data = held->data.get();
  const grpc::Slice slices[] = {
      grpc::Slice(Head(*tile, data->size())),
      grpc::Slice(data->data(), data->size(), Release, held.release())};
  return grpc::ByteBuffer(slices, 2);
}

grpc::ByteBuffer HeaderMessage(const v1::StreamHeader& header) {
  v1::StreamTilesResponse message;
  *message.mutable_header() = header;
  const grpc::Slice slice(message.SerializeAsString());
  return grpc::ByteBuffer(&slice, 1);
}

}  // namespace terrane::server
