// The chromosome of a branch: 32 bits, bit 0 the least significant.
//
//   bits   gene       value
//   0-4    length     code * 10 (ABSOLUTE), or a share of the parent's length
//   5-9    angle      deviation from the parent's direction, 30-45 degrees
//   10     axis       0 sympodial, 1 monopodial
//   11     side       0 right, 1 left
//   12-13  count      of children: max(1, code), or code where twigs may end
//   14-31  positions  three of 6 bits: code / 63 along the branch from its
//   base;
//                     without meaning when sympodial (children sit at the tip)
//
// The layout and the values are part of the API and never change. Pure
// functions, safe from any thread.
//
// Source: Wu & Zhou 2008, section 2.3 (1).
#ifndef TERRANE_CORE_TREE_CHROMOSOME_H_
#define TERRANE_CORE_TREE_CHROMOSOME_H_

#include <array>
#include <cstddef>
#include <cstdint>

namespace terrane::core {

enum class Gene {
  kLength,
  kAngle,
  kAxis,
  kSide,
  kCount,
  kPosition0,
  kPosition1,
  kPosition2,
};

inline constexpr int kGenes = 8;
inline constexpr int kPositions = 3;
inline constexpr int kLengthCodeMax = 31;
inline constexpr int kAngleCodeMax = 31;
inline constexpr int kPositionCodeMax = 63;

struct GeneField {
  int shift;
  int width;

  constexpr std::uint32_t Largest() const { return (1u << width) - 1; }
  constexpr std::uint32_t Mask() const { return Largest() << shift; }
};

// By Gene.
inline constexpr std::array<GeneField, kGenes> kGeneFields = {
    {{0, 5}, {5, 5}, {10, 1}, {11, 1}, {12, 2}, {14, 6}, {20, 6}, {26, 6}}};

constexpr GeneField FieldOf(Gene gene) {
  return kGeneFields[static_cast<std::size_t>(gene)];
}

constexpr std::uint32_t CodeOf(std::uint32_t chromosome, Gene gene) {
  return chromosome >> FieldOf(gene).shift & FieldOf(gene).Largest();
}

// `code` is cut to the gene's width.
constexpr std::uint32_t WithCode(std::uint32_t chromosome, Gene gene,
                                 std::uint32_t code) {
  const GeneField field = FieldOf(gene);
  return (chromosome & ~field.Mask()) |
         ((code & field.Largest()) << field.shift);
}

constexpr bool IsMonopodial(std::uint32_t chromosome) {
  return CodeOf(chromosome, Gene::kAxis) == 1;
}
constexpr bool IsLeft(std::uint32_t chromosome) {
  return CodeOf(chromosome, Gene::kSide) == 1;
}

// A chromosome taken apart: the codes, not what they stand for.
struct Genes {
  std::uint32_t length = 0;
  std::uint32_t angle = 0;
  bool monopodial = false;
  bool left = false;
  std::uint32_t count = 0;
  std::array<std::uint32_t, kPositions> positions = {};

  bool operator==(const Genes&) const = default;
};

constexpr Genes DecodeChromosome(std::uint32_t chromosome) {
  return {CodeOf(chromosome, Gene::kLength),
          CodeOf(chromosome, Gene::kAngle),
          IsMonopodial(chromosome),
          IsLeft(chromosome),
          CodeOf(chromosome, Gene::kCount),
          {CodeOf(chromosome, Gene::kPosition0),
           CodeOf(chromosome, Gene::kPosition1),
           CodeOf(chromosome, Gene::kPosition2)}};
}

// Codes are cut to the widths of their genes.
constexpr std::uint32_t EncodeChromosome(const Genes& genes) {
  std::uint32_t chromosome = 0;
  chromosome = WithCode(chromosome, Gene::kLength, genes.length);
  chromosome = WithCode(chromosome, Gene::kAngle, genes.angle);
  chromosome = WithCode(chromosome, Gene::kAxis, genes.monopodial ? 1 : 0);
  chromosome = WithCode(chromosome, Gene::kSide, genes.left ? 1 : 0);
  chromosome = WithCode(chromosome, Gene::kCount, genes.count);
  chromosome = WithCode(chromosome, Gene::kPosition0, genes.positions[0]);
  chromosome = WithCode(chromosome, Gene::kPosition1, genes.positions[1]);
  return WithCode(chromosome, Gene::kPosition2, genes.positions[2]);
}

// What the codes stand for by default.
constexpr double LengthOfCode(std::uint32_t code) { return 10.0 * code; }
constexpr double AngleDegOfCode(std::uint32_t code) {
  return 30.0 + 15.0 * code / kAngleCodeMax;
}
constexpr double PositionOfCode(std::uint32_t code) {
  return static_cast<double>(code) / kPositionCodeMax;
}

// The trunk: as long as can be, three children at 30, 42 and 56 of 63.
constexpr std::uint32_t DefaultTrunk(bool monopodial) {
  return EncodeChromosome(
      {kLengthCodeMax, 0, monopodial, false, 3, {30, 42, 56}});
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_CHROMOSOME_H_
