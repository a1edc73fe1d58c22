// Calls of every kind over loopback: what the metrics, the probes and the log
// say of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/server/fake_actor.h"
#include "tests/server/recipe_text.h"
#include "tests/server/scrape.h"

namespace terrane::server {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsSubsetOf;
using ::testing::StartsWith;

v1::StreamTilesRequest Tiles(int count) {
  v1::StreamTilesRequest request;
  request.set_tile_size(count);
  return request;
}

// As many streams as a server takes that has room for one: it runs, four stand
// in line. The next one is turned away.
class FullLine {
 public:
  FullLine() { options_.limits.max_concurrent_streams = 1; }
  const ServerOptions& options() const { return options_; }

  // True when a stream was turned away, once five had come.
  bool Fill(Served* served) {
    for (int i = 0; i < 5; ++i) {
      contexts_.push_back(std::make_unique<grpc::ClientContext>());
      readers_.push_back(
          served->terrain->StreamTiles(contexts_.back().get(), Tiles(1)));
    }
    // Each counts as a millisecond, at least, from its arrival on.
    const bool all_came = EventuallyScraped(served, [](const Exposition& text) {
      return text["terrane_backlog_seconds{class=\"interactive\"}"] > 0.0045;
    });
    grpc::ClientContext context;
    return all_came &&
           served->terrain->StreamTiles(&context, Tiles(1))
                   ->Finish()
                   .error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
  }
  void Cancel() {
    for (const auto& context : contexts_) context->TryCancel();
  }

 private:
  ServerOptions options_ = WithHttp();
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts_;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::StreamTilesResponse>>>
      readers_;
};

// The lines of the log about calls, each of which must be a JSON object.
std::vector<nlohmann::json> CallLines(const std::string& log) {
  std::vector<nlohmann::json> lines;
  std::istringstream text(log);
  for (std::string line; std::getline(text, line);) {
    nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
    EXPECT_TRUE(object.is_object()) << line;
    if (object["event"] == "call") lines.push_back(std::move(object));
  }
  return lines;
}

TEST(ServedMetricsTest, StreamsUnaryCallsAndUploadsCount) {
  const std::unique_ptr<Actor> actor = MakeActor({}, 2);
  Served served(actor.get(), WithHttp());
  {
    grpc::ClientContext context;
    const auto reader = served.terrain->StreamTiles(
        &context, FromJson<v1::StreamTilesRequest>(
                      R"({"terrain": {"preset": "demo/hills"}, "tileSize": 16,
                "window": {"width": 32, "height": 32}})"));
    for (v1::StreamTilesResponse message; reader->Read(&message);) {
    }
    EXPECT_TRUE(reader->Finish().ok());
  }
  {
    grpc::ClientContext context;
    v1::GetPresetRequest request;
    request.set_name("no/such");
    v1::GetPresetResponse response;
    EXPECT_FALSE(served.terrain->GetPreset(&context, request, &response).ok());
  }
  {
    grpc::ClientContext context;
    v1::UploadRasterResponse response;
    const auto writer = served.raster->UploadRaster(&context, &response);
    writer->Write(FromJson<v1::UploadRasterRequest>(
        R"({"header": {"width": "10", "height": "5"}})"));
    v1::UploadRasterRequest chunk;
    chunk.set_chunk(std::string(200, '\0'));
    writer->Write(chunk);
    writer->WritesDone();
    EXPECT_TRUE(writer->Finish().ok());
  }
  {
    grpc::ClientContext context;
    const auto reader = served.terrain->PrepareTerrain(
        &context, FromJson<v1::PrepareTerrainRequest>(
                      R"({"terrain": {"preset": "demo/hills"}})"));
    for (v1::PrepareTerrainResponse message; reader->Read(&message);) {
    }
    EXPECT_TRUE(reader->Finish().ok());
  }
  {
    grpc::ClientContext context;
    v1::GetServerInfoResponse response;
    EXPECT_TRUE(served.info->GetServerInfo(&context, {}, &response).ok());
  }
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return Calls(text, "StreamTiles", "OK") == 1 &&
           Calls(text, "GetPreset", "NOT_FOUND") == 1 &&
           Calls(text, "UploadRaster", "OK") == 1 &&
           Calls(text, "PrepareTerrain", "OK") == 1 &&
           Calls(text, "GetServerInfo", "OK") == 1;
  }));
  const Exposition text = Scrape(&served);
  EXPECT_EQ(text["terrane_messages_total{method=\"StreamTiles\"}"], 4);
  EXPECT_EQ(text["terrane_samples_total{method=\"StreamTiles\"}"], 1024);
  EXPECT_EQ(text["terrane_bytes_total{method=\"StreamTiles\"}"], 4096);
  EXPECT_EQ(text["terrane_bytes_total{method=\"UploadRaster\"}"], 200);
  EXPECT_GT(text["terrane_bytes_total{method=\"GetServerInfo\"}"], 100);
  EXPECT_GT(text["terrane_work_seconds_total{method=\"StreamTiles\"}"], 0);
  // Preparing is batch work.
  EXPECT_EQ(text["terrane_queue_wait_seconds_count{class=\"interactive\"}"], 4);
  EXPECT_EQ(text["terrane_queue_wait_seconds_count{class=\"batch\"}"], 1);
  // A call takes at least what its work does.
  EXPECT_GE(text["terrane_rpc_seconds_sum{method=\"GetServerInfo\"}"],
            text["terrane_work_seconds_total{method=\"GetServerInfo\"}"]);
  EXPECT_EQ(text["terrane_rpc_seconds_count{method=\"StreamTiles\"}"], 1);
  EXPECT_EQ(text["terrane_workers"], 1);
  EXPECT_GT(text["terrane_memory_bytes"], 1 << 20);
}

// Handlers name themselves; the API has the same names.
TEST(ServedMetricsTest, MethodsAreThoseOfTheApi) {
  const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  Served served(actor.get(), WithHttp());
  const auto api = Scrape(&served).Labels("terrane_rpc_total")["method"];
  EXPECT_GE(api.size(), 25U);
  {
    grpc::ClientContext context;
    v1::EstimateRenderResponse response;
    served.render->EstimateRender(&context, {}, &response);
  }
  {
    grpc::ClientContext context;
    const auto reader = served.tree->StreamForest(&context, {});
    v1::StreamForestResponse message;
    EXPECT_FALSE(reader->Read(&message));
    reader->Finish();
  }
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return Calls(text, "EstimateRender", "INVALID_ARGUMENT") == 1 &&
           Calls(text, "StreamForest", "INVALID_ARGUMENT") == 1;
  }));
  EXPECT_EQ(Scrape(&served).Labels("terrane_rpc_total")["method"], api);
}

TEST(ServedMetricsTest, RefusedAndCancelledStreamsCount) {
  FakeActor actor;
  actor.tiles().hold = true;
  FullLine line;
  Served served(&actor, line.options());
  ASSERT_TRUE(line.Fill(&served));
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return Calls(text, "StreamTiles", "RESOURCE_EXHAUSTED") >= 1 &&
           text["terrane_refusals_total{reason=\"streams\"}"] ==
               Calls(text, "StreamTiles", "RESOURCE_EXHAUSTED") &&
           text["terrane_workers_busy"] == 1;
  }));
  line.Cancel();
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return Calls(text, "StreamTiles", "CANCELLED") >= 5 &&
           text["terrane_workers_busy"] == 0;
  }));
  // What has begun is over: done, refused or cancelled.
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    double over = 0;
    for (const char* code : {"OK", "RESOURCE_EXHAUSTED", "CANCELLED"}) {
      over += std::max(Calls(text, "StreamTiles", code), 0.0);
    }
    return text["terrane_rpc_begun_total{method=\"StreamTiles\"}"] == over;
  }));
}

TEST(ServedMetricsTest, MemoryLimitIsExportedWhenThereIsOne) {
  FakeActor actor;
  ServerOptions options = WithHttp();
  options.memory_limit_bytes = std::int64_t{1} << 30;
  Served limited(&actor, options);
  EXPECT_EQ(Scrape(&limited)["terrane_memory_limit_bytes"], 1 << 30);
  Served free(&actor, WithHttp());
  EXPECT_FALSE(Scrape(&free).Has("terrane_memory_limit_bytes"));
}

// Every process takes more than nine tenths of a megabyte.
TEST(ServedMemoryTest, StreamsAreRefusedWhenMemoryIsTight) {
  FakeActor actor;
  ServerOptions options = WithHttp();
  options.memory_limit_bytes = 1 << 20;
  Served served(&actor, options);
  grpc::ClientContext context;
  const grpc::Status status =
      served.terrain->StreamTiles(&context, Tiles(1))->Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(status.error_message(), "the server is short of memory; try again");
  EXPECT_TRUE(
      context.GetServerTrailingMetadata().contains("grpc-retry-pushback-ms"));
  EXPECT_TRUE(EventuallyScraped(&served, [](const Exposition& text) {
    return text["terrane_refusals_total{reason=\"memory\"}"] == 1;
  }));
  EXPECT_EQ(actor.tiles().started, 0);
  // So are other calls that generate.
  grpc::ClientContext heights_context;
  v1::GetHeightsResponse heights;
  EXPECT_EQ(
      served.terrain->GetHeights(&heights_context, {}, &heights).error_code(),
      grpc::StatusCode::RESOURCE_EXHAUSTED);
  grpc::ClientContext prepare_context;
  EXPECT_EQ(served.terrain->PrepareTerrain(&prepare_context, {})
                ->Finish()
                .error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(prepare_context.GetServerTrailingMetadata().contains(
      "grpc-retry-pushback-ms"));
  // What takes no memory is answered.
  grpc::ClientContext info_context;
  v1::GetServerInfoResponse response;
  EXPECT_TRUE(served.info->GetServerInfo(&info_context, {}, &response).ok());
}

TEST(ServedProbesTest, ReadinessEndsWithTheDrain) {
  FakeActor actor;
  actor.tiles().hold = true;
  Served served(&actor, WithHttp());
  const int port = *served.server().http_port();
  EXPECT_THAT(HttpGet(port, "/livez"),
              AllOf(StartsWith("HTTP/1.1 200 "), EndsWith("ok\n")));
  EXPECT_THAT(HttpGet(port, "/readyz"),
              AllOf(StartsWith("HTTP/1.1 200 "), EndsWith("ok\n")));
  EXPECT_THAT(
      HttpGet(port, "/metrics"),
      HasSubstr("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"));
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(1));
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started == 1; }));
  std::thread drain([&served] {
    served.server().Drain(std::chrono::milliseconds(10),
                          std::chrono::seconds(60));
  });
  EXPECT_TRUE(Eventually([port] {
    return HttpGet(port, "/readyz").starts_with("HTTP/1.1 503 ");
  }));
  // A balancer sends nothing more, but nobody should restart it.
  EXPECT_THAT(HttpGet(port, "/livez"), StartsWith("HTTP/1.1 200 "));
  EXPECT_EQ(Scrape(&served)["terrane_workers_busy"], 1);
  actor.tiles().hold = false;
  v1::StreamTilesResponse message;
  while (reader->Read(&message)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
  drain.join();
}

TEST(ServedProbesTest, AreOffUnlessAskedFor) {
  FakeActor actor;
  Served served(&actor);
  EXPECT_EQ(served.server().http_port(), std::nullopt);
}

TEST(ServedProbesTest, AddressThatIsTakenEndsTheStart) {
  FakeActor actor;
  Served served(&actor, WithHttp());
  CallLog log(std::make_shared<spdlog::logger>("none"), LogFormat::kText);
  ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.http_listen =
      "127.0.0.1:" + std::to_string(*served.server().http_port());
  EXPECT_EQ(Server::Start(options, &actor, &log).status().code(),
            absl::StatusCode::kUnavailable);
}

TEST(ServedLogTest, LinesTellTraceTimesAndReason) {
  FakeActor actor;
  Served served(&actor);
  {
    grpc::ClientContext context;
    context.AddMetadata(
        "traceparent",
        "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01");
    v1::GetHeightsResponse response;
    EXPECT_TRUE(served.terrain->GetHeights(&context, {}, &response).ok());
  }
  {
    grpc::ClientContext context;
    context.AddMetadata("traceparent", "00-\"-1");
    v1::GetHeightsResponse response;
    EXPECT_TRUE(served.terrain->GetHeights(&context, {}, &response).ok());
  }
  auto lines = CallLines(served.StopAndReadLog());
  ASSERT_EQ(lines.size(), 2U);
  // A call's line comes a moment after its answer, so perhaps after the next's.
  if (!lines[0].contains("trace_id")) std::swap(lines[0], lines[1]);
  EXPECT_EQ(lines[0]["trace_id"], "4bf92f3577b34da6a3ce929d0e0e4736");
  EXPECT_FALSE(lines[1].contains("trace_id"));
  for (const auto& line : lines) {
    EXPECT_EQ(line["method"], "GetHeights");
    EXPECT_EQ(line["code"], "OK");
    const double parts = line["queue_ms"].get<double>() +
                         line["generate_ms"].get<double>() +
                         line["send_ms"].get<double>();
    EXPECT_GT(line["total_ms"], 0);
    // To the three digits that are written.
    EXPECT_LE(parts, line["total_ms"].get<double>() + 0.002);
  }
}

// A reader that takes its time costs no work; the line says where time went.
TEST(ServedLogTest, SlowReadersShowInTheTimeOfSending) {
  FakeActor actor;
  // More than gRPC and the kernel take in for a client that does not read.
  actor.tiles().tile_bytes = 32 << 20;
  Served served(&actor);
  grpc::ClientContext context;
  const auto reader = served.terrain->StreamTiles(&context, Tiles(2));
  // The second tile is begun when the first is being written.
  ASSERT_TRUE(Eventually([&] { return actor.tiles().started == 2; }));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  for (v1::StreamTilesResponse message; reader->Read(&message);) {
  }
  EXPECT_TRUE(reader->Finish().ok());
  const auto lines = CallLines(served.StopAndReadLog());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_GE(lines[0]["send_ms"], 300);
}

TEST(ServedLogTest, ReasonsOfRefusals) {
  FakeActor actor;
  actor.tiles().hold = true;
  FullLine line;
  Served served(&actor, line.options());
  ASSERT_TRUE(line.Fill(&served));
  line.Cancel();
  bool refused = false;
  for (const auto& call : CallLines(served.StopAndReadLog())) {
    if (call["code"] != "RESOURCE_EXHAUSTED") continue;
    refused = true;
    EXPECT_EQ(call["reason"], "streams");
  }
  EXPECT_TRUE(refused);
}

}  // namespace
}  // namespace terrane::server
