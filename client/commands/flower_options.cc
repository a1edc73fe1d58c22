#include "client/commands/flower_options.h"

#include <map>
#include <string>

#include "client/commands/shared_options.h"

namespace terrane::client {
namespace {

const std::map<std::string, v1::PetalMethod> kMethods = {
    {"perlin", v1::PETAL_METHOD_PERLIN},
    {"ifs", v1::PETAL_METHOD_IFS},
    {"bezier", v1::PETAL_METHOD_BEZIER}};

}  // namespace

void AddGrowthOptions(CLI::App* app, const char* method_name,
                      FlowerOptions* flower) {
  app->add_option("--stage", flower->stage,
                  "Growth, 0 (a bud) to 1 (full bloom)")
      ->group("Flower");
  app->add_option("--plants", flower->plants,
                  "Plants of a bed, 1 to 1,000,000, no two alike")
      ->group("Flower");
  app->add_option(method_name, flower->method,
                  "Petals by perlin (the paper's), ifs or bezier (what it "
                  "compares with)")
      ->transform(OneOf(kMethods))
      ->type_name("NAME")
      ->group("Flower");
}

}  // namespace terrane::client
