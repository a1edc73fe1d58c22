#include "client/remote_backend.h"

#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <utility>

#include "client/raster_upload.h"
#include "client/spot_upload.h"
#include "client/surface_verifier.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

// A tile of the largest size is just over gRPC's default of 4 MiB.
constexpr int kMaxMessageBytes = 64 << 20;

// Tries in a row that bring nothing new: few when the server was never reached,
// so that a wrong address shows at once; more to outlast a restart.
constexpr int kTriesBeforeContact = 3;
constexpr int kTriesAfterContact = 9;

constexpr milliseconds kFirstWait{100};
constexpr milliseconds kLongestWait{2'000};
constexpr milliseconds kLongestAskedWait{30'000};

bool WorthAnotherTry(const RemoteError& error, bool stream) {
  switch (error.status.code()) {
    case absl::StatusCode::kUnavailable:
      return true;
    case absl::StatusCode::kResourceExhausted:
      return error.retry_delay.has_value();
    // What a balancer answers when its backend dies, and a damaged tile.
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kDataLoss:
      return stream;
    default:
      return false;
  }
}

// Sleeps; false when asked to stop meanwhile.
bool Sleep(milliseconds duration, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
  return !stop.stop_requested();
}

// Cancels the call on the server as soon as `stop` is asked for.
class CancelOnStop {
 public:
  CancelOnStop(std::stop_token stop, grpc::ClientContext* context)
      : callback_(std::move(stop), Cancel{context}) {}

 private:
  struct Cancel {
    void operator()() const { context->TryCancel(); }
    grpc::ClientContext* context;
  };
  std::stop_callback<Cancel> callback_;
};

// Writes the parts that `send` makes of the content, and ends the call.
template <typename Content, typename Request>
grpc::Status WriteParts(
    const Content& content,
    absl::Status (*send)(const Content&,
                         const std::function<absl::Status(const Request&)>&),
    grpc::ClientWriter<Request>* writer) {
  // A refused part shows as the status of Finish.
  const absl::Status sent = send(content, [&](const Request& part) {
    return writer->Write(part) ? absl::OkStatus()
                               : absl::CancelledError("refused");
  });
  if (sent.ok()) writer->WritesDone();
  return writer->Finish();
}

bool IsThisMachine(const std::string& target) {
  return target.starts_with("127.") || target.starts_with("localhost:") ||
         target.starts_with("[::1]:");
}

std::shared_ptr<grpc::Channel> MakeChannel(const std::string& target) {
  grpc::ChannelArguments arguments;
  // A proxy of the environment is the way to other machines.
  if (IsThisMachine(target)) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  // A restarted server is found again within our own waits.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1'000);
  return grpc::CreateCustomChannel(target, grpc::InsecureChannelCredentials(),
                                   arguments);
}

// What a message that is no header brings.
const v1::HeightTile& TileOf(const v1::StreamTilesResponse& message) {
  return message.tile();
}
const v1::StreamSurfaceResponse& TileOf(
    const v1::StreamSurfaceResponse& message) {
  return message;
}

}  // namespace

RemoteBackend::RemoteBackend(const std::string& target) : target_(target) {
  const std::shared_ptr<grpc::Channel> channel = MakeChannel(target);
  terrain_ = v1::TerrainService::NewStub(channel);
  surface_ = v1::SurfaceService::NewStub(channel);
  raster_ = v1::RasterService::NewStub(channel);
  spot_table_ = v1::SpotTableService::NewStub(channel);
  info_ = v1::InfoService::NewStub(channel);
}

absl::Status RemoteBackend::Run(CallKind kind,
                                const std::function<Attempt()>& attempt,
                                std::stop_token stop) {
  int failures = 0;
  int allowed = kTriesBeforeContact;
  std::set<std::string> uploaded_again;
  while (true) {
    const Attempt result = attempt();
    const RemoteError& error = result.error;
    if (error.status.ok() || result.final) return error.status;
    if (stop.stop_requested()) return absl::CancelledError("interrupted");
    if (uploads_.contains(error.missing_content) &&
        uploaded_again.insert(error.missing_content).second) {
      const absl::Status status = UploadAgain(error.missing_content, stop);
      if (!status.ok()) return status;
      continue;
    }
    if (result.progressed) {
      failures = 0;
      allowed = kTriesAfterContact;
    }
    ++failures;
    if (!WorthAnotherTry(error, kind == CallKind::kStream) ||
        failures >= allowed) {
      if (error.status.code() != absl::StatusCode::kUnavailable) {
        return error.status;
      }
      return absl::UnavailableError("server " + target_ + " does not answer: " +
                                    std::string(error.status.message()));
    }
    if (!Wait(error, failures, stop)) {
      return absl::CancelledError("interrupted");
    }
  }
}

bool RemoteBackend::Wait(const RemoteError& error, int failures,
                         std::stop_token stop) {
  const milliseconds backoff =
      std::min(kFirstWait * (1 << std::min(failures - 1, 10)), kLongestWait);
  // Between half and one and a half of it, so that clients do not return
  // together.
  std::uniform_int_distribution<milliseconds::rep> spread(
      backoff.count() / 2, backoff.count() * 3 / 2);
  milliseconds wait(spread(jitter_));
  if (error.retry_delay.has_value()) {
    wait += std::min(*error.retry_delay, kLongestAskedWait);
  }
  return Sleep(wait, stop);
}

absl::Status RemoteBackend::StreamTiles(const v1::StreamTilesRequest& request,
                                        const OnHeader& on_header,
                                        const OnTile& on_tile,
                                        std::stop_token stop) {
  TileVerifier verifier(request);
  v1::StreamTilesRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_tile(verifier.next_index());
    return terrain_->StreamTiles(context, rest);
  };
  return Run(
      CallKind::kStream,
      [&] {
        return StreamOnce<v1::StreamTilesResponse>(open, on_header, on_tile,
                                                   stop, &verifier);
      },
      stop);
}

absl::Status RemoteBackend::StreamSurface(
    const v1::StreamSurfaceRequest& request, const OnSurfaceHeader& on_header,
    const OnSurfaceTile& on_tile, std::stop_token stop) {
  SurfaceVerifier verifier(request);
  v1::StreamSurfaceRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_tile(verifier.next_index());
    return surface_->StreamSurface(context, rest);
  };
  return Run(
      CallKind::kStream,
      [&] {
        return StreamOnce<v1::StreamSurfaceResponse>(open, on_header, on_tile,
                                                     stop, &verifier);
      },
      stop);
}

template <typename Message, typename Open, typename Header, typename Tile,
          typename Verifier>
RemoteBackend::Attempt RemoteBackend::StreamOnce(const Open& open,
                                                 const Header& on_header,
                                                 const Tile& on_tile,
                                                 std::stop_token stop,
                                                 Verifier* verifier) {
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  const auto reader = open(&context);

  Attempt attempt;
  absl::Status status;
  Message message;
  while (status.ok() && reader->Read(&message)) {
    if (message.has_header()) {
      const bool first = !verifier->has_header();
      status = verifier->CheckHeader(message.header());
      if (status.ok() && first) {
        status = on_header(message.header());
        attempt.final = !status.ok();
        attempt.progressed = true;
      }
    } else {
      status = verifier->CheckTile(TileOf(message));
      if (status.ok()) {
        status = on_tile(TileOf(message));
        attempt.final = !status.ok();
        attempt.progressed = true;
      }
    }
  }
  if (!status.ok()) {
    context.TryCancel();
    reader->Finish();
    attempt.error.status = status;
    return attempt;
  }
  attempt.error = DecodeStatus(reader->Finish());
  if (attempt.error.status.ok()) attempt.error.status = verifier->CheckEnd();
  return attempt;
}

template <typename Response, typename Stub, typename Method, typename Request>
absl::StatusOr<Response> RemoteBackend::Unary(Stub* stub, Method method,
                                              const Request& request,
                                              std::stop_token stop) {
  Response response;
  const absl::Status status = Run(
      CallKind::kUnary,
      [&] {
        grpc::ClientContext context;
        const CancelOnStop cancel(stop, &context);
        return Attempt{
            DecodeStatus((stub->*method)(&context, request, &response))};
      },
      stop);
  if (!status.ok()) return status;
  return response;
}

absl::StatusOr<v1::GetProfileResponse> RemoteBackend::GetProfile(
    const v1::GetProfileRequest& request, std::stop_token stop) {
  return Unary<v1::GetProfileResponse>(
      terrain_.get(), &v1::TerrainService::Stub::GetProfile, request, stop);
}

absl::StatusOr<v1::GetHeightsResponse> RemoteBackend::GetHeights(
    const v1::GetHeightsRequest& request, std::stop_token stop) {
  return Unary<v1::GetHeightsResponse>(
      terrain_.get(), &v1::TerrainService::Stub::GetHeights, request, stop);
}

absl::StatusOr<v1::EstimateTilesResponse> RemoteBackend::EstimateTiles(
    const v1::EstimateTilesRequest& request, std::stop_token stop) {
  return Unary<v1::EstimateTilesResponse>(
      terrain_.get(), &v1::TerrainService::Stub::EstimateTiles, request, stop);
}

absl::StatusOr<v1::GetPresetResponse> RemoteBackend::GetPreset(
    const v1::GetPresetRequest& request, std::stop_token stop) {
  return Unary<v1::GetPresetResponse>(
      terrain_.get(), &v1::TerrainService::Stub::GetPreset, request, stop);
}

absl::StatusOr<v1::GetServerInfoResponse> RemoteBackend::GetServerInfo(
    std::stop_token stop) {
  return Unary<v1::GetServerInfoResponse>(info_.get(),
                                          &v1::InfoService::Stub::GetServerInfo,
                                          v1::GetServerInfoRequest(), stop);
}

absl::StatusOr<v1::EstimateSurfaceResponse> RemoteBackend::EstimateSurface(
    const v1::EstimateSurfaceRequest& request, std::stop_token stop) {
  return Unary<v1::EstimateSurfaceResponse>(
      surface_.get(), &v1::SurfaceService::Stub::EstimateSurface, request,
      stop);
}

absl::StatusOr<v1::GetSurfacePresetResponse> RemoteBackend::GetSurfacePreset(
    const v1::GetSurfacePresetRequest& request, std::stop_token stop) {
  return Unary<v1::GetSurfacePresetResponse>(
      surface_.get(), &v1::SurfaceService::Stub::GetSurfacePreset, request,
      stop);
}

absl::StatusOr<v1::GetRasterResponse> RemoteBackend::GetRaster(
    const v1::GetRasterRequest& request, std::stop_token stop) {
  return Unary<v1::GetRasterResponse>(
      raster_.get(), &v1::RasterService::Stub::GetRaster, request, stop);
}

absl::StatusOr<v1::PreparedTerrain> RemoteBackend::PrepareTerrain(
    const v1::PrepareTerrainRequest& request,
    const OnPrepareProgress& on_progress, std::stop_token stop) {
  v1::PreparedTerrain prepared;
  const absl::Status status = Run(
      CallKind::kUnary,
      [&] { return PrepareOnce(request, on_progress, stop, &prepared); }, stop);
  if (!status.ok()) return status;
  return prepared;
}

RemoteBackend::Attempt RemoteBackend::PrepareOnce(
    const v1::PrepareTerrainRequest& request,
    const OnPrepareProgress& on_progress, std::stop_token stop,
    v1::PreparedTerrain* prepared) {
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  const auto reader = terrain_->PrepareTerrain(&context, request);
  Attempt attempt;
  bool complete = false;
  v1::PrepareTerrainResponse message;
  while (reader->Read(&message)) {
    attempt.progressed = true;
    if (message.has_prepared()) {
      *prepared = message.prepared();
      complete = true;
    } else if (on_progress) {
      on_progress(message.progress().fraction());
    }
  }
  attempt.error = DecodeStatus(reader->Finish());
  if (attempt.error.status.ok() && !complete) {
    attempt.error.status =
        absl::DataLossError("the server ended without a prepared terrain");
  }
  return attempt;
}

absl::StatusOr<std::string> RemoteBackend::UploadRaster(
    std::shared_ptr<const core::Raster> raster, std::stop_token stop) {
  return Upload(
      [this, raster](std::stop_token upload_stop, std::string* id) {
        return UploadRasterOnce(*raster, std::move(upload_stop), id);
      },
      stop);
}

absl::StatusOr<std::string> RemoteBackend::UploadSpotTable(
    std::shared_ptr<const SpotTable> table, std::stop_token stop) {
  return Upload(
      [this, table](std::stop_token upload_stop, std::string* id) {
        return UploadTableOnce(*table, std::move(upload_stop), id);
      },
      stop);
}

absl::StatusOr<std::string> RemoteBackend::Upload(const UploadContent& upload,
                                                  std::stop_token stop) {
  std::string content_id;
  const absl::Status status = Run(
      CallKind::kUnary, [&] { return upload(stop, &content_id); }, stop);
  if (!status.ok()) return status;
  uploads_.insert_or_assign(content_id, upload);
  return content_id;
}

absl::Status RemoteBackend::UploadAgain(const std::string& content_id,
                                        std::stop_token stop) {
  // A copy: the upload keeps itself anew.
  const UploadContent upload = uploads_.at(content_id);
  const absl::StatusOr<std::string> answer = Upload(upload, stop);
  if (!answer.ok()) return answer.status();
  if (*answer != content_id) {
    return absl::DataLossError("the server calls the content " + content_id +
                               " now " + *answer);
  }
  return absl::OkStatus();
}

RemoteBackend::Attempt RemoteBackend::UploadRasterOnce(
    const core::Raster& raster, std::stop_token stop, std::string* raster_id) {
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  v1::UploadRasterResponse response;
  const auto writer = raster_->UploadRaster(&context, &response);
  Attempt attempt{DecodeStatus(WriteParts(raster, SendRaster, writer.get()))};
  *raster_id = response.raster_id();
  return attempt;
}

RemoteBackend::Attempt RemoteBackend::UploadTableOnce(const SpotTable& table,
                                                      std::stop_token stop,
                                                      std::string* table_id) {
  grpc::ClientContext context;
  const CancelOnStop cancel(stop, &context);
  v1::UploadSpotTableResponse response;
  const auto writer = spot_table_->UploadSpotTable(&context, &response);
  Attempt attempt{DecodeStatus(WriteParts(table, SendSpotTable, writer.get()))};
  *table_id = response.table_id();
  return attempt;
}

}  // namespace terrane::client
