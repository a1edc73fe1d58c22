#include "core/codec/tree_csv.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/codec/number_text.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

constexpr char kColumns[] =
    "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent,"
    "extension,branch,branch_order,position_in_branch,end_x,end_y,end_z,"
    "radius_end,attach,flags,chromosome";

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

// The lines of one tree, behind `lines` of others; `tail` ends each.
void AppendLines(const SegmentBlock& tree, std::uint32_t lines,
                 const std::string& tail, std::string* text) {
  const std::vector<Place> places = PlacesOf(tree);
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    const Place& place = places[row];
    const Float3 along = tree.end[row] - tree.start[row];
    const float length = Length(along);
    AppendNumber(tree.radius_start[row], text);
    AppendNumber(',', length, text);
    AppendNumbers(tree.start[row], text);
    AppendNumbers(length > 0 ? (1.0f / length) * along : Float3{0, 0, 1}, text);
    const std::uint32_t parent = tree.parent[row];
    AppendNumber(',', parent == kNoParent ? 0 : lines + parent + 1, text);
    AppendNumber(',', place.extension == 0 ? 0 : lines + place.extension, text);
    AppendNumber(',', place.branch, text);
    AppendNumber(',', place.order, text);
    AppendNumber(',', place.position, text);
    AppendNumbers(tree.end[row], text);
    AppendNumber(',', tree.radius_end[row], text);
    AppendNumber(',', tree.attach[row], text);
    AppendNumber(',', static_cast<unsigned>(tree.flags[row]), text);
    AppendNumber(',', tree.chromosome[row], text);
    *text += tail;
    text->push_back('\n');
  }
}

}  // namespace

std::string EncodeTreeCsv(const SegmentBlock& tree) {
  std::string text = kColumns;
  text.push_back('\n');
  AppendLines(tree, 0, "", &text);
  return text;
}

std::string TreeCsvForest::Header() {
  std::string text = kColumns;
  text += ",tree\n";
  return text;
}

std::string TreeCsvForest::Add(const SegmentBlock& tree) {
  std::string number;
  AppendNumber(',', trees_++, &number);
  std::string text;
  AppendLines(tree, lines_, number, &text);
  lines_ += static_cast<std::uint32_t>(tree.rows());
  return text;
}

}  // namespace terrane::core
