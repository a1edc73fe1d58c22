// The bytes of every kind of flower, kept as text: a change of any bit of any
// prototype or instance shows up here, in every build and on every SIMD target.
//
//   golden_flower_test           compares with flower.txt
//   golden_flower_test --bless   writes flower.txt anew
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/core/flower_presets.h"
#include "tests/core/whole_flower.h"
#include "tests/golden/golden_file.h"

namespace terrane::core {
namespace {

constexpr char kHeader[] =
    "# Golden flowers: one line a preset of tests/core/flower_presets.cc, its\n"
    "# stages, its methods and a bed.\n"
    "#   name | revision | prototypes, vertices, hash | instances, hash\n"
    "# The hashes are FNV-1a, 64 bits, of the columns as little-endian bytes.\n"
    "# New bytes need a new kFlowerRevision (core/flower/flower_spec.h); then\n"
    "# write this file anew with: golden_flower_test --bless\n";

std::string HashText(const std::string& bytes) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3u;
  }
  char text[32];
  std::snprintf(text, sizeof(text), "%016llx",
                static_cast<unsigned long long>(hash));
  return text;
}

std::string Line(const std::string& name, const FlowerSpec& spec) {
  const auto flower = MakeFlower(spec);
  std::string meshes;
  for (const FlowerPrototype& prototype : flower->prototypes()) {
    meshes += MeshBytes(prototype.mesh);
  }
  const InstanceBlock rows = GrowRows(flower);
  return name + " | " + std::to_string(kFlowerRevision) + " | " +
         std::to_string(flower->prototypes().size()) + " " +
         std::to_string(flower->estimate().vertices) + " " + HashText(meshes) +
         " | " + std::to_string(rows.rows()) + " " +
         HashText(RowBytes(rows, 0, rows.rows()));
}

GoldenLines Lines() {
  GoldenLines lines;
  const auto add = [&lines](const std::string& name, const FlowerSpec& spec) {
    lines.emplace_back(name, Line(name, spec));
  };
  for (const std::string& name : FlowerPresetNames()) {
    FlowerSpec spec = FlowerPreset(name);
    add(name, spec);
    spec.seed = -7;
    spec.stage = 0.4;
    add(name + "_at_0.4", spec);
  }
  FlowerSpec rose = FlowerPreset("rose");
  rose.method = PetalMethod::kBezier;
  add("rose_bezier", rose);
  rose.method = PetalMethod::kIfs;
  add("rose_ifs", rose);
  rose = FlowerPreset("rose");
  rose.bed.plants = 20;
  add("bed_of_roses", rose);
  rose.bed.layout = BedSpec::Layout::kVogel;
  rose.variation = 1;
  add("disc_of_roses", rose);
  return lines;
}

void ExpectLines() { ExpectGoldenLines(Lines()); }

TEST(GoldenFlowers, HaveTheBytesTheyHad) { ExpectLines(); }

TEST(GoldenFlowers, HaveTheSameBytesOnEverySimdTarget) {
  OnEverySimdTarget(&ExpectLines);
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  return terrane::core::GoldenMain(argc, argv, terrane::core::kHeader,
                                   &terrane::core::Lines);
}
