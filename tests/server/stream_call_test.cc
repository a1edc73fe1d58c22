// Streams over loopback with tiles that cost nothing: order, back-pressure,
// cancellation, refusal and drain.
#include "server/service/stream_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "server/service/status.h"
#include "tests/server/fake_actor.h"
#include "tests/server/scrape.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

using TileReader = grpc::ClientReader<v1::StreamTilesResponse>;

v1::StreamTilesRequest Tiles(int count, std::int64_t first = 0) {
  v1::StreamTilesRequest request;
  request.set_tile_size(count);
  request.set_first_tile(first);
  return request;
}

// Reads a whole stream, which must be in order; the number of tiles.
std::int64_t ReadAll(TileReader* reader, std::int64_t first,
                     std::size_t tile_bytes) {
  v1::StreamTilesResponse response;
  EXPECT_TRUE(reader->Read(&response));
  EXPECT_EQ(response.header().recipe_hash(), "sha256:fake");
  std::int64_t next = first;
  while (reader->Read(&response)) {
    EXPECT_EQ(response.tile().index(), next);
    EXPECT_EQ(response.tile().data(), FakeTileData(next, tile_bytes));
    ++next;
  }
  return next - first;
}

TEST(StreamCallTest, TilesComeInOrderAndWhole) {
  FakeActor actor;
  Served served(&actor);
  for (const std::size_t bytes : {0UL, 1UL, 100UL, 300'000UL}) {
    actor.tiles().tile_bytes = bytes;
    grpc::ClientContext context;
    const auto reader = served.terrain->StreamTiles(&context, Tiles(50));
    EXPECT_EQ(ReadAll(reader.get(), 0, bytes), 50);
    EXPECT_TRUE(reader->Finish().ok());
  }
}

TEST(StreamCallTest, ResumesAtTheFirstTileAskedFor) {
  FakeActor actor;
  Served served(&actor);
  for (const std::int64_t first : {1, 49, 50}) {
    grpc::ClientContext context;
    const auto reader = served.terrain->StreamTiles(&context, Tiles(50, first));
    EXPECT_EQ(ReadAll(reader.get(), first, 1024), 50 - first);
    EXPECT_TRUE(reader->Finish().ok());
  }
}

TEST(StreamCallTest, ManyStreamsAtOnceAllEnd) {
  FakeActor actor;
  ServerOptions options;
  options.workers = 2;
  Served served(&actor, options);
  std::vector<std::future<std::int64_t>> streams;
  for (int i = 0; i < 32; ++i) {
    streams.push_back(std::async(std::launch::async, [&served] {
      grpc::ClientContext context;
      const auto reader = served.terrain->StreamTiles(&context, Tiles(40));
      const std::int64_t count = ReadAll(reader.get(), 0, 1024);
      EXPECT_TRUE(reader->Finish().ok());
      return count;
    }));
  }
  for (auto& stream : streams) EXPECT_EQ(stream.get(), 40);
}

// gRPC and the kernel take in some megabytes that nobody reads; after that the
// stream holds still, at one tile being written and one ahead.
TEST(StreamCallTest, SlowReaderHoldsTheStream) {
  FakeActor actor;
  actor.tiles().tile_bytes = 8 << 20;
  Served served(&actor);
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(100));
  std::int64_t started = -1;
  ASSERT_TRUE(Eventually([&] {
    const std::int64_t before = started;
    started = actor.tiles().started;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return started == before && started > 0;
  }));
  EXPECT_LE(started, 4);
  EXPECT_EQ(ReadAll(reader.get(), 0, 8 << 20), 100);
  EXPECT_TRUE(reader->Finish().ok());
}

TEST(StreamCallTest, CancelStopsTheGeneration) {
  FakeActor actor;
  Served served(&actor);
  actor.tiles().hold = true;
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(100));
  v1::StreamTilesResponse header;
  EXPECT_TRUE(reader->Read(&header));
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started == 1; }));
  context.TryCancel();
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(Eventually([&] { return actor.tiles().stopped == 1; }));
  EXPECT_THAT(served.StopAndReadLog(), HasSubstr("\"code\":\"CANCELLED\""));
  EXPECT_EQ(actor.tiles().started, 1);
}

TEST(StreamCallTest, CancelOfAnUnreadStreamEndsIt) {
  FakeActor actor;
  actor.tiles().tile_bytes = 8 << 20;
  Served served(&actor);
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(1000));
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started >= 2; }));
  context.TryCancel();
  reader->Finish();
  EXPECT_THAT(served.StopAndReadLog(), HasSubstr("\"code\":\"CANCELLED\""));
  EXPECT_LT(actor.tiles().started, 10);
}

TEST(StreamCallTest, DeadlineStopsTheGeneration) {
  FakeActor actor;
  Served served(&actor);
  actor.tiles().hold = true;
  ASSERT_TRUE(EventuallyStarts(actor.tiles(), [&](auto deadline) {
    grpc::ClientContext context;
    context.set_deadline(deadline);
    const auto reader = served.terrain->StreamTiles(&context, Tiles(1));
    EXPECT_EQ(reader->Finish().error_code(),
              grpc::StatusCode::DEADLINE_EXCEEDED);
  }));
  EXPECT_TRUE(Eventually(
      [&] { return actor.tiles().stopped == actor.tiles().started; }));
  // By the client's clock or by the server's, whichever was first.
  EXPECT_THAT(served.StopAndReadLog(),
              AnyOf(HasSubstr("\"code\":\"DEADLINE_EXCEEDED\""),
                    HasSubstr("\"code\":\"CANCELLED\"")));
}

TEST(StreamCallTest, CancelStormLeavesAServerThatServes) {
  FakeActor actor;
  ServerOptions options;
  options.workers = 2;
  Served served(&actor, options);
  for (int i = 0; i < 200; ++i) {
    grpc::ClientContext context;
    const auto reader = served.terrain->StreamTiles(&context, Tiles(1000));
    v1::StreamTilesResponse response;
    for (int k = 0; k < i % 5; ++k) reader->Read(&response);
    context.TryCancel();
    reader->Finish();
  }
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(20));
  EXPECT_EQ(ReadAll(reader.get(), 0, 1024), 20);
  EXPECT_TRUE(reader->Finish().ok());
}

TEST(StreamCallTest, BeyondTheLineStreamsAreRefusedWithADelay) {
  FakeActor actor;
  actor.tiles().hold = true;
  ServerOptions options;
  options.limits.max_concurrent_streams = 1;
  Served served(&actor, options);
  // Of twelve, one runs and four wait.
  std::atomic<int> refused = 0;
  std::vector<std::future<grpc::Status>> streams;
  for (int i = 0; i < 12; ++i) {
    streams.push_back(std::async(std::launch::async, [&] {
      grpc::ClientContext context;
      const auto reader = served.terrain->StreamTiles(&context, Tiles(1));
      for (v1::StreamTilesResponse message; reader->Read(&message);) {
      }
      const grpc::Status status = reader->Finish();
      if (!status.ok()) ++refused;
      return status;
    }));
  }
  EXPECT_TRUE(Eventually([&] { return refused == 7; }));
  actor.tiles().hold = false;
  int served_streams = 0;
  for (auto& stream : streams) {
    const grpc::Status status = stream.get();
    if (status.ok()) {
      ++served_streams;
      continue;
    }
    EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    v1::ErrorStatus details;
    ASSERT_TRUE(details.ParseFromString(status.error_details()));
    EXPECT_EQ(details.details(0).type_url(),
              "type.googleapis.com/google.rpc.RetryInfo");
  }
  EXPECT_EQ(served_streams, 5);
}

TEST(StreamCallTest, WhatCannotEndInTimeIsRefusedBeforeATileIsMade) {
  FakeActor actor;
  actor.tiles().seconds = 100;
  Served served(&actor);
  const auto ask = [&served](std::chrono::seconds deadline) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + deadline);
    const auto reader = served.terrain->StreamTiles(&context, Tiles(3));
    for (v1::StreamTilesResponse message; reader->Read(&message);) {
    }
    return reader->Finish();
  };
  const grpc::Status status = ask(std::chrono::seconds(20));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("expected to take 100.00 s"));
  v1::ErrorStatus details;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.details(0).type_url(),
            "type.googleapis.com/google.rpc.RetryInfo");
  EXPECT_EQ(actor.tiles().started, 0);
  EXPECT_TRUE(ask(std::chrono::seconds(500)).ok());
  EXPECT_THAT(served.StopAndReadLog(), HasSubstr("\"reason\":\"deadline\""));
}

TEST(StreamCallTest, AReaderThatTakesNothingIsCut) {
  FakeActor actor;
  actor.tiles().tile_bytes = 8 << 20;
  ServerOptions options = WithHttp();
  options.stream_idle = std::chrono::milliseconds(300);
  Served served(&actor, options);
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(100));
  v1::StreamTilesResponse message;
  EXPECT_TRUE(reader->Read(&message));
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started >= 2; }));
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return Calls(text, "StreamTiles", "ABORTED") == 1;
  }));
  const std::int64_t started = actor.tiles().started;
  while (reader->Read(&message)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_EQ(actor.tiles().started, started);
  EXPECT_THAT(served.StopAndReadLog(), HasSubstr("\"code\":\"ABORTED\""));
}

TEST(UploadTest, OfAClientThatSendsNothingItsRoomIsFreeAgain) {
  const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  ServerOptions options = WithHttp();
  options.stream_idle = std::chrono::milliseconds(300);
  Served served(actor.get(), options);
  grpc::ClientContext context;
  v1::UploadRasterResponse response;
  const auto writer = served.raster->UploadRaster(&context, &response);
  v1::UploadRasterRequest header;
  header.mutable_header()->set_width(1000);
  header.mutable_header()->set_height(1000);
  header.mutable_header()->mutable_frame()->set_spacing_x(1);
  header.mutable_header()->mutable_frame()->set_spacing_y(1);
  EXPECT_TRUE(writer->Write(header));
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return Calls(text, "UploadRaster", "ABORTED") == 1;
  }));
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

// A machine that stands still may cut one stream; the next is left alone.
TEST(StreamCallTest, AReaderThatIsOnlySlowIsNot) {
  FakeActor actor;
  actor.tiles().tile_bytes = 4 << 20;
  ServerOptions options;
  options.stream_idle = std::chrono::milliseconds(1500);
  Served served(&actor, options);
  int messages = 0;
  grpc::Status status = grpc::Status::CANCELLED;
  for (int attempt = 0; attempt < 3 && !status.ok(); ++attempt) {
    grpc::ClientContext context;
    const auto reader = served.terrain->StreamTiles(&context, Tiles(10));
    v1::StreamTilesResponse message;
    for (messages = 0; reader->Read(&message); ++messages) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    status = reader->Finish();
  }
  EXPECT_EQ(messages, 11);
  EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST(StreamCallTest, DrainLetsARunningStreamEnd) {
  FakeActor actor;
  actor.tiles().hold = true;
  Served served(&actor);
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(30));
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started == 1; }));
  std::thread drain([&] {
    served.server().Drain(std::chrono::milliseconds(10),
                          std::chrono::seconds(60));
  });
  actor.tiles().hold = false;
  EXPECT_EQ(ReadAll(reader.get(), 0, 1024), 30);
  EXPECT_TRUE(reader->Finish().ok());
  drain.join();
  grpc::ClientContext late;
  EXPECT_EQ(served.terrain->StreamTiles(&late, Tiles(1))->Finish().error_code(),
            grpc::StatusCode::UNAVAILABLE);
}

TEST(StreamCallTest, DrainCancelsWhatOutlivesIt) {
  FakeActor actor;
  actor.tiles().hold = true;
  Served served(&actor);
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(30));
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started == 1; }));
  v1::StreamTilesResponse message;
  EXPECT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.has_header());
  served.server().Drain(std::chrono::milliseconds(0),
                        std::chrono::milliseconds(100));
  EXPECT_FALSE(reader->Read(&message));
  EXPECT_FALSE(reader->Finish().ok());
  EXPECT_EQ(actor.tiles().stopped, 1);
}

TEST(UnaryCallTest, CancelStopsTheWork) {
  FakeActor actor;
  actor.tiles().hold = true;
  Served served(&actor);
  grpc::ClientContext context;
  std::thread cancel([&] {
    EXPECT_TRUE(Eventually([&] { return actor.tiles().started == 1; }));
    context.TryCancel();
  });
  v1::GetProfileResponse response;
  EXPECT_EQ(served.terrain->GetProfile(&context, {}, &response).error_code(),
            grpc::StatusCode::CANCELLED);
  cancel.join();
  EXPECT_TRUE(Eventually([&] { return actor.tiles().stopped == 1; }));
}

TEST(UnaryCallTest, ServerFaultHasAnIdThatTheLogHasToo) {
  FakeActor actor;
  Served served(&actor);
  grpc::ClientContext context;
  context.AddMetadata("x-request-id", "test-17");
  v1::GetPresetResponse response;
  const grpc::Status status =
      served.terrain->GetPreset(&context, {}, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INTERNAL);
  EXPECT_EQ(status.error_message(), "internal error, request id test-17");
  EXPECT_EQ(context.GetServerInitialMetadata().find("x-request-id")->second,
            "test-17");
  const std::string log = served.StopAndReadLog();
  EXPECT_THAT(log, HasSubstr("\"request_id\":\"test-17\""));
  EXPECT_THAT(log, HasSubstr("\"error\":\"cannot read /etc/secret\""));
}

TEST(UnaryCallTest, BadRequestIdsAreReplaced) {
  FakeActor actor;
  Served served(&actor);
  grpc::ClientContext context;
  context.AddMetadata("x-request-id", "a\"b c");
  v1::GetHeightsResponse response;
  EXPECT_TRUE(served.terrain->GetHeights(&context, {}, &response).ok());
  const auto id = context.GetServerInitialMetadata().find("x-request-id");
  EXPECT_EQ(id->second.size(), 16U);
}

}  // namespace
}  // namespace terrane::server
