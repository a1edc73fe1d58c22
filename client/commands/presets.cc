// `terrane presets`: the recipes that ship, by name.
#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "client/chosen_flower.h"
#include "client/chosen_surface.h"
#include "client/chosen_tree.h"
#include "client/commands/command.h"
#include "client/commands/shared_options.h"
#include "client/exit_code.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane presets
  terrane presets fbm/fig06b
  terrane presets fbm/fig06b --json > mine.json    a recipe to edit, for --recipe)";

struct PresetsCommand {
  ConnectionOptions connection;
  std::string name;
  bool json = false;
};

int List(const PresetsCommand& command, Backend* backend,
         std::stop_token stop) {
  const absl::StatusOr<v1::GetServerInfoResponse> info =
      backend->GetServerInfo(stop);
  if (!info.ok()) return ReportStatus(info.status());
  std::size_t widest = 0;
  for (const v1::PresetSummary& preset : info->presets()) {
    widest = std::max(widest, preset.name().size());
  }
  for (const v1::PresetSummary& preset : info->presets()) {
    if (command.json) {
      std::cout << JsonLine(preset) << '\n';
    } else {
      std::cout << fmt::format("{:{}}  {}\n", preset.name(), widest,
                               preset.title());
    }
  }
  return kExitOk;
}

// Only what the recipe sets: a file to edit, not a list of defaults.
template <typename Preset>
void Print(const PresetsCommand& command, const Preset& preset) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.add_whitespace = true;
  std::string recipe;
  (void)google::protobuf::util::MessageToJsonString(preset.recipe(), &recipe,
                                                    options);
  if (!command.json) {
    std::cout << preset.name() << ": " << preset.title() << "\n\n"
              << preset.description() << "\n\n";
  }
  std::cout << recipe;
}

int ShowAnswer(const PresetsCommand& command, const auto& answer) {
  if (!answer.ok()) return ReportStatus(answer.status());
  Print(command, answer->preset());
  return kExitOk;
}

template <typename Request>
Request AskFor(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

int Show(const PresetsCommand& command, Backend* backend,
         std::stop_token stop) {
  const std::string& name = command.name;
  if (IsSurfacePreset(name)) {
    return ShowAnswer(command,
                      backend->GetSurfacePreset(
                          AskFor<v1::GetSurfacePresetRequest>(name), stop));
  }
  if (IsTreePreset(name)) {
    return ShowAnswer(command,
                      backend->trees().GetTreePreset(
                          AskFor<v1::GetTreePresetRequest>(name), stop));
  }
  if (IsFlowerPreset(name)) {
    return ShowAnswer(command,
                      backend->flowers().GetFlowerPreset(
                          AskFor<v1::GetFlowerPresetRequest>(name), stop));
  }
  return ShowAnswer(
      command, backend->GetPreset(AskFor<v1::GetPresetRequest>(name), stop));
}

int Run(const PresetsCommand& command, std::stop_token stop) {
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  return command.name.empty() ? List(command, backend.get(), stop)
                              : Show(command, backend.get(), stop);
}

}  // namespace

void AddPresetsCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("presets", "List presets, or show one");
  const auto command = std::make_shared<PresetsCommand>();
  subcommand->add_option("name", command->name, "Preset to show");
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->add_flag("--json", command->json,
                       "Print JSON; of one preset, its recipe");
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
