#include "core/codec/tree_csv.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/codec/number_text.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

constexpr char kHeader[] =
    "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent,"
    "extension,branch,branch_order,position_in_branch,end_x,end_y,end_z,"
    "radius_end,attach,flags,chromosome\n";

// Where a row lies in its branch.
struct Place {
  std::uint32_t branch = 1;
  std::uint32_t order = 0;
  std::uint32_t position = 1;
  std::uint32_t extension = 0;  // line, 0 when the branch ends
};

// A row that goes on with its parent's branch: its next piece, or a leader.
bool GoesOn(const SegmentBlock& tree, std::size_t row) {
  const bool is_piece = (tree.flags[row - 1] & kContinuedFlag) != 0;
  return is_piece || (tree.flags[row] & kLeaderFlag) != 0;
}

std::vector<Place> PlacesOf(const SegmentBlock& tree) {
  std::vector<Place> places(tree.rows());
  std::uint32_t branches = 1;
  for (std::size_t row = 1; row < tree.rows(); ++row) {
    Place& parent = places[tree.parent[row]];
    Place& place = places[row];
    if (GoesOn(tree, row)) {
      place = {parent.branch, parent.order, parent.position + 1, 0};
      parent.extension = static_cast<std::uint32_t>(row + 1);
    } else {
      place = {++branches, parent.order + 1, 1, 0};
    }
  }
  return places;
}

void AppendNumbers(Float3 p, std::string* text) {
  for (const float number : {p.x, p.y, p.z}) AppendNumber(',', number, text);
}

}  // namespace

std::string EncodeTreeCsv(const SegmentBlock& tree) {
  const std::vector<Place> places = PlacesOf(tree);
  std::string text = kHeader;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    const Place& place = places[row];
    const Float3 along = tree.end[row] - tree.start[row];
    const float length = Length(along);
    AppendNumber(tree.radius_start[row], &text);
    AppendNumber(',', length, &text);
    AppendNumbers(tree.start[row], &text);
    AppendNumbers(length > 0 ? (1.0f / length) * along : Float3{0, 0, 1},
                  &text);
    // The trunk's parent, all ones, wraps to 0.
    AppendNumber(',', tree.parent[row] + 1, &text);
    AppendNumber(',', place.extension, &text);
    AppendNumber(',', place.branch, &text);
    AppendNumber(',', place.order, &text);
    AppendNumber(',', place.position, &text);
    AppendNumbers(tree.end[row], &text);
    AppendNumber(',', tree.radius_end[row], &text);
    AppendNumber(',', tree.attach[row], &text);
    AppendNumber(',', static_cast<unsigned>(tree.flags[row]), &text);
    AppendNumber(',', tree.chromosome[row], &text);
    text.push_back('\n');
  }
  return text;
}

}  // namespace terrane::core
