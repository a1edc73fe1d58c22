// Organs that the flowers of tests/core/flower_presets.h share.
#ifndef TERRANE_TESTS_CORE_FLOWER_PARTS_H_
#define TERRANE_TESTS_CORE_FLOWER_PARTS_H_

#include "core/flower/flower_spec.h"

namespace terrane::core {

// Seen from both sides.
Material MakeMaterial(const char* name, Tint color, float roughness = 0.8f);
Material LeafMaterial();

StemSpec MakeStem(double height, double radius);

// An oval blade with a pointed tip, `width` half its breadth.
BladeSpec MakeLeaf(double width);
LeafGroup MakeLeaves(int count, double width, double size);

// An ellipsoid in the middle of the head.
SolidGroup MakeReceptacle(double length, double radius, double height);
// A whorl that lies back as the flower opens.
PetalGroup MakeSepals(int count, double width, double size);
SolidGroup MakeStamens(int count, double length, Tint filament, Tint head);

// Of heads such as the daisy's: the petals around the disc, and its florets.
PetalGroup MakeRays(int count, int layers, double width, double radius,
                    Tint color);
SolidGroup MakeDiscFlorets(int count, double spacing, double dome, Tint low,
                           Tint top);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_FLOWER_PARTS_H_
