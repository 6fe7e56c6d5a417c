// The low table of glass, the dining table with its chairs, the sideboard.
#include <array>

#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

void coffee_table(MeshBuilder& b, Fineness fine) {
    const float x = coffee_length / 2, z = coffee_width / 2, top = coffee_height;
    b.use(Stuff::glass);
    flat(b, {-x, top, z}, {x, top, z}, {x, top, -z}, {-x, top, -z});
    b.use(Stuff::steel);
    const int sides = fine.of(14, 5);
    for (const float sx : {-x + 0.02F, x - 0.02F})
        for (const float sz : {-z + 0.02F, z - 0.02F}) {
            const std::array<Vec3, 2> leg{{{sx, 0, sz}, {sx, top - 0.004F, sz}}};
            tube(b, leg, 0.013F, sides);
        }
    for (const float y : {0.12F, top - 0.018F}) {
        for (const float sz : {-z + 0.02F, z - 0.02F}) {
            const std::array<Vec3, 2> rail{{{-x, y, sz}, {x, y, sz}}};
            tube(b, rail, 0.011F, sides);
        }
        for (const float sx : {-x + 0.02F, x - 0.02F}) {
            const std::array<Vec3, 2> rail{{{sx, y, -z}, {sx, y, z}}};
            tube(b, rail, 0.011F, sides);
        }
    }
    b.use(Stuff::walnut);
    textured_box(b, {-x + 0.03F, 0.125F, -z + 0.03F}, {x - 0.03F, 0.145F, z - 0.03F}, 0.8F);
}

void dining_table(MeshBuilder& b, Fineness fine) {
    const float x = dining_length / 2, z = dining_width / 2, top = dining_height;
    b.use(Stuff::walnut);
    const int planks = 5;
    for (int i = 0; i < planks; ++i) {
        const float from = -z + 2 * z * static_cast<float>(i) / planks, to = from + 2 * z / planks - 0.002F;
        textured_box(b, {-x, top - 0.032F, from}, {x, top, to}, 0.9F);
    }
    const int rounding = fine.of(3, 1);
    b.use(Stuff::dark_wood);
    for (const float sx : {-x + 0.1F, x - 0.1F})
        for (const float sz : {-z + 0.09F, z - 0.09F})
            bar(b, {sx * 1.04F, 0, sz * 1.03F}, {sx, top - 0.03F, sz}, {0, 0, 1}, 0.055F, 0.055F, rounding, 0.02F);
    for (const float sz : {-z + 0.09F, z - 0.09F})
        bar(b, {-x + 0.1F, top - 0.08F, sz}, {x - 0.1F, top - 0.08F, sz}, {0, 1, 0}, 0.025F, 0.09F, rounding);
}

/// A wooden shell on four turned legs; the sitter faces +Z.
void chair(MeshBuilder& b, Fineness fine) {
    b.use(Stuff::dark_wood);
    const int sides = fine.of(10, 4), cells = fine.of(10, 3);
    const std::array<float, 2> radii{0.011F, 0.019F};
    for (const float x : {-1.F, 1.F})
        for (const float z : {-1.F, 1.F}) {
            const std::array<Vec3, 2> leg{{{0.23F * x, 0, 0.22F * z}, {0.16F * x, 0.43F, 0.15F * z}}};
            tube(b, leg, radii, sides);
        }
    for (const float z : {-0.17F, 0.17F}) {
        const std::array<Vec3, 2> rung{{{-0.19F, 0.22F, z}, {0.19F, 0.22F, z}}};
        tube(b, rung, 0.009F, sides);
    }
    // Seat and back in one sheet, seen from both sides: v runs from the front edge back and up.
    for (const float side : {1.F, -1.F}) {
        sheet(b, cells, 2 * cells, [&](float u, float v) {
            const float x = side * (u - 0.5F), bowl = 4 * x * x;
            const float bend = std::min(1.F, std::max(0.F, (v - 0.4F) / 0.25F)), soft = bend * bend * (3 - 2 * bend);
            const float flat_z = 0.22F - 0.86F * v, rise = std::max(0.F, v - 0.45F) * 0.8F * soft;
            const float z = v < 0.5F ? flat_z : -0.21F - 0.1F * (v - 0.5F);
            const float wide = 0.43F - 0.06F * v;
            return Vec3{x * wide, 0.44F + 0.02F * bowl * (1 - soft) + rise - (side < 0 ? 0.012F * (1 - soft) : 0),
                        z + 0.05F * bowl * soft - (side < 0 ? 0.012F * soft : 0)};
        });
    }
}

void sideboard(MeshBuilder& b, Fineness fine) {
    const Vec3 from = sideboard_from, to = sideboard_to;
    const int rounding = fine.of(2, 1);
    b.use(Stuff::walnut);
    textured_box(b, {from.x, 0.14F, from.z}, to, 0.7F);
    b.use(Stuff::white_paint);
    const int doors = 3;
    for (int i = 0; i < doors; ++i) {
        const float size = (to.z - from.z - 0.04F) / doors, z = from.z + 0.02F + size * static_cast<float>(i);
        bar(b, {from.x - 0.01F, 0.17F, z + size / 2}, {from.x - 0.01F, to.y - 0.03F, z + size / 2}, {1, 0, 0},
            size - 0.01F, 0.022F, rounding, 0.006F);
        b.use(Stuff::brass);
        ball(b, {from.x - 0.04F, 0.52F, z + (i == 1 ? 0.08F : size - 0.08F)}, 0.016F, fine.of(12, 5));
        b.use(Stuff::white_paint);
    }
    b.use(Stuff::dark_wood);
    for (const float x : {from.x + 0.05F, to.x - 0.05F})
        for (const float z : {from.z + 0.06F, to.z - 0.06F})
            bar(b, {x, 0, z}, {x, 0.14F, z}, {0, 0, 1}, 0.045F, 0.045F, rounding);
}

}  // namespace

void tables(MeshBuilder& b, Fineness fine) {
    b.frame(moved(coffee_table_at));
    coffee_table(b, fine);
    b.frame(moved(dining_table_at));
    dining_table(b, fine);
    MeshBuilder seat = b.part();
    chair(seat, fine);
    struct Place {
        Vec3 at;
        double turn;
    };
    constexpr std::array<Place, 6> places{{{{-0.42F, 0, -0.62F}, 0.01},
                                           {{0.4F, 0, -0.66F}, -0.02},
                                           {{-0.4F, 0, 0.6F}, 0.49},
                                           {{0.44F, 0, 0.62F}, 0.52},
                                           {{1.1F, 0, 0.06F}, 0.76},
                                           {{-1.06F, 0, 0}, 0.25}}};
    for (const Place& p : places) b.add(seat, moved(p.at) * turned(p.turn));
    b.frame({});
    sideboard(b, fine);
}

}  // namespace raycache::tracer::room
