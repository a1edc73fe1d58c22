// The enums of flowers, as server/convert/enum_table.h.
#ifndef TERRANE_SERVER_CONVERT_FLOWER_ENUMS_H_
#define TERRANE_SERVER_CONVERT_FLOWER_ENUMS_H_

#include "core/flower/flower_spec.h"
#include "server/convert/enum_table.h"
#include "terrane/v1/flower_recipe.pb.h"

namespace terrane::server {

// The first row is what an unset organ of petals means.
inline constexpr EnumTable<v1::FlowerOrgan, core::FlowerOrgan, 8> kFlowerOrgans{
    {
        {v1::FLOWER_ORGAN_PETAL, core::FlowerOrgan::kPetal},
        {v1::FLOWER_ORGAN_STEM, core::FlowerOrgan::kStem},
        {v1::FLOWER_ORGAN_LEAF, core::FlowerOrgan::kLeaf},
        {v1::FLOWER_ORGAN_SEPAL, core::FlowerOrgan::kSepal},
        {v1::FLOWER_ORGAN_STAMEN, core::FlowerOrgan::kStamen},
        {v1::FLOWER_ORGAN_PISTIL, core::FlowerOrgan::kPistil},
        {v1::FLOWER_ORGAN_FLORET, core::FlowerOrgan::kFloret},
        {v1::FLOWER_ORGAN_RECEPTACLE, core::FlowerOrgan::kReceptacle},
    }};

inline constexpr EnumTable<v1::PetalMethod, core::PetalMethod, 3> kPetalMethods{
    {
        {v1::PETAL_METHOD_PERLIN, core::PetalMethod::kPerlin},
        {v1::PETAL_METHOD_IFS, core::PetalMethod::kIfs},
        {v1::PETAL_METHOD_BEZIER, core::PetalMethod::kBezier},
    }};

// A base's; a tip is round when unset.
inline constexpr EnumTable<v1::SketchEnd, core::SketchEnd, 2> kSketchEnds{{
    {v1::SKETCH_END_POINTED, core::SketchEnd::kPointed},
    {v1::SKETCH_END_ROUND, core::SketchEnd::kRound},
}};

inline constexpr EnumTable<v1::ArrangementKind, core::ArrangementKind, 2>
    kArrangementKinds{{
        {v1::ARRANGEMENT_KIND_VOGEL, core::ArrangementKind::kVogel},
        {v1::ARRANGEMENT_KIND_WHORL, core::ArrangementKind::kWhorl},
    }};

inline constexpr EnumTable<v1::BedLayout, core::BedSpec::Layout, 2> kBedLayouts{
    {
        {v1::BED_LAYOUT_GRID, core::BedSpec::Layout::kGrid},
        {v1::BED_LAYOUT_VOGEL, core::BedSpec::Layout::kVogel},
    }};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_FLOWER_ENUMS_H_
