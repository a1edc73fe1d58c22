// From the options that say which flower, to the choice that is asked for.
#ifndef TERRANE_CLIENT_CHOSEN_FLOWER_H_
#define TERRANE_CLIENT_CHOSEN_FLOWER_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "terrane/v1/flower.pb.h"

namespace terrane::client {

// Exactly one of preset and recipe_file. What is set further down takes the
// place of what the recipe says.
struct FlowerOptions {
  std::string preset;
  std::string recipe_file;
  std::optional<std::int64_t> seed;
  std::optional<double> stage;
  std::optional<int> plants;
  v1::PetalMethod method = v1::PETAL_METHOD_UNSPECIFIED;
};

// Whether a preset of that name is a flower.
bool IsFlowerPreset(const std::string& name);

// Reads the file; a preset is left to the server. Errors: none or both of the
// two, an unreadable file, a recipe that is no JSON of a FlowerRecipe.
absl::StatusOr<v1::FlowerChoice> ChooseFlower(const FlowerOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHOSEN_FLOWER_H_
