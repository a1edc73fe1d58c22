// Every kind of stream, cut every few messages with each code that a lost
// server or the proxy before it answers: what arrives is, byte for byte, what
// an uncut stream brings.
#include <gmock/gmock.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "client/local_backend.h"
#include "client/remote_backend.h"
#include "terrane/v1/flower.grpc.pb.h"
#include "terrane/v1/render.grpc.pb.h"
#include "terrane/v1/surface.grpc.pb.h"
#include "terrane/v1/terrain.grpc.pb.h"
#include "terrane/v1/tree.grpc.pb.h"

namespace terrane::client {
namespace {

using testing::SizeIs;

// Of a picture, only how much of it is done: as many as the server likes.
template <typename Part>
bool HasContent(const Part&) {
  return true;
}
bool HasContent(const v1::StreamRenderResponse& part) {
  return part.has_band();
}

// Serves what a LocalBackend makes, and cuts a stream after `parts_before_cut`
// messages with content.
class CuttingServer : public v1::TerrainService::Service,
                      public v1::SurfaceService::Service,
                      public v1::TreeService::Service,
                      public v1::FlowerService::Service,
                      public v1::RenderService::Service {
 public:
  grpc::Status StreamTiles(
      grpc::ServerContext*, const v1::StreamTilesRequest* request,
      grpc::ServerWriter<v1::StreamTilesResponse>* writer) override {
    return Send(
        writer, request->first_tile(),
        [](auto* message) { return message->mutable_tile(); },
        [&](const auto& on_header, const auto& on_part) {
          return local_.StreamTiles(*request, on_header, on_part, {});
        });
  }
  grpc::Status StreamSurface(
      grpc::ServerContext*, const v1::StreamSurfaceRequest* request,
      grpc::ServerWriter<v1::StreamSurfaceResponse>* writer) override {
    return Send(
        writer, request->first_tile(), [](auto* message) { return message; },
        [&](const auto& on_header, const auto& on_part) {
          return local_.StreamSurface(*request, on_header, on_part, {});
        });
  }
  grpc::Status StreamTree(
      grpc::ServerContext*, const v1::StreamTreeRequest* request,
      grpc::ServerWriter<v1::StreamTreeResponse>* writer) override {
    return Send(
        writer, request->from_row(),
        [](auto* message) { return message->mutable_segments(); },
        [&](const auto& on_header, const auto& on_part) {
          return local_.trees().StreamTree(*request, on_header, on_part, {});
        });
  }
  grpc::Status StreamTreeLeaves(
      grpc::ServerContext*, const v1::StreamTreeLeavesRequest* request,
      grpc::ServerWriter<v1::StreamTreeLeavesResponse>* writer) override {
    return Send(
        writer, request->from_leaf(),
        [](auto* message) { return message->mutable_leaves(); },
        [&](const auto& on_header, const auto& on_part) {
          return local_.trees().StreamTreeLeaves(*request, on_header, on_part,
                                                 {});
        });
  }
  grpc::Status StreamTreeMesh(
      grpc::ServerContext*, const v1::StreamTreeMeshRequest* request,
      grpc::ServerWriter<v1::StreamTreeMeshResponse>* writer) override {
    return Send(
        writer, request->first_block(),
        [](auto* message) { return message->mutable_block(); },
        [&](const auto& on_header, const auto& on_part) {
          return local_.trees().StreamTreeMesh(*request, on_header, on_part,
                                               {});
        });
  }
  grpc::Status StreamForest(
      grpc::ServerContext*, const v1::StreamForestRequest* request,
      grpc::ServerWriter<v1::StreamForestResponse>* writer) override {
    return Send(
        writer, request->first_tree(),
        [](auto* message) { return message->mutable_block(); },
        [&](const auto& on_header, const auto& on_part) {
          return local_.trees().StreamForest(*request, on_header, on_part, {});
        });
  }
  grpc::Status StreamFlower(
      grpc::ServerContext*, const v1::StreamFlowerRequest* request,
      grpc::ServerWriter<v1::StreamFlowerResponse>* writer) override {
    return Send(
        writer, request->first_part(), [](auto* message) { return message; },
        [&](const auto& on_header, const auto& on_part) {
          return local_.flowers().StreamFlower(*request, on_header, on_part,
                                               {});
        });
  }
  grpc::Status StreamRender(
      grpc::ServerContext*, const v1::StreamRenderRequest* request,
      grpc::ServerWriter<v1::StreamRenderResponse>* writer) override {
    return Send(
        writer, request->first_band(), [](auto* message) { return message; },
        [&](const auto& on_header, const auto& on_part) {
          return local_.renders().StreamRender(*request, on_header, on_part,
                                               {});
        });
  }

  grpc::StatusCode code = grpc::StatusCode::UNAVAILABLE;
  int parts_before_cut = 1;
  // Where each stream was asked to begin.
  std::vector<std::int64_t> begins;

 private:
  // `part_of` is where in a message the parts of `stream` belong.
  template <typename Message, typename PartOf, typename Stream>
  grpc::Status Send(grpc::ServerWriter<Message>* writer, std::int64_t begin,
                    const PartOf& part_of, const Stream& stream) {
    begins.push_back(begin);
    int parts = 0;
    const absl::Status status = stream(
        [&](const auto& header) {
          Message message;
          *message.mutable_header() = header;
          writer->Write(message);
          return absl::OkStatus();
        },
        [&](const auto& part) {
          if (HasContent(part) && parts++ == parts_before_cut) {
            return absl::AbortedError("cut");
          }
          Message message;
          *part_of(&message) = part;
          writer->Write(message);
          return absl::OkStatus();
        });
    return status.ok() ? grpc::Status() : grpc::Status(code, "cut");
  }

  LocalBackend local_{1};
};

// What came of a stream, in pieces that are the same wherever it was cut.
struct Received {
  int headers = 0;
  std::vector<std::string> pieces;
};

template <typename Part>
void AddPieces(const Part& part, std::vector<std::string>* pieces) {
  pieces->push_back(part.SerializeAsString());
}
// The rows of a tree: a stream begins with a short message, a resumed one too.
void AddPieces(const v1::SegmentRows& part, std::vector<std::string>* pieces) {
  const auto rows = static_cast<std::size_t>(part.rows());
  for (std::size_t k = 0; k < rows; ++k) {
    std::string& row = pieces->emplace_back();
    for (const std::string* column :
         {&part.parents(), &part.starts(), &part.ends(), &part.radius_starts(),
          &part.radius_ends(), &part.flags(), &part.attaches(),
          &part.chromosomes(), &part.extensions()}) {
      const std::size_t bytes = column->size() / rows;
      row += column->substr(k * bytes, bytes);
    }
  }
}

auto TakeHeader(Received* received) {
  return [received](const auto&) {
    ++received->headers;
    return absl::OkStatus();
  };
}
auto TakePart(Received* received) {
  return [received](const auto& part) {
    if (HasContent(part)) AddPieces(part, &received->pieces);
    return absl::OkStatus();
  };
}

struct Kind {
  const char* name;
  std::function<absl::Status(Backend*, Received*)> stream;
  int parts_before_cut = 1;
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

v1::TreeChoice Tree() {
  v1::TreeChoice tree;
  tree.mutable_recipe()->set_dimensions(3);
  tree.mutable_recipe()->mutable_leaves();
  tree.set_depth(8);
  return tree;
}

absl::Status Tiles(Backend* backend, Received* received) {
  v1::StreamTilesRequest request;
  request.mutable_terrain()->mutable_recipe()->set_seed(5);
  request.set_level(9);
  request.mutable_window()->set_width(64);
  request.mutable_window()->set_height(48);
  request.set_tile_size(16);
  return backend->StreamTiles(request, TakeHeader(received), TakePart(received),
                              {});
}

absl::Status Surface(Backend* backend, Received* received) {
  v1::StreamSurfaceRequest request;
  request.mutable_surface()->set_preset("surface/fig12");
  request.set_columns(70);
  request.set_rows(60);
  request.set_tile_size(16);
  return backend->StreamSurface(request, TakeHeader(received),
                                TakePart(received), {});
}

absl::Status TreeRows(Backend* backend, Received* received) {
  v1::StreamTreeRequest request;
  *request.mutable_tree() = Tree();
  return backend->trees().StreamTree(request, TakeHeader(received),
                                     TakePart(received), {});
}

absl::Status TreeLeaves(Backend* backend, Received* received) {
  v1::StreamTreeLeavesRequest request;
  *request.mutable_tree() = Tree();
  return backend->trees().StreamTreeLeaves(request, TakeHeader(received),
                                           TakePart(received), {});
}

absl::Status TreeTubes(Backend* backend, Received* received) {
  v1::StreamTreeMeshRequest request;
  *request.mutable_tree() = Tree();
  return backend->trees().StreamTreeMesh(request, TakeHeader(received),
                                         TakePart(received), {});
}

absl::Status Forest(Backend* backend, Received* received) {
  v1::StreamForestRequest request;
  *request.mutable_tree() = Tree();
  request.mutable_tree()->set_depth(3);
  request.mutable_seeds()->set_count(5);
  request.set_leaves(true);  // a message beside the rows of each tree
  return backend->trees().StreamForest(request, TakeHeader(received),
                                       TakePart(received), {});
}

absl::Status Flower(Backend* backend, Received* received) {
  v1::StreamFlowerRequest request;
  request.mutable_flower()->set_preset("flower/tulip");
  request.mutable_flower()->set_plants(3);
  return backend->flowers().StreamFlower(request, TakeHeader(received),
                                         TakePart(received), {});
}

absl::Status Render(Backend* backend, Received* received) {
  v1::StreamRenderRequest request;
  v1::SurfaceSubject* const subject = request.mutable_surface();
  subject->mutable_surface()->set_preset("surface/fig07");
  subject->set_columns(17);
  subject->set_rows(17);
  request.set_width(64);
  request.set_height(48);
  request.set_passes(16);
  return backend->renders().StreamRender(request, TakeHeader(received),
                                         TakePart(received), {});
}

const Kind kKinds[] = {{"Tiles", Tiles},
                       {"Surface", Surface},
                       {"TreeRows", TreeRows},
                       {"TreeLeaves", TreeLeaves},
                       {"TreeTubes", TreeTubes},
                       // One tree and half of the next.
                       {"Forest", Forest, 3},
                       {"Flower", Flower},
                       {"Render", Render}};

class ResumeTest : public testing::Test {
 protected:
  void SetUp() override {
    int port = 0;
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(),
                             &port);
    const auto add = [&](grpc::Service* service) {
      builder.RegisterService(service);
    };
    add(static_cast<v1::TerrainService::Service*>(&cutting_));
    add(static_cast<v1::SurfaceService::Service*>(&cutting_));
    add(static_cast<v1::TreeService::Service*>(&cutting_));
    add(static_cast<v1::FlowerService::Service*>(&cutting_));
    add(static_cast<v1::RenderService::Service*>(&cutting_));
    server_ = builder.BuildAndStart();
    ASSERT_NE(server_, nullptr);
    Patience patience;
    patience.wait = [](std::chrono::milliseconds, std::stop_token) {
      return true;
    };
    remote_ = std::make_unique<RemoteBackend>(
        "127.0.0.1:" + std::to_string(port), ChannelSecurity(), patience);
  }
  void TearDown() override { server_->Shutdown(); }

  CuttingServer cutting_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<RemoteBackend> remote_;
};

class ResumeOfTest
    : public ResumeTest,
      public testing::WithParamInterface<std::tuple<Kind, grpc::StatusCode>> {};

TEST_P(ResumeOfTest, BringsTheSameBytes) {
  const auto& [kind, code] = GetParam();
  Received whole;
  LocalBackend local(1);
  ASSERT_EQ(kind.stream(&local, &whole), absl::OkStatus());

  cutting_.code = code;
  cutting_.parts_before_cut = kind.parts_before_cut;
  Received resumed;
  ASSERT_EQ(kind.stream(remote_.get(), &resumed), absl::OkStatus());
  EXPECT_EQ(resumed.headers, 1);
  EXPECT_TRUE(resumed.pieces == whole.pieces);
  // Each goes on, none from the beginning.
  ASSERT_THAT(cutting_.begins, SizeIs(testing::Ge(2U)));
  for (std::size_t i = 1; i < cutting_.begins.size(); ++i) {
    EXPECT_GT(cutting_.begins[i], cutting_.begins[i - 1]);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , ResumeOfTest,
    testing::Combine(testing::ValuesIn(kKinds),
                     testing::Values(grpc::StatusCode::CANCELLED,
                                     grpc::StatusCode::UNKNOWN,
                                     grpc::StatusCode::INTERNAL,
                                     grpc::StatusCode::UNAVAILABLE)),
    [](const auto& test) {
      return std::get<0>(test.param).name +
             std::to_string(std::get<1>(test.param));
    });

TEST_F(ResumeTest, OtherCodesAreTheAnswer) {
  for (const grpc::StatusCode code :
       {grpc::StatusCode::INVALID_ARGUMENT, grpc::StatusCode::NOT_FOUND,
        grpc::StatusCode::FAILED_PRECONDITION, grpc::StatusCode::ABORTED,
        grpc::StatusCode::RESOURCE_EXHAUSTED,
        grpc::StatusCode::UNAUTHENTICATED}) {
    cutting_.code = code;
    cutting_.begins.clear();
    Received received;
    EXPECT_EQ(Tiles(remote_.get(), &received).code(),
              static_cast<absl::StatusCode>(code));
    EXPECT_THAT(cutting_.begins, SizeIs(1));
  }
}

// The tree that was cut comes again from its first row: what its receiver has
// seen is not handed on twice, and does not count as progress.
TEST_F(ResumeTest, TreeOfAForestThatKillsTheServerEachTimeIsGivenUp) {
  Received received;
  EXPECT_EQ(Forest(remote_.get(), &received).code(),
            absl::StatusCode::kUnavailable);
  EXPECT_THAT(cutting_.begins, SizeIs(9));
  EXPECT_THAT(received.pieces, SizeIs(1));
}

// As is a picture of which only its progress comes.
TEST_F(ResumeTest, PictureThatKillsTheServerEachTimeIsGivenUp) {
  cutting_.parts_before_cut = 0;
  Received received;
  EXPECT_EQ(Render(remote_.get(), &received).code(),
            absl::StatusCode::kUnavailable);
  EXPECT_THAT(cutting_.begins, SizeIs(9));
}

}  // namespace
}  // namespace terrane::client
