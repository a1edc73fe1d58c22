// Options that several subcommands share.
#ifndef TERRANE_CLIENT_COMMANDS_SHARED_OPTIONS_H_
#define TERRANE_CLIENT_COMMANDS_SHARED_OPTIONS_H_

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/backend.h"
#include "client/channel_security.h"
#include "client/chosen_terrain.h"

namespace terrane::client {

// The names that an option takes. Its help text lists them itself.
template <typename Value>
CLI::Validator OneOf(const std::map<std::string, Value>& names) {
  return CLI::CheckedTransformer(names, CLI::ignore_case).description("");
}

// Numbers above 0, and from 0. (CLI11's own checks print the largest double in
// full.)
CLI::Validator AboveZero();
CLI::Validator NotNegative();

// Who answers.
struct ConnectionOptions {
  std::string server = "127.0.0.1:50051";
  ChannelSecurity security;
  int stall_seconds = 120;  // 0: streams may stall for ever
  bool local = false;
  int threads = 0;  // 0: every usable CPU
};

void AddConnectionOptions(CLI::App* command, ConnectionOptions* options);
std::unique_ptr<Backend> MakeBackend(const ConnectionOptions& options);

// Which terrain.
void AddTerrainOptions(CLI::App* command, TerrainOptions* options);
// Those of them that a 1-D recipe has.
void AddRecipeOptions(CLI::App* command, TerrainOptions* options);

// What of the file that `spots` names is read.
void AddSpotFileOptions(CLI::App* command, CLI::Option* spots,
                        SpotFileOptions* options);

// Which samples of it.
struct ExtentOptions {
  std::optional<int> level;
  std::vector<std::int64_t> window;  // x, y, width, height; empty: all
  v1::Sampling sampling = v1::SAMPLING_POINT;
};

void AddExtentOptions(CLI::App* command, ExtentOptions* options);
// The same without the window, where tiles are asked for.
void AddSampleOptions(CLI::App* command, ExtentOptions* options);
v1::Window WindowOf(const std::vector<std::int64_t>& numbers);

// A message as JSON on one line, with the field names of the .proto file.
std::string JsonLine(const google::protobuf::Message& message);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_SHARED_OPTIONS_H_
