// What the client does to a surface: choosing it, checking its tiles, putting
// them together, drawing them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <string>

#include "client/chosen_surface.h"
#include "client/local_backend.h"
#include "client/render/surface_view.h"
#include "client/surface_grid.h"
#include "client/surface_verifier.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using ::testing::HasSubstr;

v1::StreamSurfaceRequest Request(int tile_size) {
  v1::StreamSurfaceRequest request;
  request.mutable_surface()->set_preset("surface/fig12");
  request.set_columns(70);
  request.set_rows(60);
  request.set_tile_size(tile_size);
  request.set_uvs(true);
  return request;
}

TEST(SurfaceGridTest, TilesMakeTheSameMeshWhateverTheirSize) {
  LocalBackend backend(2);
  const auto whole = StreamToGrid(Request(100), &backend, {});
  const auto tiled = StreamToGrid(Request(32), &backend, {});
  ASSERT_TRUE(whole.ok() && tiled.ok()) << whole.status() << tiled.status();
  const core::Mesh a = whole->MakeMesh();
  const core::Mesh b = tiled->MakeMesh();
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.indices, b.indices);
  // Its holes are not in the mesh.
  EXPECT_GT(whole->left_out_samples(), 0);
  EXPECT_LE(a.positions.size(),
            static_cast<std::size_t>(70 * 60 - whole->left_out_samples()));
}

// The messages of a stream.
std::vector<v1::StreamSurfaceResponse> Messages(v1::SurfaceHeader* header) {
  LocalBackend backend(1);
  std::vector<v1::StreamSurfaceResponse> messages;
  EXPECT_TRUE(backend
                  .StreamSurface(
                      Request(32),
                      [&](const v1::SurfaceHeader& one) {
                        *header = one;
                        return absl::OkStatus();
                      },
                      [&](const v1::StreamSurfaceResponse& message) {
                        messages.push_back(message);
                        return absl::OkStatus();
                      },
                      {})
                  .ok());
  return messages;
}

TEST(SurfaceVerifierTest, TakesAStreamAndItsResumption) {
  v1::SurfaceHeader header;
  const auto messages = Messages(&header);
  ASSERT_EQ(messages.size(), 6u);
  SurfaceVerifier verifier(Request(32));
  EXPECT_TRUE(verifier.CheckHeader(header).ok());
  EXPECT_TRUE(verifier.CheckTile(messages[0]).ok());
  EXPECT_THAT(std::string(verifier.CheckEnd().message()),
              HasSubstr("ended after 1 of 6 tiles"));
  EXPECT_TRUE(verifier.CheckHeader(header).ok());
  for (std::size_t k = 1; k < 6; ++k) {
    EXPECT_TRUE(verifier.CheckTile(messages[k]).ok());
  }
  EXPECT_TRUE(verifier.CheckEnd().ok());
  header.set_recipe_hash("sha256:another");
  EXPECT_EQ(verifier.CheckHeader(header).code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(SurfaceVerifierTest, NamesWhatIsWrong) {
  v1::SurfaceHeader header;
  const auto messages = Messages(&header);
  const auto error =
      [&](const std::function<void(v1::StreamSurfaceResponse*)>& spoil) {
        SurfaceVerifier verifier(Request(32));
        EXPECT_TRUE(verifier.CheckHeader(header).ok());
        v1::StreamSurfaceResponse message = messages[0];
        spoil(&message);
        return std::string(verifier.CheckTile(message).message());
      };
  EXPECT_THAT(error([](v1::StreamSurfaceResponse* m) {
                m->mutable_mesh_tile()->mutable_positions()->at(100) ^= 1;
              }),
              HasSubstr("tile 0: does not match its checksum"));
  EXPECT_THAT(error([](v1::StreamSurfaceResponse* m) {
                m->mutable_mesh_tile()->mutable_normals()->pop_back();
              }),
              HasSubstr("bytes of normals"));
  EXPECT_THAT(error([](v1::StreamSurfaceResponse* m) {
                m->mutable_mesh_tile()->set_index(1);
              }),
              HasSubstr("came where tile 0 belongs"));
  EXPECT_THAT(error([](v1::StreamSurfaceResponse* m) {
                m->mutable_mesh_tile()->mutable_window()->set_x(3);
              }),
              HasSubstr("covers 3,0,32,32, expected 0,0,32,32"));
  EXPECT_THAT(
      error([](v1::StreamSurfaceResponse* m) { m->mutable_height_tile(); }),
      HasSubstr("is not what the header announces"));
}

class ChosenSurfaceTest : public ::testing::Test {
 protected:
  absl::StatusOr<ChosenSurface> Choose(const std::string& name,
                                       const std::string& text,
                                       int net_columns = 0) {
    SurfaceOptions options;
    options.net_file = folder_.File(name);
    options.net_columns = net_columns;
    std::ofstream(options.net_file) << text;
    return ChooseSurface(options, &backend_, {});
  }

  TemporaryFolder folder_;
  LocalBackend backend_{1};
};

TEST_F(ChosenSurfaceTest, NetsAreReadFromCsvAndObj) {
  const auto csv = Choose("net.csv", "x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,4\n");
  ASSERT_TRUE(csv.ok()) << csv.status();
  EXPECT_EQ(csv->recipe.net().columns(), 2);
  EXPECT_EQ(csv->recipe.net().points(3).z(), 4);
  const auto obj =
      Choose("net.obj",
             "o net\nv 0 0 1\nv 1 0 2\nv 2 0 5\nvn 0 0 1\nv 0 1 3\n"
             "v 1 1 4\nv 2 1 6\n",
             3);
  ASSERT_TRUE(obj.ok()) << obj.status();
  EXPECT_EQ(obj->recipe.net().columns(), 3);
  EXPECT_EQ(obj->recipe.net().rows(), 2);
  EXPECT_EQ(obj->recipe.net().points(5).z(), 6);
}

TEST_F(ChosenSurfaceTest, NetsThatMakeNoRectangleAreNamed) {
  EXPECT_THAT(
      std::string(
          Choose("net.csv", "0,0,1\n1,0,2\n0,1,3\n").status().message()),
      HasSubstr("3 points make no rectangle; say --net-columns"));
  EXPECT_THAT(std::string(Choose("net.obj", "v 0 0\n").status().message()),
              HasSubstr("net.obj line 1: must be three numbers after v"));
  EXPECT_THAT(std::string(ChooseSurface({}, &backend_, {}).status().message()),
              HasSubstr("needs one of --preset, --recipe and --net, got 0"));
}

TEST(SurfaceViewTest, DrawsTheSurfaceAndItsNet) {
  core::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.indices = {0, 1, 2};
  SurfaceViewOptions options;
  options.width = 200;
  options.turn_deg = 0;
  options.tilt_deg = 90;
  const Picture plain = RenderSurface(mesh, {}, options);
  const auto red = [](const Picture& picture, double x, double y) {
    return int{*picture.Pixel(static_cast<int>(x * picture.width),
                              static_cast<int>(y * picture.height))};
  };
  // Seen from above: the right angle is at the lower left.
  EXPECT_LT(red(plain, 0.3, 0.7), 220);
  EXPECT_EQ(red(plain, 0.8, 0.2), 255);
  const ControlPolyhedron net = {2, 1, {{0, 0, 0}, {1, 1, 0}}};
  const Picture with_net = RenderSurface(mesh, net, options);
  EXPECT_LT(red(with_net, 0.8, 0.2), 255);
}

}  // namespace
}  // namespace terrane::client
