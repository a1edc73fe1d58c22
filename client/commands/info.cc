// `terrane info`: what the server is and what it allows.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "client/commands/command.h"
#include "client/commands/shared_options.h"
#include "client/exit_code.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane info
  terrane info --server 127.0.0.1:7400 --json)";

struct InfoCommand {
  ConnectionOptions connection;
  bool json = false;
};

// Every limit by its name in the API, so that a new one is shown unasked.
void PrintLimits(const v1::ServerLimits& limits) {
  const google::protobuf::Descriptor* fields = limits.GetDescriptor();
  const google::protobuf::Reflection* values = limits.GetReflection();
  for (int i = 0; i < fields->field_count(); ++i) {
    const google::protobuf::FieldDescriptor* field = fields->field(i);
    const std::int64_t value =
        field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_INT64
            ? values->GetInt64(limits, field)
            : values->GetInt32(limits, field);
    std::cout << fmt::format("  {:28} {}\n", field->name(), value);
  }
}

int Run(const InfoCommand& command, std::stop_token stop) {
  const absl::StatusOr<v1::GetServerInfoResponse> info =
      MakeBackend(command.connection)->GetServerInfo(stop);
  if (!info.ok()) return ReportStatus(info.status());
  if (command.json) {
    std::cout << JsonLine(*info) << '\n';
    return kExitOk;
  }
  std::cout << fmt::format(
      "terrane {}, terrain revision {}, surface revision {}, SIMD {}, {} "
      "workers, {} presets\n"
      "limits:\n",
      info->version(), info->terrain_revision(), info->surface_revision(),
      info->simd_target(), info->workers(), info->presets_size());
  PrintLimits(info->limits());
  return kExitOk;
}

}  // namespace

void AddInfoCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("info", "Show the server's version and limits");
  const auto command = std::make_shared<InfoCommand>();
  AddConnectionOptions(subcommand, &command->connection);
  subcommand->add_flag("--json", command->json, "Print JSON");
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
