// The recipe that a request's choice names, of any generator: the message holds
// a recipe or the name of a preset, and may have a seed of its own.
//
// Threads: any. Errors: violations; NOT_FOUND for a preset, which waits for
// what else is wrong with the request (FaultOf).
#ifndef TERRANE_SERVER_ACTOR_CHOSEN_RECIPE_H_
#define TERRANE_SERVER_ACTOR_CHOSEN_RECIPE_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/violations.h"

namespace terrane::server {

template <typename Recipe>
struct ChosenRecipe {
  // With the seed asked for. None, with a violation, when the choice names
  // none, and when the preset is missing.
  std::optional<Recipe> recipe;
  // Stands before the path of each of its fields.
  std::string prefix;
  // NOT_FOUND: what the request names and is not there.
  absl::Status missing;
};

// `find` finds a preset; `path` is the choice's in the request.
template <typename Recipe, typename Choice, typename Preset>
ChosenRecipe<Recipe> ChooseRecipe(
    const Choice& choice,
    absl::StatusOr<const Preset*> (*find)(const std::string&),
    const std::string& path, core::Violations* violations) {
  ChosenRecipe<Recipe> chosen;
  chosen.prefix = path + (choice.has_preset() ? ".preset." : ".recipe.");
  switch (choice.choice_case()) {
    case Choice::kRecipe:
      chosen.recipe = choice.recipe();
      break;
    case Choice::kPreset: {
      const auto preset = find(choice.preset());
      if (!preset.ok()) {
        chosen.missing = preset.status();
        return chosen;
      }
      chosen.recipe = (*preset)->recipe();
      break;
    }
    case Choice::CHOICE_NOT_SET:
      violations->Add(path, "must hold a recipe or a preset, got neither");
      return chosen;
  }
  if (choice.has_seed()) chosen.recipe->set_seed(choice.seed());
  return chosen;
}

// Why a request is refused: its violations, which no upload mends, or else what
// is missing. OK when it is not.
inline absl::Status FaultOf(const core::Violations& violations,
                            const absl::Status& missing) {
  return violations.empty() ? missing : violations.ToStatus();
}

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_CHOSEN_RECIPE_H_
