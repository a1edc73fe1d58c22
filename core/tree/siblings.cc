#include "core/tree/siblings.h"

#include <utility>

namespace terrane::core {
namespace {

// The highest position taken on each side so far.
class Sides {
 public:
  // Finds the place of the next child and takes it; false when there is none.
  bool Take(int position, bool left, SiblingPlace* place) {
    if (position < Least(left)) {
      if (position >= Least(!left)) {
        left = !left;
      } else {
        position = Least(left);
      }
    }
    if (position > kPositionCodeMax) return false;
    last_[left ? 1 : 0] = position;
    place->position = static_cast<std::uint32_t>(position);
    place->left = left;
    return true;
  }

 private:
  int Least(bool left) const { return last_[left ? 1 : 0] + kLeastGap; }

  std::array<int, 2> last_ = {-kLeastGap, -kLeastGap};
};

SiblingPlaces PlaceAtTip(std::span<const std::uint32_t> members) {
  SiblingPlaces result;
  for (std::size_t i = 0; i < members.size(); ++i) {
    result.places[i] = {i, kPositionCodeMax,
                        IsLeft(members[0]) != (i % 2 == 1)};
  }
  result.count = members.size();
  return result;
}

// The first `count` positions of a chromosome, from base to tip. (Too few for a
// sort of the library.)
std::array<std::uint32_t, kPositions> SortedPositions(std::uint32_t parent,
                                                      std::size_t count) {
  std::array<std::uint32_t, kPositions> positions = {
      CodeOf(parent, Gene::kPosition0), CodeOf(parent, Gene::kPosition1),
      CodeOf(parent, Gene::kPosition2)};
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t j = i; j > 0 && positions[j] < positions[j - 1]; --j) {
      std::swap(positions[j], positions[j - 1]);
    }
  }
  return positions;
}

}  // namespace

SiblingPlaces PlaceSiblings(std::uint32_t parent,
                            std::span<const std::uint32_t> members) {
  if (!IsMonopodial(parent)) return PlaceAtTip(members);
  const std::array<std::uint32_t, kPositions> positions =
      SortedPositions(parent, members.size());
  SiblingPlaces result;
  Sides sides;
  for (std::size_t i = 0; i < members.size(); ++i) {
    SiblingPlace* place = &result.places[result.count];
    place->member = i;
    if (sides.Take(static_cast<int>(positions[i]), IsLeft(members[i]), place)) {
      ++result.count;
    }
  }
  return result;
}

}  // namespace terrane::core
