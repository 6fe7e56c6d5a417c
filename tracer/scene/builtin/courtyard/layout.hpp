// Where things are: the plan of the house, in metres. The yard is 20 x 14 around the origin; X east, Z south.
#pragma once

#include <array>

#include "tracer/scene/builtin/modelling/mesh_builder.hpp"

namespace raycache::tracer::courtyard {

using namespace modelling;

inline constexpr float half_x = 10, half_z = 7;  // the open yard, to the column axes
inline constexpr float arcade_depth = 3.2F;      // column axis to the rooms' wall
inline constexpr float arcade_floor = 0.14F;     // one step up from the yard
inline constexpr float spring = 2.45F;           // where the arches start
inline constexpr float impost = 0.28F;           // half the width of masonry between two arches
inline constexpr float arch_wall = 0.25F;        // half its thickness
inline constexpr float slab_bottom = 4.05F, gallery_floor = 4.3F;
inline constexpr float beam_bottom = 7.05F, beam_top = 7.4F;
inline constexpr float eaves_z = -0.65F, ridge_z = 3.7F;  // of the roof, in a side's frame
inline constexpr float eaves_y = 7.2F, ridge_y = 9.3F;
/// Height of the roof boards at `z` of a side's frame.
inline constexpr float roof_y(float z) { return eaves_y + (ridge_y - eaves_y) * (z - eaves_z) / (ridge_z - eaves_z); }

/// One wing of the house. Its frame: X along the column axis from 0 to `length`, Y up, Z outwards from the yard.
struct Side {
    Transform frame;
    float length;
    int bays;

    float pitch() const { return length / static_cast<float>(bays); }
    float column(int i) const { return pitch() * static_cast<float>(i); }
};

/// South, east, north, west. The corner of a wing at x < 0 belongs to it, the one at x > length to its neighbour.
inline std::array<Side, 4> sides() {
    return {{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-half_x, 0, half_z}}, 2 * half_x, 6},
             {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {half_x, 0, half_z}}, 2 * half_z, 4},
             {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {half_x, 0, -half_z}}, 2 * half_x, 6},
             {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {-half_x, 0, -half_z}}, 2 * half_z, 4}}};
}

/// Middle of the fountain and radius of its lowest step.
inline constexpr Vec3 fountain_at{0.4F, 0, 0.2F};
inline constexpr float fountain_radius = 2.1F;

struct TreeSite {
    Vec3 at;
    float height, spread;  ///< of the crown: top, and radius
    float planter;         ///< radius of the ring of stone around the trunk
};
inline constexpr std::array<TreeSite, 4> tree_sites{{{{-4.6F, 0, -2.7F}, 7.4F, 2.9F, 0.95F},
                                                     {{5.7F, 0, 2.1F}, 6.2F, 2.3F, 0.85F},
                                                     {{6.6F, 0, -4.2F}, 5.2F, 1.9F, 0.75F},
                                                     {{-0.3F, 0, -5.2F}, 4.8F, 1.6F, 0.7F}}};

struct TableSite {
    Vec3 at;
    float turn;  ///< in turns
    int chairs;
    enum class Kind { round_wood, round_cloth, square_blue } kind;
    bool parasol;
};
inline constexpr std::array<TableSite, 11> table_sites{{
    {{-3.4F, 0, 3.6F}, 0.07F, 4, TableSite::Kind::round_cloth, false},
    {{0.2F, 0, 4.9F}, 0.18F, 4, TableSite::Kind::square_blue, false},
    {{3.4F, 0, 3.7F}, 0.03F, 4, TableSite::Kind::round_cloth, true},
    {{3.6F, 0, -1.9F}, 0.11F, 4, TableSite::Kind::round_cloth, true},
    {{-7.7F, 0, -4.9F}, 0.21F, 4, TableSite::Kind::round_wood, false},
    {{-8.2F, 0, 1.6F}, 0.05F, 3, TableSite::Kind::square_blue, false},
    {{8.4F, 0, -0.6F}, 0.15F, 3, TableSite::Kind::round_wood, false},
    {{-2.6F, arcade_floor, 8.9F}, 0.09F, 3, TableSite::Kind::square_blue, false},
    {{3.9F, arcade_floor, 8.8F}, 0.02F, 4, TableSite::Kind::round_wood, false},
    {{11.9F, arcade_floor, 1.2F}, 0.13F, 3, TableSite::Kind::square_blue, false},
    {{-3.2F, arcade_floor, -8.9F}, 0.17F, 4, TableSite::Kind::round_cloth, false},
}};
inline constexpr float table_height = 0.74F;

}  // namespace raycache::tracer::courtyard
