// A server that misbehaves on purpose, and what starts it.
#ifndef TERRANE_TESTS_CLIENT_FAULTY_SERVER_H_
#define TERRANE_TESTS_CLIENT_FAULTY_SERVER_H_

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <xxhash.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "terrane/v1/common.pb.h"
#include "terrane/v1/raster.grpc.pb.h"
#include "terrane/v1/spot_table.grpc.pb.h"
#include "terrane/v1/terrain.grpc.pb.h"

namespace terrane::client {

// What its streams hold: one sample a tile.
constexpr std::int64_t kTiles = 6;

inline v1::StreamTilesResponse Header() {
  v1::StreamTilesResponse message;
  v1::StreamHeader* header = message.mutable_header();
  header->set_tile_size(1);
  header->set_tile_columns(kTiles);
  header->set_tile_rows(1);
  header->mutable_window()->set_width(kTiles);
  header->mutable_window()->set_height(1);
  return message;
}

inline v1::HeightTile Tile(std::int64_t index) {
  v1::HeightTile tile;
  tile.set_index(index);
  tile.set_total(kTiles);
  tile.mutable_window()->set_x(index);
  tile.mutable_window()->set_width(1);
  tile.mutable_window()->set_height(1);
  tile.set_data(std::string(4, static_cast<char>('0' + index)));
  tile.set_checksum(XXH3_64bits(tile.data().data(), tile.data().size()));
  return tile;
}

// One detail of a status, as a server packs it.
inline std::string Details(const std::string& type,
                           const google::protobuf::Message& message) {
  v1::ErrorStatus details;
  google::protobuf::Any* detail = details.add_details();
  detail->set_type_url("type.googleapis.com/google.rpc." + type);
  detail->set_value(message.SerializeAsString());
  return details.SerializeAsString();
}

inline grpc::Status NotKept(const std::string& reason, const std::string& key,
                            const std::string& id) {
  v1::ErrorInfo info;
  info.set_reason(reason);
  info.set_domain("terrane");
  (*info.mutable_metadata())[key] = id;
  return {grpc::StatusCode::NOT_FOUND, "gone", Details("ErrorInfo", info)};
}

// A refusal that asks to come back after a while.
inline grpc::Status ComeBackAfter(std::chrono::milliseconds delay) {
  v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(delay.count() / 1000);
  retry.mutable_retry_delay()->set_nanos(
      static_cast<std::int32_t>(delay.count() % 1000 * 1'000'000));
  return {grpc::StatusCode::RESOURCE_EXHAUSTED, "busy",
          Details("RetryInfo", retry)};
}

// Serves a stream of kTiles tiles; the tests set how it fails.
class FaultyServer : public v1::TerrainService::Service,
                     public v1::RasterService::Service,
                     public v1::SpotTableService::Service {
 public:
  grpc::Status StreamTiles(
      grpc::ServerContext* context, const v1::StreamTilesRequest* request,
      grpc::ServerWriter<v1::StreamTilesResponse>* writer) override {
    first_tiles.push_back(request->first_tile());
    if (!kept_raster) {
      return NotKept("RASTER_NOT_FOUND", "raster_id", "sha256:r");
    }
    if (!kept_table) {
      return NotKept("SPOT_TABLE_NOT_FOUND", "table_id", "sha256:t");
    }
    v1::StreamTilesResponse message = Header();
    writer->Write(message);
    for (std::int64_t i = request->first_tile(); i < kTiles; ++i) {
      if (i == request->first_tile() + tiles_before_cut) {
        return {grpc::StatusCode::UNAVAILABLE, "cut"};
      }
      if (i == silent_before && (always_silent || first_tiles.size() == 1)) {
        Hang(context);
        return {grpc::StatusCode::UNAVAILABLE, "cut"};
      }
      *message.mutable_tile() = Tile(i);
      if (i == damaged_tile) {
        damaged_tile = -1;
        (*message.mutable_tile()->mutable_data())[0] = '?';
      }
      writer->Write(message);
    }
    if (hang) Hang(context);
    saw_cancel = context->IsCancelled();
    return grpc::Status::OK;
  }

  grpc::Status GetPreset(grpc::ServerContext* context,
                         const v1::GetPresetRequest*,
                         v1::GetPresetResponse*) override {
    if (!pushback.empty()) {
      context->AddTrailingMetadata("grpc-retry-pushback-ms", pushback);
    }
    return ++preset_calls > failing_preset_calls ? grpc::Status()
                                                 : preset_status;
  }

  grpc::Status UploadRaster(grpc::ServerContext*,
                            grpc::ServerReader<v1::UploadRasterRequest>* reader,
                            v1::UploadRasterResponse* response) override {
    v1::UploadRasterRequest part;
    std::string samples;
    while (reader->Read(&part)) samples += part.chunk();
    uploads.push_back(samples.size());
    kept_raster = true;
    response->set_raster_id("sha256:r");
    return grpc::Status::OK;
  }

  grpc::Status UploadSpotTable(
      grpc::ServerContext*,
      grpc::ServerReader<v1::UploadSpotTableRequest>* reader,
      v1::UploadSpotTableResponse* response) override {
    v1::UploadSpotTableRequest part;
    std::string columns;
    while (reader->Read(&part)) columns += part.chunk();
    uploads.push_back(columns.size());
    kept_table = true;
    response->set_table_id("sha256:t");
    return grpc::Status::OK;
  }

  grpc::Status PrepareTerrain(
      grpc::ServerContext* context, const v1::PrepareTerrainRequest*,
      grpc::ServerWriter<v1::PrepareTerrainResponse>* writer) override {
    ++prepare_calls;
    v1::PrepareTerrainResponse message;
    for (const double fraction : {0.25, 0.5}) {
      message.mutable_progress()->set_fraction(fraction);
      writer->Write(message);
      if (prepare_calls == silent_prepare_call) {
        Hang(context);
        return {grpc::StatusCode::UNAVAILABLE, "cut"};
      }
      if (prepare_calls == cut_prepare_call) {
        return {grpc::StatusCode::UNAVAILABLE, "cut"};
      }
    }
    if (dies_of_preparing) return {grpc::StatusCode::UNAVAILABLE, "cut"};
    if (!ends_without_result) {
      message.mutable_prepared()->set_recipe_hash("sha256:p");
      writer->Write(message);
    }
    return grpc::Status::OK;
  }

  std::int64_t tiles_before_cut = kTiles + 1;
  // The first stream says nothing more from this tile on, or each of them.
  std::int64_t silent_before = -1;
  bool always_silent = false;
  std::atomic<std::int64_t> damaged_tile = -1;
  bool hang = false;
  std::atomic<bool> kept_raster = true;
  std::atomic<bool> kept_table = true;
  int prepare_calls = 0;
  int cut_prepare_call = 0;
  int silent_prepare_call = 0;
  bool dies_of_preparing = false;
  bool ends_without_result = false;
  std::atomic<bool> saw_cancel = false;
  // Of the first so many calls.
  grpc::Status preset_status;
  int failing_preset_calls = 1000;
  std::string pushback;
  int preset_calls = 0;
  std::vector<std::int64_t> first_tiles;
  std::vector<std::size_t> uploads;

 private:
  static void Hang(grpc::ServerContext* context) {
    while (!context->IsCancelled()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
};

// Serves on a port of 127.0.0.1, a free one if it is 0, which then is set.
inline std::unique_ptr<grpc::Server> Serve(FaultyServer* faulty, int* port) {
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:" + std::to_string(*port),
                           grpc::InsecureServerCredentials(), port);
  builder.RegisterService(static_cast<v1::TerrainService::Service*>(faulty));
  builder.RegisterService(static_cast<v1::RasterService::Service*>(faulty));
  builder.RegisterService(static_cast<v1::SpotTableService::Service*>(faulty));
  return builder.BuildAndStart();
}

}  // namespace terrane::client

#endif  // TERRANE_TESTS_CLIENT_FAULTY_SERVER_H_
