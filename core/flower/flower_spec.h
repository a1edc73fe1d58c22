// FlowerSpec: everything that determines a flower, or a bed of them, as plain
// data.
//
// A spec is only data: ValidateFlowerSpec (core/flower/validate_flower.h) says
// what is wrong with it, Flower::Create refuses one that is not valid. Lengths
// are in units of a petal of size 1 (its sketch goes from (0, 0) to (0, 1)),
// unless their name ends in _m: metres. Angles are in degrees. z is up, a
// plant's stem rises from the origin of the plant.
//
// Source: Wang, Zhang & Yang, "Flower simulation based on Perlin noise",
// Journal of Shenzhen University Science and Engineering 36(4), 2019. The
// paper's symbols stand in brackets. What it leaves open is ours: shapes,
// colours, solids, stems, layers, variation and beds.
#ifndef TERRANE_CORE_FLOWER_FLOWER_SPEC_H_
#define TERRANE_CORE_FLOWER_FLOWER_SPEC_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/mesh/scene.h"

namespace terrane::core {

// Revision of the flower algorithm: the same spec and revision give the same
// bytes everywhere. New bytes need a new revision.
inline constexpr int kFlowerRevision = 1;

// What an instance is.
enum class FlowerOrgan : std::uint8_t {
  kStem,
  kLeaf,
  kSepal,
  kPetal,
  kStamen,
  kPistil,
  kFloret,
  kReceptacle
};

// How petals and leaves are made: the paper's method, and the two that it
// compares with (its table 2).
enum class PetalMethod {
  kPerlin,  // sketch, Perlin noise, shape
  kIfs,     // an iterated function system's points over the sketch; flat
  kBezier   // one bicubic patch, 16 control points, through the same shape
};

// --- Blades: petals, sepals and leaves --------------------------------------

struct SketchPoint {
  double x = 0;  // half the width, [0, 2]
  double y = 0;  // along the length, (0, 1)

  bool operator==(const SketchPoint&) const = default;
};

// The end phantom of the spline: kRound mirrors the neighbour, so the end is
// level; kPointed doubles the end.
enum class SketchEnd { kRound, kPointed };

// A half outline: from the base (0, 0) through 2 or 3 points, y rising
// strictly, to the tip (0, 1). The other side is its mirror image. The curve
// must not fold back (y falls) nor cross the axis.
struct Sketch {
  std::vector<SketchPoint> points;
  SketchEnd base = SketchEnd::kPointed;
  SketchEnd tip = SketchEnd::kRound;
};

// Depth z(x, y) = gain * amplitude * noise(frequency_x * x, frequency_y * y).
struct Relief {
  double amplitude = 0.05;  // [Nd], [0, 10]
  double frequency_x = 1;   // [Nsx], [0, 64]
  double frequency_y = 1;   // [Nsy], [0, 64]
  double gain = 1;          // [k], (0, 100]
  // |x| for x: the two halves are mirror images. Petals are, leaves are not.
  bool mirrored = true;
};

// How the sheet is bent. Positive angles turn towards its upper side, which is
// the inner side of a petal that stands upright.
struct BladeShape {
  // Cup: what a strip of length 1 across turns by, [-720, 720].
  double across_deg = 0;
  // Curl: what a strip of length 1 along turns by, at the base and at the tip
  // and linearly between, [-720, 720]. An S has different signs.
  double base_curl_deg = 0;
  double tip_curl_deg = 0;
  // Lip: how far the margin of tip and sides leans out, [-1, 1].
  double flare = 0;
  // Factor of the relief's amplitude, [0, 10]: a bud is smoother.
  double relief = 1;

  bool operator==(const BladeShape&) const = default;
};

// Linear red, green and blue, each in [0, 1].
using Tint = std::array<float, 3>;

// A dark or light band across a petal, such as the face of a pansy.
struct Blotch {
  Tint tint = {1, 1, 1};
  // Where it begins and ends, as distances from the base, 0 <= from < to <= 2.
  double from = 0;
  double to = 0.5;
  // How far its outer edge breaks up into rays, as a share of its breadth, [0,
  // 1].
  double rays = 0;
};

// Factors of the material's colour over a blade.
struct BladeColors {
  Tint base = {1, 1, 1};
  Tint tip = {1, 1, 1};
  // Where base and tip have equal shares, as a distance from the base, (0, 1).
  double middle = 0.5;
  std::optional<Blotch> blotch;
  // A seam along the margin: its colour and breadth, [0, 1]; 0: none.
  Tint margin = {1, 1, 1};
  double margin_width = 0;
};

// What petals or leaves of a kind look like.
struct BladeSpec {
  // One is chosen at random for each petal. At least 1, at most 16.
  std::vector<Sketch> sketches;
  Relief relief;
  // Reliefs of a sketch, told apart by whole lattice offsets, [1, 16].
  int variants = 1;
  // The shape of a closed blade and of one that is quite open; between them it
  // is blended, in so many steps ([1, 16]; 1: always `open`) for equal shares
  // of the opening. Sketches * variants * steps meshes are made.
  BladeShape closed;
  BladeShape open;
  int steps = 1;
  // Cells across (even) and along, [2, 512] and [2, 1024].
  int columns = 16;
  int rows = 24;
  Material material;
  BladeColors colors;
};

// --- Arrangement ------------------------------------------------------------

enum class ArrangementKind {
  kVogel,  // r = c sqrt(n), theta = n * divergence
  kWhorl   // theta = arc (n - 1) / N in each layer
};

// Where the n-th organ of N sits on the receptacle, n = 1 at the centre.
struct Arrangement {
  ArrangementKind kind = ArrangementKind::kVogel;
  double divergence_deg = 137.50776405;  // Vogel's, (0, 360)
  // Distance between neighbours [d = c]: r = radius + d sqrt(n), or radius + d
  // * layer in a whorl (layers count from 1). [0, 100] each.
  double spacing = 0.1;
  double radius = 0;
  // Added to every azimuth, [-360, 360].
  double phase_deg = 0;
  // Whorl: layers, [1, 64], each turned by half a step against the one inside
  // it; and the arc that a layer covers, (0, 360].
  int layers = 1;
  double arc_deg = 360;
  // Heights: of the rim above the head's origin, and of the centre above the
  // rim (a paraboloid), [-100, 100] each.
  double height = 0;
  double dome = 0;
};

// --- Organs -----------------------------------------------------------------

// Petals, or sepals, that are alike but for chance and their place.
struct PetalGroup {
  FlowerOrgan organ = FlowerOrgan::kPetal;  // or kSepal, kLeaf, kFloret
  int count = 5;                            // [Np], [1, 10^5]
  BladeSpec blade;
  Arrangement arrangement;
  // Elevation of a closed petal [phi] and of one that is quite open [phi_open]:
  // 0 lies flat, 90 stands upright, more leans inwards. [-180, 180].
  double angle_deg = 90;
  double open_angle_deg = 20;
  // Length of the first and the last petal (of a whorl: layer), (0, 100]. The
  // last counts where there is only one.
  double inner_size = 1;
  double outer_size = 1;
  // Turn about a petal's own length, so that one edge lies over the neighbour,
  // [-90, 90].
  double swirl_deg = 0;
};

// Stamens, a pistil, disc florets, a receptacle: a cylinder that carries an
// ellipsoid. Of length 0 either one is left out, not both.
struct SolidGroup {
  FlowerOrgan organ = FlowerOrgan::kStamen;  // or kPistil, kFloret, kReceptacle
  int count = 1;                             // [1, 10^5]
  Arrangement arrangement;
  // Elevation of the first and the last, [-180, 180].
  double inner_angle_deg = 90;
  double outer_angle_deg = 90;
  // Scale of the first and the last, (0, 100].
  double inner_size = 1;
  double outer_size = 1;
  // The cylinder and the ellipsoid at its end, [0, 100]; the ellipsoid's centre
  // lies at the cylinder's end.
  double filament_length = 0.3;
  double filament_radius = 0.012;
  double head_length = 0.08;
  double head_radius = 0.03;
  // Faces around, [3, 64].
  int sides = 8;
  Material material;
  Tint filament_tint = {1, 1, 1};
  Tint head_tint = {1, 1, 1};
};

// Leaves on the stem.
struct LeafGroup {
  int count = 6;  // [Nl], [1, 1000]
  BladeSpec blade;
  // Where the lowest and the highest sit, as shares of the stem, [0, 1].
  double from = 0.15;
  double to = 0.75;
  // Elevation of a leaf's base, [-90, 90], and its length, (0, 100].
  double angle_deg = 35;
  double size = 1;
  // Azimuth from leaf to leaf, [0, 360].
  double divergence_deg = 137.50776405;
  // Blades of a leaf: 1, or an odd number of leaflets, [1, 15], in pairs along
  // its stalk and one at the end.
  int leaflets = 1;
  // Length of the stalk, [0, 100]; it is as thick as a third of the stem.
  double stalk = 0.3;
};

// A swept tube.
struct StemSpec {
  double height = 8;    // [h], (0, 1000]
  double radius = 0.1;  // at the base, (0, 10]
  double taper = 0.7;   // the radius at the tip over that at the base, (0, 4]
  // Largest sideways perturbation, as a share of the height, [0, 0.5].
  double bend = 0.03;
  // What the tip leans away from the vertical by, [0, 170].
  double nod_deg = 0;
  // Stems that differ in their perturbation, [1, 16].
  int variants = 2;
  int sides = 10;  // [3, 64]
  int rows = 24;   // [2, 256]
  Material material;
};

// --- Growth, variation and beds ---------------------------------------------

// The paper's growth stage. The petals n <= buds stay closed, the others open
// to phi - angle_ratio (phi - phi_open) (n - buds) / (N - buds), in every group
// of Vogel's. The petals of a whorl's layer open together, to the angle of the
// layer's last; a whorl has no buds.
struct GrowthStage {
  double buds = 0;         // [Nb], [0, 10^5]
  double angle_ratio = 1;  // [Sa], [0, 1]
  double size = 1;         // [S], (0, 100]
  // Factor of every spacing and radius: a bud is narrow. (0, 10].
  double spread = 1;
};

// A field of plants.
struct BedSpec {
  int plants = 1;  // [1, 10^6]
  // kGrid: a square, moved by chance. kVogel: a disc.
  enum class Layout { kGrid, kVogel } layout = Layout::kGrid;
  double spacing_m = 0.3;  // (0, 100]
  double jitter = 0.3;     // of a grid, as a share of the spacing, [0, 1]
  // Chance turns the plants of a bed about their stems, this far at most, [0,
  // 180]; a single plant stands as it is.
  double turn_deg = 180;
};

struct FlowerSpec {
  std::int64_t seed = 0;
  // Metres of one unit, (0, 10].
  double unit_m = 0.05;
  PetalMethod method = PetalMethod::kPerlin;

  // At least one organ in all, at most 16 groups of each kind.
  std::vector<PetalGroup> petals;
  std::vector<SolidGroup> solids;
  std::vector<LeafGroup> leaves;
  std::optional<StemSpec> stem;

  // 0: `early`, 1: `full`, between them a blend.
  double stage = 1;
  GrowthStage early = {0, 0, 0.6, 0.6};
  GrowthStage full;

  // How far chance takes petals and plants from the rule, [0, 1]: angles,
  // sizes, heights, leanings and stages. 0: nothing but the choice of sketches.
  double variation = 0.3;
  BedSpec bed;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_FLOWER_SPEC_H_
