#include "client/bench/load_call.h"

#include <fmt/format.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/client_callback.h>

#include <cmath>
#include <utility>
#include <vector>

#include "client/channel.h"
#include "client/flower_verifier.h"
#include "client/status_details.h"
#include "client/surface_verifier.h"
#include "client/tile_verifier.h"
#include "client/tree_verifiers.h"
#include "terrane/v1/flower.grpc.pb.h"
#include "terrane/v1/surface.grpc.pb.h"
#include "terrane/v1/terrain.grpc.pb.h"
#include "terrane/v1/tree.grpc.pb.h"

namespace terrane::client {
namespace {

constexpr std::int64_t kBytesOfVertex = 3 * sizeof(float);

// The services over one connection.
struct Connection {
  explicit Connection(const std::shared_ptr<grpc::Channel>& channel)
      : terrain(v1::TerrainService::NewStub(channel)),
        surface(v1::SurfaceService::NewStub(channel)),
        tree(v1::TreeService::NewStub(channel)),
        flower(v1::FlowerService::NewStub(channel)) {}

  std::unique_ptr<v1::TerrainService::Stub> terrain;
  std::unique_ptr<v1::SurfaceService::Stub> surface;
  std::unique_ptr<v1::TreeService::Stub> tree;
  std::unique_ptr<v1::FlowerService::Stub> flower;
};

struct Amount {
  std::int64_t samples = 0;
  std::int64_t bytes = 0;
};

std::int64_t SizeOf(const std::string& column) {
  return static_cast<std::int64_t>(column.size());
}

std::int64_t SamplesOf(const v1::Window& window) {
  return window.width() * window.height();
}

Amount AmountOf(const v1::HeightTile& tile) {
  return {SamplesOf(tile.window()), SizeOf(tile.data())};
}

Amount AmountOf(const v1::MeshTile& tile) {
  return {
      SamplesOf(tile.window()),
      SizeOf(tile.positions()) + SizeOf(tile.normals()) + SizeOf(tile.uvs())};
}

Amount AmountOf(const v1::StreamSurfaceResponse& message) {
  return message.has_height_tile() ? AmountOf(message.height_tile())
                                   : AmountOf(message.mesh_tile());
}

Amount AmountOf(const v1::SegmentRows& rows) {
  return {rows.rows(),
          SizeOf(rows.parents()) + SizeOf(rows.starts()) + SizeOf(rows.ends()) +
              SizeOf(rows.radius_starts()) + SizeOf(rows.radius_ends()) +
              SizeOf(rows.flags()) + SizeOf(rows.attaches()) +
              SizeOf(rows.chromosomes()) + SizeOf(rows.extensions())};
}

Amount AmountOf(const v1::StreamFlowerResponse& message) {
  if (message.has_prototype()) {
    const v1::PrototypePart& part = message.prototype();
    return {SizeOf(part.positions()) / kBytesOfVertex,
            SizeOf(part.positions()) + SizeOf(part.normals()) +
                SizeOf(part.uvs()) + SizeOf(part.colors()) +
                SizeOf(part.indices())};
  }
  const v1::InstanceRows& rows = message.instances();
  return {rows.rows(), SizeOf(rows.prototypes()) + SizeOf(rows.translations()) +
                           SizeOf(rows.rotations()) + SizeOf(rows.scales()) +
                           SizeOf(rows.organs()) + SizeOf(rows.numbers()) +
                           SizeOf(rows.plants())};
}

// What a stream's messages are, how it is opened, and what of a message is
// checked and counted.
struct TileStream {
  using Request = v1::StreamTilesRequest;
  using Response = v1::StreamTilesResponse;
  using Verifier = TileVerifier;
  static void Open(const Connection& connection, grpc::ClientContext* context,
                   const Request* request,
                   grpc::ClientReadReactor<Response>* reactor) {
    connection.terrain->async()->StreamTiles(context, request, reactor);
  }
  static const v1::HeightTile& PartOf(const Response& message) {
    return message.tile();
  }
};

struct SurfaceStream {
  using Request = v1::StreamSurfaceRequest;
  using Response = v1::StreamSurfaceResponse;
  using Verifier = SurfaceVerifier;
  static void Open(const Connection& connection, grpc::ClientContext* context,
                   const Request* request,
                   grpc::ClientReadReactor<Response>* reactor) {
    connection.surface->async()->StreamSurface(context, request, reactor);
  }
  static const Response& PartOf(const Response& message) { return message; }
};

struct TreeStream {
  using Request = v1::StreamTreeRequest;
  using Response = v1::StreamTreeResponse;
  using Verifier = TreeRowsVerifier;
  static void Open(const Connection& connection, grpc::ClientContext* context,
                   const Request* request,
                   grpc::ClientReadReactor<Response>* reactor) {
    connection.tree->async()->StreamTree(context, request, reactor);
  }
  static const v1::SegmentRows& PartOf(const Response& message) {
    return message.segments();
  }
};

struct FlowerStream {
  using Request = v1::StreamFlowerRequest;
  using Response = v1::StreamFlowerResponse;
  using Verifier = FlowerVerifier;
  static void Open(const Connection& connection, grpc::ClientContext* context,
                   const Request* request,
                   grpc::ClientReadReactor<Response>* reactor) {
    connection.flower->async()->StreamFlower(context, request, reactor);
  }
  static const Response& PartOf(const Response& message) { return message; }
};

// What streams and unary calls share.
class GrpcCall : public LoadCall {
 public:
  void Cancel() final { context_.TryCancel(); }
  grpc::ClientContext* context() { return &context_; }

 protected:
  explicit GrpcCall(OnResult on_result) : on_result_(std::move(on_result)) {}

  void Count(const Amount& amount) {
    if (!result_.first_data.has_value()) result_.first_data = LoadClock::now();
    ++result_.tiles;
    result_.samples += amount.samples;
    result_.bytes += amount.bytes;
  }

  // Hands the result on; the last thing that the call does. `verified` is what
  // the client found of an answer that the server ended well, or that the
  // client cut because it was wrong.
  void End(const grpc::Status& status, const absl::Status& verified) {
    result_.end = LoadClock::now();
    if (!verified.ok()) {
      result_.code = grpc::StatusCode::DATA_LOSS;
      result_.message = std::string(verified.message());
    } else if (!status.ok()) {
      const RemoteError error =
          DecodeStatus(status, context_.GetServerTrailingMetadata());
      result_.code = status.error_code();
      result_.message = std::string(error.status.message());
      result_.retry_delay = error.retry_delay;
    }
    // The receiver may destroy this call, and with it its own function.
    const OnResult on_result = std::move(on_result_);
    on_result(std::move(result_));
  }

 private:
  grpc::ClientContext context_;
  OnResult on_result_;
  CallResult result_;
};

template <typename Stream>
class StreamCall final
    : public GrpcCall,
      private grpc::ClientReadReactor<typename Stream::Response> {
 public:
  StreamCall(const Connection* connection, typename Stream::Request request,
             OnResult on_result)
      : GrpcCall(std::move(on_result)),
        connection_(connection),
        request_(std::move(request)),
        verifier_(request_) {}

  void Start() override {
    Stream::Open(*connection_, context(), &request_, this);
    this->StartRead(&message_);
    this->StartCall();
  }

 private:
  void OnReadDone(bool ok) override {
    if (!ok) return;  // the status comes next
    if (message_.has_header()) {
      verified_ = verifier_.CheckHeader(message_.header());
    } else {
      verified_ = verifier_.CheckTile(Stream::PartOf(message_));
      if (verified_.ok()) Count(AmountOf(Stream::PartOf(message_)));
    }
    if (verified_.ok()) {
      this->StartRead(&message_);
    } else {
      Cancel();
    }
  }

  void OnDone(const grpc::Status& status) override {
    if (status.ok() && verified_.ok()) verified_ = verifier_.CheckEnd();
    End(status, verified_);
  }

  const Connection* const connection_;
  const typename Stream::Request request_;
  typename Stream::Verifier verifier_;
  typename Stream::Response message_;
  absl::Status verified_;
};

// A profile has no checksum: as many heights as were asked for, each a number.
absl::Status CheckProfile(const v1::GetProfileRequest& request,
                          const v1::GetProfileResponse& response) {
  if (response.heights_size() != request.count() ||
      response.macro_heights_size() != request.count()) {
    return absl::DataLossError(
        "the profile has " + std::to_string(response.heights_size()) +
        " heights, expected " + std::to_string(request.count()));
  }
  for (const float height : response.heights()) {
    if (!std::isfinite(height)) {
      return absl::DataLossError("the profile has a height that is no number");
    }
  }
  return absl::OkStatus();
}

class ProfileCall final : public GrpcCall {
 public:
  ProfileCall(const Connection* connection, v1::GetProfileRequest request,
              OnResult on_result)
      : GrpcCall(std::move(on_result)),
        connection_(connection),
        request_(std::move(request)) {}

  void Start() override {
    connection_->terrain->async()->GetProfile(
        context(), &request_, &response_,
        [this](const grpc::Status& status) { OnDone(status); });
  }

 private:
  void OnDone(const grpc::Status& status) {
    absl::Status verified;
    if (status.ok()) verified = CheckProfile(request_, response_);
    if (status.ok() && verified.ok()) {
      const std::int64_t heights = response_.heights_size();
      Count({heights, 2 * heights * std::int64_t{sizeof(float)}});
    }
    End(status, verified);
  }

  const Connection* const connection_;
  const v1::GetProfileRequest request_;
  v1::GetProfileResponse response_;
};

class GrpcCallMaker final : public CallMaker {
 public:
  GrpcCallMaker(std::vector<Connection> connections, int clients,
                const Workload* workload)
      : workload_(workload),
        names_clients_(clients > 1),
        connections_(std::move(connections)) {}

  std::unique_ptr<LoadCall> Make(const PlannedRequest& plan,
                                 LoadClock::time_point deadline,
                                 LoadCall::OnResult on_result) override {
    std::unique_ptr<GrpcCall> call = MakeOf(plan, std::move(on_result));
    // gRPC takes deadlines of the wall clock only; only the time left counts.
    call->context()->set_deadline(std::chrono::system_clock::now() +
                                  (deadline - LoadClock::now()));
    call->context()->AddMetadata("x-request-id",
                                 fmt::format("bench-{}", plan.number));
    if (names_clients_) {
      call->context()->AddMetadata("x-forwarded-for", AddressOf(plan.client));
    }
    return call;
  }

 private:
  // Of the network that RFC 2544 sets aside for benchmarks.
  static std::string AddressOf(int client) {
    return fmt::format("198.18.{}.{}", client / 250 % 250, client % 250 + 1);
  }

  std::unique_ptr<GrpcCall> MakeOf(const PlannedRequest& plan,
                                   LoadCall::OnResult on_result) const {
    const Connection* connection =
        &connections_[static_cast<std::size_t>(plan.number) %
                      connections_.size()];
    switch (plan.kind) {
      case RequestKind::kTiles:
        return std::make_unique<StreamCall<TileStream>>(
            connection, workload_->Tiles(plan), std::move(on_result));
      case RequestKind::kProfiles:
        return std::make_unique<ProfileCall>(
            connection, workload_->Profile(plan), std::move(on_result));
      case RequestKind::kSurfaces:
        return std::make_unique<StreamCall<SurfaceStream>>(
            connection, workload_->Surface(plan), std::move(on_result));
      case RequestKind::kTrees:
        return std::make_unique<StreamCall<TreeStream>>(
            connection, workload_->Tree(plan), std::move(on_result));
      case RequestKind::kFlowers:
        break;
    }
    return std::make_unique<StreamCall<FlowerStream>>(
        connection, workload_->Flower(plan), std::move(on_result));
  }

  const Workload* const workload_;
  const bool names_clients_;
  const std::vector<Connection> connections_;
};

// gRPC 1.51 now and then frees the queue of its callbacks twice when the last
// channel that used it goes. So the first one stays for as long as the process.
void KeepOne(const std::shared_ptr<grpc::Channel>& channel) {
  static auto& kept = *new std::vector<std::shared_ptr<grpc::Channel>>;
  if (kept.empty()) kept.push_back(channel);
}

}  // namespace

absl::StatusOr<std::unique_ptr<CallMaker>> MakeGrpcCalls(
    const std::string& server, const ChannelSecurity& security, int connections,
    int clients, const Workload* workload) {
  std::vector<Connection> opened;
  for (int i = 0; i < connections; ++i) {
    const absl::StatusOr<std::shared_ptr<grpc::Channel>> channel =
        OpenChannel(server, security, ChannelKind::kOwnConnection);
    if (!channel.ok()) return channel.status();
    KeepOne(*channel);
    opened.emplace_back(*channel);
  }
  return std::make_unique<GrpcCallMaker>(std::move(opened), clients, workload);
}

}  // namespace terrane::client
