#include "client/chosen_flower.h"

#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <iterator>
#include <string_view>

namespace terrane::client {
namespace {

constexpr std::string_view kFlowerPrefix = "flower/";

absl::Status ReadRecipeFile(const std::string& path, v1::FlowerRecipe* recipe) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto status = google::protobuf::util::JsonStringToMessage(text, recipe);
  if (status.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      path + " is not a flower recipe: " + status.message().ToString());
}

}  // namespace

bool IsFlowerPreset(const std::string& name) {
  return name.starts_with(kFlowerPrefix);
}

absl::StatusOr<v1::FlowerChoice> ChooseFlower(const FlowerOptions& options) {
  if (options.preset.empty() == options.recipe_file.empty()) {
    return absl::InvalidArgumentError(
        "a flower needs one of --preset and --recipe");
  }
  v1::FlowerChoice choice;
  if (!options.preset.empty()) {
    choice.set_preset(options.preset);
  } else {
    const absl::Status read =
        ReadRecipeFile(options.recipe_file, choice.mutable_recipe());
    if (!read.ok()) return read;
  }
  if (options.seed.has_value()) choice.set_seed(*options.seed);
  if (options.stage.has_value()) choice.set_stage(*options.stage);
  if (options.plants.has_value()) choice.set_plants(*options.plants);
  choice.set_method(options.method);
  return choice;
}

}  // namespace terrane::client
