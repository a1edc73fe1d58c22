#include "client/chosen_tree.h"

#include <fmt/format.h>
#include <google/protobuf/field_mask.pb.h>
#include <google/protobuf/util/field_mask_util.h>
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

// A value as JSON: numbers, true and false as they are, names in quotes.
std::string JsonValue(const std::string& text) {
  const bool is_bare =
      text == "true" || text == "false" ||
      text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  return is_bare ? text : "\"" + text + "\"";
}

// Sets one field of the recipe, also to what it would be by default.
absl::Status Apply(const std::string& setting, v1::TreeRecipe* recipe) {
  using google::protobuf::FieldMask;
  using google::protobuf::util::FieldMaskUtil;
  const std::size_t equals = setting.find('=');
  const std::string path = setting.substr(0, equals);
  std::string json =
      equals == std::string::npos ? "" : JsonValue(setting.substr(equals + 1));
  for (std::size_t end = path.size(); end != std::string::npos;) {
    const std::size_t dot =
        end == 0 ? std::string::npos : path.rfind('.', end - 1);
    const std::size_t start = dot == std::string::npos ? 0 : dot + 1;
    json = fmt::format("{{\"{}\":{}}}", path.substr(start, end - start), json);
    end = dot;
  }
  v1::TreeRecipe parsed;
  const auto status =
      google::protobuf::util::JsonStringToMessage(json, &parsed);
  if (!status.ok()) {
    return absl::InvalidArgumentError(
        "--set: must be FIELD=VALUE with a field of TreeRecipe, such as "
        "genetic.left_share=0.2, got \"" +
        setting + "\"");
  }
  FieldMask mask;
  mask.add_paths(path);
  FieldMaskUtil::MergeMessageTo(parsed, mask, FieldMaskUtil::MergeOptions(),
                                recipe);
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
  for (const std::string& setting : options.settings) {
    const absl::Status applied = Apply(setting, &tree.recipe);
    if (!applied.ok()) return applied;
  }
  return tree;
}

}  // namespace terrane::client
