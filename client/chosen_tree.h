// From the options that say which tree, to the recipe that is asked for.
#ifndef TERRANE_CLIENT_CHOSEN_TREE_H_
#define TERRANE_CLIENT_CHOSEN_TREE_H_

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/tree_backend.h"
#include "terrane/v1/tree_recipe.pb.h"

namespace terrane::client {

// Exactly one of preset and recipe_file. What is set further down takes the
// place of what the recipe says.
struct TreeOptions {
  std::string preset;
  std::string recipe_file;
  std::optional<std::int64_t> seed;
  std::optional<int> depth;
  std::optional<int> dimensions;
  // Any other field of the recipe, as "genetic.left_share=0.2".
  std::vector<std::string> settings;
};

struct ChosenTree {
  v1::TreeRecipe recipe;
  // How a preset wants to be looked at; the defaults otherwise.
  v1::TreeView view;
};

// Whether a preset of that name is a tree.
bool IsTreePreset(const std::string& name);

// Reads the file or asks for the preset. Errors: none or both of the two, an
// unreadable file, a recipe that is no JSON of a TreeRecipe, a setting that
// names no field of it, and those of the backend.
absl::StatusOr<ChosenTree> ChooseTree(const TreeOptions& options,
                                      TreeBackend* backend,
                                      std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHOSEN_TREE_H_
