// TreeMesher: the rows of a tree as tubes, block by block.
//
// A second pass that draws no random numbers: one skeleton gives many meshes.
// A branch is one tube; the pieces of a bent branch share their rings. A tube
// has `sides` faces around, fewer with each generation, and one vertex more
// than that in a ring, so that the texture wraps without a seam: its u is a
// whole number at both ends. Vertices of a ring share unit normals that follow
// the taper.
//
// Ends: a tip is closed by a dome as wide as the branch. A child begins at its
// parent's axis and is nowhere thicker than it, so its open base lies inside
// the parent's tube, or inside the dome at its tip: the joint shows no gap.
//
// Level of detail: `last_generation` leaves out the finer branches, `sides` and
// `least_sides` say how round the tubes are.
// Immutable, safe from any thread. IEEE operations only: the same bits
// everywhere.
#ifndef TERRANE_CORE_TREE_TREE_MESH_H_
#define TERRANE_CORE_TREE_TREE_MESH_H_

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "core/mesh/mesh.h"
#include "core/mesh/segment_block.h"
#include "core/tree/turn_table.h"

namespace terrane::core {

// kJoined: tips and the trunk's base are closed. kClosed: every base is, so
// each tube is a closed surface. kOpen: nothing is.
enum class TubeEnds { kOpen, kJoined, kClosed };

struct TubeSpec {
  // Faces around the trunk and around the thinnest branch, [3, 64]; generation
  // g has 0.7^g as many as the trunk, but at least the least.
  int sides = 12;
  int least_sides = 3;
  // Rows of later generations are left out, [0, 32].
  int last_generation = 32;
  TubeEnds ends = TubeEnds::kJoined;
  // What one repetition of the texture covers along a branch, in the tree's
  // unit, [1e-6, 1e6]; and how often it goes around the trunk, [1, 64]. Around
  // generation g it goes 0.7^g as often, but at least once.
  double texture_length = 100;
  int texture_repeats = 1;
};

void ValidateTubeSpec(const TubeSpec& spec, const std::string& prefix,
                      Violations* violations);

class TreeMesher {
 public:
  // Vertices of a mesh block: 32 bytes each, under 1 MiB with its indices.
  static constexpr std::size_t kBlockVertices = 20'000;

  // Errors: INVALID_ARGUMENT with violations.
  static absl::StatusOr<TreeMesher> Create(const TubeSpec& spec);

  // Replaces `mesh` by the tubes of the branches from row `*next` of the block
  // on, up to `most_vertices` (or one branch), and sets *next to the first row
  // that is left; rows() when none is. Errors: CANCELLED when `stop` was asked
  // to, polled at least every millisecond.
  absl::Status Next(const SegmentBlock& block, std::stop_token stop,
                    std::size_t most_vertices, std::size_t* next,
                    Mesh* mesh) const;

  // Faces around the branches of a generation.
  int SidesOf(int generation) const;

 private:
  // What the branches of one generation have in common.
  struct Style {
    std::size_t sides = 3;
    std::vector<SineCosine> circle;  // sides + 1, the last as the first
    std::vector<SineCosine> dome;    // rings between the tip's and the apex
    float repeats = 1;
  };

  class Writer;

  explicit TreeMesher(const TubeSpec& spec);

  TubeSpec spec_;
  std::vector<Style> styles_;  // by generation
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_TREE_MESH_H_
