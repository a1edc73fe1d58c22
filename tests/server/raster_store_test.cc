// Uploads and the store: bounds, eviction, hashes, and what is refused.
#include "server/actor/raster_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/base/violations.h"
#include "server/actor/raster_upload.h"

namespace terrane::server {
namespace {

using ::testing::HasSubstr;

std::string Bytes(const std::vector<float>& samples) {
  return {reinterpret_cast<const char*>(samples.data()),
          samples.size() * sizeof(float)};
}

v1::UploadRasterRequest Header(std::int64_t width, std::int64_t height) {
  v1::UploadRasterRequest request;
  request.mutable_header()->set_width(width);
  request.mutable_header()->set_height(height);
  request.mutable_header()->mutable_frame()->set_spacing_x(30);
  request.mutable_header()->mutable_frame()->set_spacing_y(-30);
  return request;
}

v1::UploadRasterRequest Chunk(const std::string& bytes) {
  v1::UploadRasterRequest request;
  request.set_chunk(bytes);
  return request;
}

class RasterStoreTest : public ::testing::Test {
 protected:
  absl::StatusOr<v1::UploadRasterResponse> Upload(
      const std::vector<v1::UploadRasterRequest>& parts) {
    const auto upload = MakeRasterUpload(limits_, &store_);
    for (const v1::UploadRasterRequest& part : parts) {
      if (const absl::Status status = upload->Add(part); !status.ok()) {
        return status;
      }
    }
    return upload->Finish();
  }
  // Uploads a 2 x 2 raster, 16 bytes, of one height.
  std::string UploadFlat(float height) {
    auto response =
        Upload({Header(2, 2), Chunk(Bytes({height, height, height, height}))});
    return response.ok() ? response->raster_id() : response.status().ToString();
  }
  std::string Refusal(const std::vector<v1::UploadRasterRequest>& parts) {
    const auto response = Upload(parts);
    return response.ok() ? "accepted"
                         : std::string(response.status().message());
  }

  Limits limits_;
  RasterStore store_{48};  // three flat rasters
};

// The bytes are those of raster.proto, written out by hand here:
// python3: hashlib.sha256(b"terrane.raster.v1\0" + struct.pack("<QQddddBf", 2,
// 2, 0, 0, 30, -30, 0, 0) + struct.pack("<4f", 1, 2, 3, 4)).hexdigest()
TEST_F(RasterStoreTest, IdIsTheDocumentedHash) {
  const auto response = Upload({Header(2, 2), Chunk(Bytes({1, 2, 3, 4}))});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->raster_id(),
            "sha256:86a4942dd90932bef413652214332e936d5241b1f26973369318cfba5f"
            "32b5b6");
  EXPECT_FALSE(response->already_present());
}

TEST_F(RasterStoreTest, ChunksMayBeCutAnywhere) {
  const std::string bytes = Bytes({1, 2, 3, 4});
  const auto whole = Upload({Header(2, 2), Chunk(bytes)});
  std::vector<v1::UploadRasterRequest> parts{Header(2, 2)};
  for (const char byte : bytes) parts.push_back(Chunk(std::string(1, byte)));
  parts.push_back(Chunk(""));
  const auto pieces = Upload(parts);
  ASSERT_TRUE(pieces.ok()) << pieces.status();
  EXPECT_EQ(pieces->raster_id(), whole->raster_id());
  EXPECT_TRUE(pieces->already_present());
  EXPECT_EQ(store_.Get(whole->raster_id())->raster->values,
            (std::vector<float>{1, 2, 3, 4}));
}

TEST_F(RasterStoreTest, DescribesWhatItKeeps) {
  v1::UploadRasterRequest header = Header(2, 2);
  header.mutable_header()->set_nodata(-9999);
  header.mutable_header()->mutable_frame()->set_crs("EPSG:4326");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto response = Upload({header, Chunk(Bytes({7, -9999, nan, 3}))});
  ASSERT_TRUE(response.ok()) << response.status();
  const auto kept = store_.Get(response->raster_id());
  EXPECT_EQ(kept->description.range().minimum(), 3);
  EXPECT_EQ(kept->description.range().maximum(), 7);
  EXPECT_EQ(kept->description.nodata_samples(), 2);
  EXPECT_EQ(kept->description.header().nodata(), -9999);
  EXPECT_TRUE(std::isnan(kept->raster->At(1, 0)));
  EXPECT_EQ(store_.Find(response->raster_id()).crs, "EPSG:4326");
}

TEST_F(RasterStoreTest, LeastRecentlyUsedGoesFirst) {
  const std::string first = UploadFlat(1);
  const std::string second = UploadFlat(2);
  UploadFlat(3);
  EXPECT_EQ(store_.kept_bytes(), 48);
  EXPECT_NE(store_.Find(first).raster, nullptr);  // now the latest used
  UploadFlat(4);
  EXPECT_EQ(store_.kept_bytes(), 48);
  EXPECT_EQ(store_.Find(second).raster, nullptr);
  EXPECT_NE(store_.Find(first).raster, nullptr);
}

TEST_F(RasterStoreTest, LargerThanTheStoreIsRefused) {
  const auto response = Upload({Header(4, 4)});
  EXPECT_EQ(response.status().code(), absl::StatusCode::kResourceExhausted);
}

TEST_F(RasterStoreTest, UploadsInFlightAreBoundedTogether) {
  auto one = MakeRasterUpload(limits_, &store_);
  auto two = MakeRasterUpload(limits_, &store_);
  EXPECT_TRUE(one->Add(Header(2, 4)).ok());
  EXPECT_EQ(two->Add(Header(2, 4)).code(),
            absl::StatusCode::kResourceExhausted);
  one.reset();
  EXPECT_TRUE(MakeRasterUpload(limits_, &store_)->Add(Header(2, 4)).ok());
}

TEST_F(RasterStoreTest, WrongContentIsRefused) {
  v1::UploadRasterRequest header = Header(2, 2);
  header.set_expected_raster_id("sha256:00");
  EXPECT_THAT(Refusal({header, Chunk(Bytes({1, 2, 3, 4}))}),
              HasSubstr("expected_raster_id: must be that of the content"));
  EXPECT_EQ(store_.kept_bytes(), 0);
}

TEST_F(RasterStoreTest, TruncatedAndOverlongUploadsAreRefused) {
  EXPECT_EQ(Refusal({Header(2, 2), Chunk("1234567")}),
            "chunk: must hold 16 bytes in all, got 7");
  EXPECT_EQ(Refusal({Header(2, 2), Chunk(std::string(17, 'x'))}),
            "chunk: must end with the raster's 16 bytes, got at least 17");
  EXPECT_EQ(store_.kept_bytes(), 0);
}

TEST_F(RasterStoreTest, MessagesOutOfOrderAreRefused) {
  EXPECT_EQ(Refusal({}), "header: must be sent, got nothing");
  EXPECT_EQ(Refusal({Chunk("1234")}),
            "header: must be set in the first message");
  EXPECT_EQ(Refusal({Header(2, 2), Header(2, 2)}),
            "chunk: must be set after the first message");
}

TEST_F(RasterStoreTest, BadHeadersNameEveryField) {
  v1::UploadRasterRequest header = Header(1, std::int64_t{1} << 40);
  header.mutable_header()->mutable_frame()->set_origin_x(
      std::numeric_limits<double>::quiet_NaN());
  const std::string refusal = Refusal({header});
  EXPECT_THAT(refusal,
              HasSubstr("header.width: must be in [2, 1048576], got 1"));
  EXPECT_THAT(refusal, HasSubstr("header.height: must be in [2, 1048576]"));
  EXPECT_THAT(refusal, HasSubstr("header.frame.origin_x"));
  EXPECT_THAT(Refusal({Header(1 << 20, 1 << 20)}),
              HasSubstr("header: must have at most 67108864 samples"));
}

TEST_F(RasterStoreTest, InfinitySamplesAreRefused) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_THAT(Refusal({Header(2, 2), Chunk(Bytes({1, 2, infinity, 4}))}),
              HasSubstr("got infinity at sample 2"));
}

}  // namespace
}  // namespace terrane::server
