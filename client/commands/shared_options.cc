#include "client/commands/shared_options.h"

#include <google/protobuf/util/json_util.h>

#include <chrono>
#include <map>
#include <utility>

#include "client/local_backend.h"
#include "client/remote_backend.h"
#include "client/server_address.h"
#include "core/grid/lattice_window.h"

namespace terrane::client {
namespace {

const std::map<std::string, v1::FractalSource> kSources = {
    {"midpoint", v1::FRACTAL_SOURCE_MIDPOINT},
    {"successive", v1::FRACTAL_SOURCE_SUCCESSIVE},
    {"subdivision", v1::FRACTAL_SOURCE_SUBDIVISION}};

const std::map<std::string, v1::HeightMapping> kMappings = {
    {"boltzmann", v1::HEIGHT_MAPPING_BOLTZMANN},
    {"linear", v1::HEIGHT_MAPPING_LINEAR}};

const std::map<std::string, v1::Sampling> kSamplings = {
    {"point", v1::SAMPLING_POINT}, {"area", v1::SAMPLING_AREA}};

// Each has its variable in the environment, as --server has.
void AddSecurityOptions(CLI::App* command, ChannelSecurity* security) {
  CLI::Option* tls =
      command->add_flag("--tls", security->tls, "Speak TLS with the server")
          ->envname("TERRANE_TLS");
  CLI::Option* ca =
      command->add_option("--tls-ca", security->ca,
                          "Who signs the server's certificate (PEM; default: "
                          "whom the system trusts)");
  CLI::Option* name =
      command->add_option("--tls-name", security->name,
                          "Name in the server's certificate (default: the host "
                          "of --server; a list of replicas has none)");
  CLI::Option* certificate =
      command->add_option("--tls-cert", security->certificate,
                          "This client's certificate chain (PEM), for servers "
                          "that demand one");
  CLI::Option* key =
      command->add_option("--tls-key", security->key, "Its private key (PEM)");
  CLI::Option* token = command->add_option(
      "--token-file", security->token,
      "File with a bearer token; without --tls only for a server on this "
      "machine");
  ca->envname("TERRANE_TLS_CA")->needs(tls);
  name->envname("TERRANE_TLS_NAME")->needs(tls)->type_name("NAME");
  certificate->envname("TERRANE_TLS_CERT")->needs(tls)->needs(key);
  key->envname("TERRANE_TLS_KEY")->needs(certificate);
  token->envname("TERRANE_TOKEN_FILE");
  for (CLI::Option* file : {ca, certificate, key, token}) {
    file->check(CLI::ExistingFile);
  }
  for (CLI::Option* option : {tls, ca, name, certificate, key, token}) {
    option->group("Connection");
  }
}

void AddSpotOptions(CLI::App* command, TerrainOptions* options) {
  CLI::Option* spots =
      command
          ->add_option("--spots", options->spots.path,
                       "Spot heights that are met exactly: a CSV with a header "
                       "(x,y,z), or a vector file that GDAL reads")
          ->check(CLI::ExistingFile)
          ->group("Spot heights");
  AddSpotFileOptions(command, spots, &options->spots);
  command
      ->add_option("--spots-level", options->spots_level,
                   "Level whose lattice the spots snap to (default: --level); "
                   "another level is another terrain")
      ->check(CLI::Range(0, 30))
      ->needs(spots)
      ->group("Spot heights");
}

// Empty when it is an address, as CLI11 wants it.
std::string CheckServer(const std::string& text) {
  return std::string(ParseServerAddress(text).status().message());
}

}  // namespace

CLI::Validator AboveZero() {
  return CLI::Validator(
      [](std::string& text) {
        double number = 0;
        return CLI::detail::lexical_cast(text, number) && number > 0
                   ? std::string()
                   : "must be above 0, got " + text;
      },
      "above 0", "ABOVE ZERO");
}

CLI::Validator NotNegative() {
  return CLI::Validator(
      [](std::string& text) {
        double number = 0;
        return CLI::detail::lexical_cast(text, number) && number >= 0
                   ? std::string()
                   : "must not be below 0, got " + text;
      },
      "0 or above", "NOT NEGATIVE");
}

void AddConnectionOptions(CLI::App* command, ConnectionOptions* options) {
  command
      ->add_option("--server", options->server,
                   "Server to ask, as host:port; replicas as a list or as "
                   "dns:///name:port")
      ->envname("TERRANE_SERVER")
      ->check(CheckServer)
      ->capture_default_str()
      ->group("Connection");
  AddSecurityOptions(command, &options->security);
  command
      ->add_option("--stall-seconds", options->stall_seconds,
                   "A stream that brings nothing for this time is asked for "
                   "again where it stopped; 0: never")
      ->check(CLI::Range(0, 86'400))
      ->capture_default_str()
      ->group("Connection");
  command
      ->add_flag("--local", options->local,
                 "Generate in this process instead of asking a server")
      ->group("Connection");
  command
      ->add_option("--threads", options->threads,
                   "Threads of --local (default: one per usable CPU; a "
                   "cgroup quota counts)")
      ->check(CLI::Range(1, 1024))
      ->group("Connection");
}

std::unique_ptr<Backend> MakeBackend(const ConnectionOptions& options) {
  if (!options.local) {
    Patience patience;
    patience.stall = std::chrono::seconds(options.stall_seconds);
    return std::make_unique<RemoteBackend>(options.server, options.security,
                                           std::move(patience));
  }
  return std::make_unique<LocalBackend>(options.threads);
}

void AddSpotFileOptions(CLI::App* command, CLI::Option* spots,
                        SpotFileOptions* options) {
  command
      ->add_option("--field", options->field,
                   "Field or column of the heights (default: z of a CSV, the Z "
                   "of points and lines)")
      ->needs(spots)
      ->group("Spot heights");
  command
      ->add_option("--error-field", options->error_field,
                   "Field or column of the standard errors (default: "
                   "standard_error or se of a CSV if there, else exact)")
      ->needs(spots)
      ->group("Spot heights");
  command
      ->add_option("--spots-layer", options->layer,
                   "Layer of --spots (default: the only one)")
      ->needs(spots)
      ->group("Spot heights");
  command
      ->add_option("--spots-crs", options->crs,
                   "CRS of the coordinates in --spots, such as EPSG:4326, x "
                   "east (default: the layer's own)")
      ->needs(spots)
      ->group("Spot heights");
}

void AddRecipeOptions(CLI::App* command, TerrainOptions* options) {
  CLI::Option* preset =
      command
          ->add_option("--preset", options->preset,
                       "Preset by name; `terrane presets` lists them")
          ->group("Terrain");
  command
      ->add_option("--recipe", options->recipe_file,
                   "Recipe file: a TerrainRecipe as JSON")
      ->check(CLI::ExistingFile)
      ->excludes(preset)
      ->group("Terrain");
  command
      ->add_option("--seed", options->seed,
                   "Another world of the same kind: any 64-bit number")
      ->group("Terrain");
  command
      ->add_option("--source", options->source,
                   "Fractal: midpoint, successive or subdivision")
      ->transform(OneOf(kSources))
      ->type_name("NAME")
      ->group("Terrain");
  command
      ->add_option("--mapping", options->mapping,
                   "Fractal to height: boltzmann or linear")
      ->transform(OneOf(kMappings))
      ->type_name("NAME")
      ->group("Terrain");
  command
      ->add_option("--roughness", options->roughness,
                   "Hurst exponent H in (0, 1), larger is smoother; auto: "
                   "measured on the elevation model")
      ->group("Terrain");
  command
      ->add_option("--fidelity", options->fidelity,
                   "T in squared height units: 0 is the macro shape itself")
      ->group("Terrain");
  AddSpotOptions(command, options);
}

void AddTerrainOptions(CLI::App* command, TerrainOptions* options) {
  AddRecipeOptions(command, options);
  CLI::Option* dem =
      command
          ->add_option("--dem", options->dem_file,
                       "Elevation model to refine: any raster that GDAL reads")
          ->excludes("--preset")
          ->excludes("--recipe")
          ->group("Terrain");
  command->add_option("--band", options->dem_band, "Band of --dem, from 1")
      ->check(CLI::Range(1, 65535))
      ->needs(dem)
      ->group("Terrain");
  command
      ->add_option("--crs", options->dem_crs,
                   "Warp --dem to this CRS first, such as EPSG:32616 (default: "
                   "its own grid, so that its posts stay exact)")
      ->needs(dem)
      ->group("Terrain");
  command
      ->add_flag("--no-refine", options->no_refine,
                 "Take --dem as a macro shape only: posts do not stay exact")
      ->needs(dem)
      ->group("Terrain");
}

void AddSampleOptions(CLI::App* command, ExtentOptions* options) {
  command
      ->add_option("--level", options->level,
                   "Each level halves the spacing (default: the preset's "
                   "view, 3 with --dem, else 0)")
      ->check(CLI::Range(0, core::kMaxLevel))
      ->group("Samples");
  command
      ->add_option("--sampling", options->sampling,
                   "point: on the lattice; area: at the cells' centres")
      ->transform(OneOf(kSamplings))
      ->type_name("NAME")
      ->default_str("point")
      ->group("Samples");
}

void AddExtentOptions(CLI::App* command, ExtentOptions* options) {
  AddSampleOptions(command, options);
  command
      ->add_option("--window", options->window,
                   "Samples X,Y,WIDTH,HEIGHT of that level (default: all of a "
                   "bounded domain)")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X,Y,W,H")
      ->group("Samples");
}

v1::Window WindowOf(const std::vector<std::int64_t>& numbers) {
  v1::Window window;
  window.set_x(numbers[0]);
  window.set_y(numbers[1]);
  window.set_width(numbers[2]);
  window.set_height(numbers[3]);
  return window;
}

std::string JsonLine(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  // Only a malformed Any could fail, and these messages hold none.
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text;
}

}  // namespace terrane::client
