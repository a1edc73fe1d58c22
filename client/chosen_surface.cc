#include "client/chosen_surface.h"

#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "client/csv.h"

namespace terrane::client {
namespace {

constexpr std::string_view kSurfacePrefix = "surface/";

using Points = std::vector<v1::Vector3>;

v1::Vector3 MakeVector(double x, double y, double z) {
  v1::Vector3 vector;
  vector.set_x(x);
  vector.set_y(y);
  vector.set_z(z);
  return vector;
}

absl::StatusOr<Points> ReadObjPoints(std::istream* input,
                                     const std::string& path) {
  Points points;
  std::string line;
  for (int number = 1; std::getline(*input, line); ++number) {
    std::istringstream words(line);
    std::string keyword;
    if (!(words >> keyword) || keyword != "v") continue;
    double x = 0, y = 0, z = 0;
    if (!(words >> x >> y >> z)) {
      return absl::InvalidArgumentError(path + " line " +
                                        std::to_string(number) +
                                        ": must be three numbers after v");
    }
    points.push_back(MakeVector(x, y, z));
  }
  return points;
}

absl::StatusOr<Points> ReadCsvPoints(std::istream* input,
                                     const std::string& path) {
  const auto table = ReadCsv(input, path, 3);
  if (!table.ok()) return table.status();
  Points points;
  for (std::size_t k = 0; k < table->front().size(); ++k) {
    points.push_back(
        MakeVector((*table)[0][k], (*table)[1][k], (*table)[2][k]));
  }
  return points;
}

// The rows and columns that the points make.
absl::Status ReadNet(const SurfaceOptions& options, v1::SurfaceNet* net) {
  const std::string& path = options.net_file;
  std::ifstream file(path);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const absl::StatusOr<Points> points =
      std::filesystem::path(path).extension() == ".obj"
          ? ReadObjPoints(&file, path)
          : ReadCsvPoints(&file, path);
  if (!points.ok()) return points.status();
  const auto count = static_cast<int>(points->size());
  const int columns = options.net_columns > 0
                          ? options.net_columns
                          : static_cast<int>(std::lround(
                                std::sqrt(static_cast<double>(count))));
  if (count == 0 || count % columns != 0 ||
      (options.net_columns == 0 && columns * columns != count)) {
    return absl::InvalidArgumentError(
        path + ": " + std::to_string(count) +
        " points make no rectangle; say --net-columns with a number that "
        "divides them");
  }
  net->set_columns(columns);
  net->set_rows(count / columns);
  for (const v1::Vector3& point : *points) *net->add_points() = point;
  return absl::OkStatus();
}

absl::Status ReadRecipeFile(const std::string& path,
                            v1::SurfaceRecipe* recipe) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto status = google::protobuf::util::JsonStringToMessage(text, recipe);
  if (status.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      path + " is not a surface recipe: " + status.message().ToString());
}

absl::Status UsePreset(const std::string& name, Backend* backend,
                       std::stop_token stop, ChosenSurface* surface) {
  v1::GetSurfacePresetRequest request;
  request.set_name(name);
  const absl::StatusOr<v1::GetSurfacePresetResponse> answer =
      backend->GetSurfacePreset(request, std::move(stop));
  if (!answer.ok()) return answer.status();
  surface->recipe = answer->preset().recipe();
  surface->view = answer->preset().view();
  return absl::OkStatus();
}

}  // namespace

bool IsSurfacePreset(const std::string& name) {
  return name.starts_with(kSurfacePrefix);
}

absl::StatusOr<ChosenSurface> ChooseSurface(const SurfaceOptions& options,
                                            Backend* backend,
                                            std::stop_token stop) {
  const int given = (options.preset.empty() ? 0 : 1) +
                    (options.recipe_file.empty() ? 0 : 1) +
                    (options.net_file.empty() ? 0 : 1);
  if (given != 1) {
    return absl::InvalidArgumentError(
        "a surface needs one of --preset, --recipe and --net, got " +
        std::to_string(given));
  }
  ChosenSurface surface;
  const absl::Status status =
      !options.preset.empty()
          ? UsePreset(options.preset, backend, std::move(stop), &surface)
      : !options.recipe_file.empty()
          ? ReadRecipeFile(options.recipe_file, &surface.recipe)
          : ReadNet(options, surface.recipe.mutable_net());
  if (!status.ok()) return status;
  v1::SurfaceRecipe& recipe = surface.recipe;
  if (options.basis.has_value())
    recipe.mutable_net()->set_basis(*options.basis);
  if (options.degree.has_value()) {
    recipe.mutable_net()->set_degree(*options.degree);
  }
  if (options.method.has_value()) recipe.set_method(*options.method);
  if (options.seed.has_value()) recipe.set_seed(*options.seed);
  return surface;
}

}  // namespace terrane::client
