#include "client/tile_verifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xxhash.h>

namespace terrane::client {
namespace {

using testing::HasSubstr;

// 5 x 3 samples in tiles of 2: three columns, two rows.
v1::StreamHeader Header() {
  v1::StreamHeader header;
  header.set_recipe_hash("sha256:1");
  header.set_revision(1);
  header.set_tile_size(2);
  header.set_tile_columns(3);
  header.set_tile_rows(2);
  header.mutable_window()->set_x(10);
  header.mutable_window()->set_y(-4);
  header.mutable_window()->set_width(5);
  header.mutable_window()->set_height(3);
  return header;
}

v1::HeightTile Tile(std::int64_t index, std::int64_t x, std::int64_t y,
                    std::int64_t width, std::int64_t height) {
  v1::HeightTile tile;
  tile.set_index(index);
  tile.set_total(6);
  tile.mutable_window()->set_x(x);
  tile.mutable_window()->set_y(y);
  tile.mutable_window()->set_width(width);
  tile.mutable_window()->set_height(height);
  tile.set_data(std::string(static_cast<std::size_t>(width * height * 4), 'h'));
  tile.set_checksum(XXH3_64bits(tile.data().data(), tile.data().size()));
  return tile;
}

std::string Text(const absl::Status& status) {
  return std::string(status.message());
}

TEST(TileVerifier, WholeStreamPasses) {
  TileVerifier verifier{v1::StreamTilesRequest()};
  ASSERT_EQ(verifier.CheckHeader(Header()), absl::OkStatus());
  EXPECT_EQ(verifier.CheckTile(Tile(0, 10, -4, 2, 2)), absl::OkStatus());
  EXPECT_EQ(verifier.CheckTile(Tile(1, 12, -4, 2, 2)), absl::OkStatus());
  EXPECT_EQ(verifier.CheckTile(Tile(2, 14, -4, 1, 2)), absl::OkStatus());
  EXPECT_EQ(verifier.CheckTile(Tile(3, 10, -2, 2, 1)), absl::OkStatus());
  EXPECT_EQ(verifier.CheckTile(Tile(4, 12, -2, 2, 1)), absl::OkStatus());
  EXPECT_THAT(Text(verifier.CheckEnd()), HasSubstr("after 5 of 6 tiles"));
  EXPECT_EQ(verifier.CheckTile(Tile(5, 14, -2, 1, 1)), absl::OkStatus());
  EXPECT_EQ(verifier.CheckEnd(), absl::OkStatus());
}

TEST(TileVerifier, DamageIsNamed) {
  TileVerifier verifier{v1::StreamTilesRequest()};
  EXPECT_THAT(Text(verifier.CheckTile(Tile(0, 10, -4, 2, 2))),
              HasSubstr("before the header"));
  ASSERT_EQ(verifier.CheckHeader(Header()), absl::OkStatus());
  EXPECT_THAT(Text(verifier.CheckTile(Tile(1, 12, -4, 2, 2))),
              HasSubstr("where tile 0 belongs"));
  EXPECT_THAT(Text(verifier.CheckTile(Tile(0, 12, -4, 2, 2))),
              HasSubstr("expected 10,-4,2,2"));
  v1::HeightTile damaged = Tile(0, 10, -4, 2, 2);
  (*damaged.mutable_data())[3] = 'x';
  EXPECT_THAT(Text(verifier.CheckTile(damaged)), HasSubstr("checksum"));
  v1::HeightTile short_tile = Tile(0, 10, -4, 2, 2);
  short_tile.mutable_data()->pop_back();
  EXPECT_THAT(Text(verifier.CheckTile(short_tile)), HasSubstr("15 bytes"));
  // None of them counted.
  EXPECT_EQ(verifier.next_index(), 0);
}

TEST(TileVerifier, NeighbouringPointTilesShareAnEdge) {
  v1::StreamTilesRequest request;
  request.mutable_tiles()->set_x(-1);
  request.mutable_tiles()->set_columns(2);
  request.mutable_tiles()->set_rows(1);
  request.set_first_tile(1);
  TileVerifier verifier(request);
  v1::StreamHeader header = Header();
  header.set_tile_size(3);
  header.set_tile_columns(2);
  header.set_tile_rows(1);
  ASSERT_EQ(verifier.CheckHeader(header), absl::OkStatus());
  v1::HeightTile tile = Tile(1, 0, 0, 3, 3);
  tile.set_total(2);
  EXPECT_EQ(verifier.CheckTile(tile), absl::OkStatus());
}

TEST(TileVerifier, ResumedStreamMustBeTheSame) {
  TileVerifier verifier{v1::StreamTilesRequest()};
  ASSERT_EQ(verifier.CheckHeader(Header()), absl::OkStatus());
  EXPECT_EQ(verifier.CheckHeader(Header()), absl::OkStatus());
  v1::StreamHeader other = Header();
  other.set_revision(2);
  EXPECT_EQ(verifier.CheckHeader(other).code(),
            absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace terrane::client
