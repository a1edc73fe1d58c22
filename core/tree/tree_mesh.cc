#include "core/tree/tree_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/field_checks.h"
#include "core/mesh/float3.h"
#include "core/tree/validate.h"

namespace terrane::core {
namespace {

// A number of generation 0 as it is in generation g: 0.7^g times, rounded down
// generation by generation.
int Reduced(int number, int generation, int least) {
  for (int g = 0; g < generation; ++g) number = number * 7 / 10;
  return std::max(number, least);
}

// One past the last row of the branch that row `first` belongs to.
std::size_t EndOfBranch(const SegmentBlock& block, std::size_t first) {
  std::size_t row = first;
  while (row + 1 < block.rows() && (block.flags[row] & kContinuedFlag) != 0) {
    ++row;
  }
  return row + 1;
}

}  // namespace

// Writes the tube of one branch after the other.
class TreeMesher::Writer {
 public:
  Writer(const SegmentBlock& block, const TubeSpec& spec, Mesh* mesh)
      : block_(block),
        v_of_length_(static_cast<float>(1 / spec.texture_length)),
        ends_(spec.ends),
        mesh_(*mesh) {}

  // The branch of rows [first, end).
  void Add(std::size_t first, std::size_t end, const Style& style) {
    style_ = &style;
    if (!(block_.radius_start[first] > 0) || !Begin(first)) return;
    const bool is_trunk = block_.parent[first] == kNoParent;
    if (ends_ == TubeEnds::kClosed ||
        (ends_ == TubeEnds::kJoined && is_trunk)) {
      CloseBase(block_.start[first], block_.radius_start[first]);
    }
    float v = 0;
    for (std::size_t row = first; row < end; ++row) {
      const Float3 along = block_.end[row] - block_.start[row];
      const float length = Length(along);
      const float fall = block_.radius_start[row] - block_.radius_end[row];
      const float slope = length > 0 ? fall / length : 0.0f;
      if (row == first) {
        Ring(block_.start[row], block_.radius_start[row], slope, v, false);
      }
      v += length * v_of_length_;
      // The ring between two pieces faces half way between their directions.
      if (row + 1 < end) {
        const Float3 next = block_.end[row + 1] - block_.start[row + 1];
        TurnTo(Normalized(along + (length / Length(next)) * next));
      } else {
        TurnTo((1.0f / length) * along);
      }
      Ring(block_.end[row], block_.radius_end[row], slope, v, true);
    }
    if (ends_ != TubeEnds::kOpen && block_.radius_end[end - 1] > 0) {
      CloseTip(block_.end[end - 1], block_.radius_end[end - 1], v);
    }
  }

 private:
  // False for a branch without length.
  bool Begin(std::size_t first) {
    const Float3 along = block_.end[first] - block_.start[first];
    const float length = Length(along);
    if (!(length > 0)) return false;
    direction_ = (1.0f / length) * along;
    right_ = Perpendicular(direction_);
    return true;
  }

  // Turns the ring's frame without twisting it.
  void TurnTo(Float3 direction) {
    direction_ = direction;
    right_ = Normalized(right_ - Dot(right_, direction) * direction);
  }

  std::uint32_t Vertices() const {
    return static_cast<std::uint32_t>(mesh_.positions.size());
  }

  void Vertex(Float3 position, Float3 normal, float u, float v) {
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
    mesh_.uvs.push_back({u, v});
  }

  void Triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  // A ring of a surface that narrows by `slope`, joined to the one before.
  void Ring(Float3 centre, float radius, float slope, float v, bool joins) {
    const std::uint32_t first = Vertices();
    const Float3 front = Cross(direction_, right_);
    const float scale = 1.0f / std::sqrt(1.0f + slope * slope);
    const auto sides = static_cast<std::uint32_t>(style_->sides);
    const float step = style_->repeats / static_cast<float>(sides);
    for (std::uint32_t k = 0; k <= sides; ++k) {
      const SineCosine at = style_->circle[k];
      const Float3 out = at.cosine * right_ + at.sine * front;
      Vertex(centre + radius * out, scale * (out + slope * direction_),
             k == sides ? style_->repeats : step * static_cast<float>(k), v);
    }
    if (!joins) return;
    const std::uint32_t below = first - (sides + 1);
    for (std::uint32_t k = 0; k < sides; ++k) {
      Triangle(below + k, below + k + 1, first + k + 1);
      Triangle(below + k, first + k + 1, first + k);
    }
  }

  // A dome over the ring written last.
  void CloseTip(Float3 centre, float radius, float v) {
    for (const SineCosine& height : style_->dome) {
      v += radius * v_of_length_ / static_cast<float>(style_->dome.size() + 1);
      // A ring of a sphere: its slope is the tangent of its latitude.
      Ring(centre + (height.sine * radius) * direction_, height.cosine * radius,
           height.sine / height.cosine, v, true);
    }
    const auto sides = static_cast<std::uint32_t>(style_->sides);
    const std::uint32_t apex = Vertices();
    const std::uint32_t below = apex - (sides + 1);
    const Float3 top = centre + radius * direction_;
    const float step = style_->repeats / static_cast<float>(sides);
    for (std::uint32_t k = 0; k < sides; ++k) {
      Vertex(top, direction_, step * (static_cast<float>(k) + 0.5f),
             v + radius * v_of_length_);
      Triangle(below + k, below + k + 1, apex + k);
    }
  }

  // A flat disc that faces down the branch.
  void CloseBase(Float3 centre, float radius) {
    const Float3 front = Cross(direction_, right_);
    const Float3 normal = -1.0f * direction_;
    const auto sides = static_cast<std::uint32_t>(style_->sides);
    const std::uint32_t middle = Vertices();
    const float size = radius * v_of_length_;
    Vertex(centre, normal, 0, 0);
    for (std::uint32_t k = 0; k < sides; ++k) {
      const SineCosine at = style_->circle[k];
      Vertex(centre + radius * (at.cosine * right_ + at.sine * front), normal,
             size * at.cosine, size * at.sine);
    }
    for (std::uint32_t k = 0; k < sides; ++k) {
      Triangle(middle, middle + 1 + (k + 1) % sides, middle + 1 + k);
    }
  }

  const SegmentBlock& block_;
  const float v_of_length_;
  const TubeEnds ends_;
  Mesh& mesh_;
  const Style* style_ = nullptr;
  // Of the ring in hand.
  Float3 direction_;
  Float3 right_;
};

void ValidateTubeSpec(const TubeSpec& spec, const std::string& prefix,
                      Violations* violations) {
  const Path root(&prefix);
  FieldChecks checks(violations);
  checks.Integer(root.Field("sides"), spec.sides, 3, 64);
  checks.Integer(root.Field("least_sides"), spec.least_sides, 3, 64);
  checks.Integer(root.Field("last_generation"), spec.last_generation, 0,
                 kMaxTreeDepth);
  checks.Number(root.Field("texture_length"), spec.texture_length, {1e-6, 1e6});
  checks.Integer(root.Field("texture_repeats"), spec.texture_repeats, 1, 64);
}

TreeMesher::TreeMesher(const TubeSpec& spec) : spec_(spec) {
  for (int generation = 0; generation <= kMaxTreeDepth; ++generation) {
    Style style;
    const int sides = SidesOf(generation);
    style.sides = static_cast<std::size_t>(sides);
    for (int k = 0; k <= sides; ++k) {
      style.circle.push_back(SineCosineOfDegrees(360.0 * (k % sides) / sides));
    }
    const int rings = sides / 4;
    for (int ring = 1; ring <= rings; ++ring) {
      style.dome.push_back(SineCosineOfDegrees(90.0 * ring / (rings + 1)));
    }
    style.repeats =
        static_cast<float>(Reduced(spec.texture_repeats, generation, 1));
    styles_.push_back(style);
  }
}

absl::StatusOr<TreeMesher> TreeMesher::Create(const TubeSpec& spec) {
  Violations violations;
  ValidateTubeSpec(spec, "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  return TreeMesher(spec);
}

int TreeMesher::SidesOf(int generation) const {
  return Reduced(spec_.sides, generation, spec_.least_sides);
}

absl::Status TreeMesher::Next(const SegmentBlock& block, std::stop_token stop,
                              std::size_t most_vertices, std::size_t* next,
                              Mesh* mesh) const {
  mesh->positions.clear();
  mesh->normals.clear();
  mesh->uvs.clear();
  mesh->indices.clear();
  Writer writer(block, spec_, mesh);
  GenerationWalk generations(block);
  while (*next < block.rows()) {
    if (stop.stop_requested()) {
      return absl::CancelledError("meshing stopped");
    }
    const int generation = generations.At(*next);
    if (generation > spec_.last_generation) {
      *next = block.rows();
      break;
    }
    const Style& style = styles_[static_cast<std::size_t>(generation)];
    const std::size_t end = EndOfBranch(block, *next);
    // Rings, the dome's and two discs.
    const std::size_t vertices =
        (end - *next + style.dome.size() + 4) * (style.sides + 1);
    if (!mesh->positions.empty() &&
        mesh->positions.size() + vertices > most_vertices) {
      break;
    }
    writer.Add(*next, end, style);
    *next = end;
  }
  return absl::OkStatus();
}

}  // namespace terrane::core
