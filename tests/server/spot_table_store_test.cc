// Uploads of spot tables and their store: hashes, columns, and what is refused.
// What the store shares with rasters is in raster_store_test.cc.
#include "server/actor/spot_table_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "server/actor/spot_table_upload.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string Bytes(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()),
          values.size() * sizeof(double)};
}

v1::UploadSpotTableRequest Header(std::int64_t rows, bool has_errors = false) {
  v1::UploadSpotTableRequest request;
  request.mutable_header()->set_rows(rows);
  request.mutable_header()->set_has_standard_errors(has_errors);
  return request;
}

v1::UploadSpotTableRequest Chunk(const std::string& bytes) {
  v1::UploadSpotTableRequest request;
  request.set_chunk(bytes);
  return request;
}

class SpotTableStoreTest : public ::testing::Test {
 protected:
  absl::StatusOr<v1::UploadSpotTableResponse> Upload(
      const std::vector<v1::UploadSpotTableRequest>& parts) {
    const auto upload = MakeSpotTableUpload(limits_, &store_);
    for (const v1::UploadSpotTableRequest& part : parts) {
      if (const absl::Status status = upload->Add(part); !status.ok()) {
        return status;
      }
    }
    return upload->Finish();
  }
  std::string Refusal(const std::vector<v1::UploadSpotTableRequest>& parts) {
    const auto response = Upload(parts);
    return response.ok() ? "accepted"
                         : std::string(response.status().message());
  }

  Limits limits_;
  SpotTableStore store_{SpotTableBytes(4)};
};

// The bytes are those of spot_table.proto, written out by hand here:
// python3: hashlib.sha256(b"terrane.spots.v1\0" + struct.pack("<QB", 2, 0) +
// struct.pack("<6d", 1, 2, 3, 4, 5, 6)).hexdigest()
TEST_F(SpotTableStoreTest, IdIsTheDocumentedHash) {
  const auto response = Upload({Header(2), Chunk(Bytes({1, 2, 3, 4, 5, 6}))});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->table_id(),
            "sha256:"
            "497e6a2afb97662c96c7c900600e481fb75e68b48e0e2db60a06aec52b17e22c");
  EXPECT_FALSE(response->already_present());
}

TEST_F(SpotTableStoreTest, ColumnsBecomeRows) {
  const std::string bytes = Bytes({1, 2, 3, 4, 5, 6, 0, 0.5});
  std::vector<v1::UploadSpotTableRequest> parts{Header(2, true)};
  for (const char byte : bytes) parts.push_back(Chunk(std::string(1, byte)));
  const auto response = Upload(parts);
  ASSERT_TRUE(response.ok()) << response.status();
  const auto table = store_.FindTable(response->table_id());
  ASSERT_NE(table, nullptr);
  EXPECT_THAT(*table, ElementsAre(core::SpotHeight{{1, 3}, 5, 0},
                                  core::SpotHeight{{2, 4}, 6, 0.5}));
  const auto kept = store_.Get(response->table_id());
  EXPECT_EQ(kept->description.header().rows(), 2);
  EXPECT_TRUE(kept->description.header().has_standard_errors());
  EXPECT_TRUE(Upload(parts)->already_present());
}

TEST_F(SpotTableStoreTest, StandardErrorsArePartOfTheId) {
  const auto exact = Upload({Header(1), Chunk(Bytes({1, 2, 3}))});
  const auto noisy = Upload({Header(1, true), Chunk(Bytes({1, 2, 3, 0}))});
  EXPECT_NE(exact->table_id(), noisy->table_id());
}

TEST_F(SpotTableStoreTest, LeastRecentlyUsedGoesFirst) {
  const auto upload = [&](double x) {
    return Upload({Header(2), Chunk(Bytes({x, 2, 3, 4, 5, 6}))})->table_id();
  };
  const std::string first = upload(1);
  const std::string second = upload(2);
  EXPECT_NE(store_.FindTable(first), nullptr);  // now the latest used
  upload(3);
  EXPECT_EQ(store_.FindTable(second), nullptr);
  EXPECT_NE(store_.FindTable(first), nullptr);
  EXPECT_EQ(store_.kept_bytes(), SpotTableBytes(4));
}

TEST_F(SpotTableStoreTest, ValuesThatAreNotFiniteAreNamedByRow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Refusal({Header(2), Chunk(Bytes({1, 2, 3, nan, 5, 6}))}),
            "chunk: must hold finite numbers, got nan as y of row 1");
  EXPECT_EQ(Refusal({Header(1, true), Chunk(Bytes({1, 2, 3, infinity}))}),
            "chunk: must hold finite numbers, got inf as standard_error of "
            "row 0");
  EXPECT_EQ(store_.kept_bytes(), 0);
}

TEST_F(SpotTableStoreTest, BadUploadsAreRefused) {
  EXPECT_EQ(Refusal({Header(0)}), "header.rows: must be in [1, 100000], got 0");
  EXPECT_EQ(Refusal({Header(100'001)}),
            "header.rows: must be in [1, 100000], got 100001");
  EXPECT_EQ(Refusal({}), "header: must be sent, got nothing");
  EXPECT_EQ(Refusal({Chunk("1234")}),
            "header: must be set in the first message");
  EXPECT_EQ(Refusal({Header(1), Header(1)}),
            "chunk: must be set after the first message");
  EXPECT_EQ(Refusal({Header(1), Chunk("1234567")}),
            "chunk: must hold 24 bytes in all, got 7");
  EXPECT_EQ(Refusal({Header(1, true), Chunk(std::string(33, 'x'))}),
            "chunk: must end with the table's 32 bytes, got at least 33");
  v1::UploadSpotTableRequest header = Header(1);
  header.set_expected_table_id("sha256:00");
  EXPECT_THAT(Refusal({header, Chunk(Bytes({1, 2, 3}))}),
              HasSubstr("expected_table_id: must be that of the content"));
  EXPECT_EQ(Upload({Header(5)}).status().code(),
            absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace terrane::server
