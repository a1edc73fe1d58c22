#include "client/chosen_tree.h"

#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

namespace terrane::client {
namespace {

constexpr std::string_view kTreePrefix = "tree/";

absl::Status ReadRecipeFile(const std::string& path, v1::TreeRecipe* recipe) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto status = google::protobuf::util::JsonStringToMessage(text, recipe);
  if (status.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      path + " is not a tree recipe: " + status.message().ToString());
}

absl::Status UsePreset(const std::string& name, TreeBackend* backend,
                       std::stop_token stop, ChosenTree* tree) {
  v1::GetTreePresetRequest request;
  request.set_name(name);
  const absl::StatusOr<v1::GetTreePresetResponse> answer =
      backend->GetTreePreset(request, std::move(stop));
  if (!answer.ok()) return answer.status();
  tree->recipe = answer->preset().recipe();
  tree->view = answer->preset().view();
  return absl::OkStatus();
}

}  // namespace

bool IsTreePreset(const std::string& name) {
  return name.starts_with(kTreePrefix);
}

absl::StatusOr<ChosenTree> ChooseTree(const TreeOptions& options,
                                      TreeBackend* backend,
                                      std::stop_token stop) {
  if (options.preset.empty() == options.recipe_file.empty()) {
    return absl::InvalidArgumentError(
        "a tree needs one of --preset and --recipe");
  }
  ChosenTree tree;
  const absl::Status status =
      options.preset.empty()
          ? ReadRecipeFile(options.recipe_file, &tree.recipe)
          : UsePreset(options.preset, backend, std::move(stop), &tree);
  if (!status.ok()) return status;
  if (options.seed.has_value()) tree.recipe.set_seed(*options.seed);
  if (options.depth.has_value()) tree.recipe.set_depth(*options.depth);
  if (options.dimensions.has_value()) {
    tree.recipe.set_dimensions(*options.dimensions);
  }
  return tree;
}

}  // namespace terrane::client
