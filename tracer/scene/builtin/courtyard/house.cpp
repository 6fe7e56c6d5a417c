// The rooms' walls with doors and windows, floors, ceilings and their beams, and a bell tower behind the roof.
#include <array>
#include <span>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

constexpr float wall_z = arcade_depth, reveal = 0.28F;
constexpr float texture_scale = 0.4F;  // repeats per metre

struct Opening {
    float left, right, bottom, top;
    bool door;
};

/// A band of wall seen from the yard (-Z), with holes.
void wall_band(MeshBuilder& b, float left, float right, float bottom, float top, std::span<const Opening> openings) {
    const auto piece = [&](float x0, float x1, float y0, float y1) {
        if (x1 <= x0 || y1 <= y0) return;
        flat(b, {x1, y0, wall_z}, {x0, y0, wall_z}, {x0, y1, wall_z}, {x1, y1, wall_z}, texture_scale);
    };
    float x = left;
    for (const Opening& o : openings) {
        piece(x, o.left, bottom, top);
        piece(o.left, o.right, bottom, std::min(top, o.bottom));
        piece(o.left, o.right, std::max(bottom, o.top), top);
        x = o.right;
    }
    piece(x, right, bottom, top);
}

void reveals(MeshBuilder& b, const Opening& o) {
    b.use(Stuff::white_plaster);
    const float z0 = wall_z, z1 = wall_z + reveal;
    const auto face = [&](Vec3 p, Vec3 q, Vec3 r, Vec3 t) { flat(b, p, q, r, t, texture_scale); };
    face({o.left, o.bottom, z1}, {o.left, o.bottom, z0}, {o.left, o.top, z0}, {o.left, o.top, z1});
    face({o.right, o.bottom, z0}, {o.right, o.bottom, z1}, {o.right, o.top, z1}, {o.right, o.top, z0});
    face({o.right, o.top, z1}, {o.left, o.top, z1}, {o.left, o.top, z0}, {o.right, o.top, z0});
    face({o.left, o.bottom, z1}, {o.right, o.bottom, z1}, {o.right, o.bottom, z0}, {o.left, o.bottom, z0});
}

/// Stone around an opening, a little out of the wall.
void surround(MeshBuilder& b, const Opening& o, int rounding) {
    b.use(Stuff::pale_stone);
    const float w = 0.18F, z = wall_z - 0.01F;
    for (const float x : {o.left - w / 2, o.right + w / 2}) {
        bar(b, {x, o.bottom, z}, {x, o.top, z}, {0, 0, 1}, w, 0.1F, rounding, 0.02F);
    }
    bar(b, {o.left - w, o.top + w / 2, z}, {o.right + w, o.top + w / 2, z}, {0, 1, 0}, 0.1F, w, rounding, 0.02F);
    if (rounding > 0)
        bar(b, {o.left - w - 0.05F, o.top + w + 0.03F, z}, {o.right + w + 0.05F, o.top + w + 0.03F, z}, {0, 1, 0},
            0.22F, 0.06F, rounding, 0.02F);
}

void door(MeshBuilder& b, const Opening& o, Stuff paint, Fineness fine) {
    const float z = wall_z + reveal - 0.03F, middle = (o.left + o.right) / 2, height = o.top - o.bottom;
    const int rounding = fine.of(0.8, 0);
    b.use(paint);
    flat(b, {o.right, o.bottom, z}, {o.left, o.bottom, z}, {o.left, o.top, z}, {o.right, o.top, z});
    const bool coarse = fine.value < 0.45;
    for (const float x : {o.left + 0.06F, middle - 0.06F, middle + 0.06F, o.right - 0.06F}) {
        if (!coarse || x == middle - 0.06F)
            bar(b, {x, o.bottom, z - 0.02F}, {x, o.top, z - 0.02F}, {0, 0, 1}, 0.11F, 0.05F, rounding);
    }
    for (const float level : {0.04F, 0.36F, 0.68F, 0.96F}) {
        const float y = o.bottom + height * level;
        if (coarse && level != 0.68F) continue;
        bar(b, {o.left, y, z - 0.015F}, {o.right, y, z - 0.015F}, {0, 1, 0}, 0.05F, 0.12F, rounding);
    }
    if (coarse) return;
    b.use(Stuff::brass);
    MeshBuilder stud = b.part();
    stud.use(Stuff::brass);
    ball(stud, {}, 0.022F, fine.of(6, 4));
    const int studs = fine.of(5, 2);
    for (int i = 0; i < studs; ++i) {
        const float t = (static_cast<float>(i) + 0.5F) / static_cast<float>(studs);
        for (const float level : {0.36F, 0.68F}) {
            b.add(stud, moved({o.left + (o.right - o.left) * t, o.bottom + height * level, z - 0.045F}));
        }
    }
    ball(b, {middle - 0.09F, o.bottom + 1.05F, z - 0.08F}, 0.04F, fine.of(8, 4));
}

void window(MeshBuilder& b, const Opening& o, Stuff paint, Fineness fine) {
    const float z = wall_z + reveal - 0.02F, width = o.right - o.left;
    const int rounding = fine.of(0.8, 0);
    b.use(Stuff::dark_glass);
    flat(b, {o.right, o.bottom, z}, {o.left, o.bottom, z}, {o.left, o.top, z}, {o.right, o.top, z});
    b.use(paint);
    const bool coarse = fine.value < 0.45;
    for (const float t : {0.03F, 0.5F, 0.97F}) {
        if (coarse && t != 0.5F) continue;
        const float x = o.left + width * t;
        bar(b, {x, o.bottom, z - 0.02F}, {x, o.top, z - 0.02F}, {0, 0, 1}, 0.07F, 0.05F, rounding);
    }
    for (const float t : {0.03F, 0.35F, 0.66F, 0.97F}) {
        if (coarse && t != 0.66F) continue;
        const float y = o.bottom + (o.top - o.bottom) * t;
        bar(b, {o.left, y, z - 0.02F}, {o.right, y, z - 0.02F}, {0, 1, 0}, 0.04F, 0.05F, rounding);
    }
    b.use(Stuff::iron);  // a grille in front
    const int bars = std::min(11, fine.of(7, 3));
    for (int i = 0; i < bars; ++i) {
        const float x = o.left + width * (static_cast<float>(i) + 0.5F) / static_cast<float>(bars);
        const std::array<Vec3, 2> rod{{{x, o.bottom - 0.02F, wall_z - 0.10F}, {x, o.top + 0.02F, wall_z - 0.10F}}};
        tube(b, rod, 0.010F, fine.of(6, 3));
    }
    for (const float t : {0.0F, 0.33F, 0.67F, 1.0F}) {
        if (coarse && t != 0.33F) continue;
        const float y = o.bottom + (o.top - o.bottom) * t;
        bar(b, {o.left - 0.05F, y, wall_z - 0.10F}, {o.right + 0.05F, y, wall_z - 0.10F}, {0, 1, 0}, 0.03F, 0.012F, 0);
    }
}

void storey(MeshBuilder& b, const Side& side, Fineness fine, bool upper) {
    const float floor = upper ? gallery_floor : arcade_floor, top = upper ? roof_y(wall_z) : slab_bottom;
    std::vector<Opening> openings;
    for (int i = 0; i < side.bays; ++i) {
        const float x = side.column(i) + side.pitch() / 2;
        const bool is_door = (i + (upper ? 1 : 0)) % 2 == 0;
        if (is_door)
            openings.push_back({x - 0.65F, x + 0.65F, floor, floor + 2.35F, true});
        else
            openings.push_back({x - 0.55F, x + 0.55F, floor + 0.85F, floor + 2.35F, false});
    }
    const float left = -wall_z, right = side.length + wall_z, dado = floor + 0.95F;
    b.use(Stuff::red_plaster);
    wall_band(b, left, right, floor, dado, openings);
    b.use(upper ? Stuff::white_plaster : Stuff::ochre_plaster);
    wall_band(b, left, right, dado, top, openings);
    const Stuff paint = upper ? Stuff::green_paint : Stuff::blue_paint;
    for (const Opening& o : openings) {
        reveals(b, o);
        surround(b, o, fine.of(1, 0));
        if (o.door)
            door(b, o, upper ? paint : Stuff::dark_wood, fine);
        else
            window(b, o, paint, fine);
    }
}

void floors_and_ceilings(MeshBuilder& b, const Side& side, Fineness fine) {
    const float x0 = -wall_z, x1 = side.length - arch_wall, z0 = -arch_wall;
    const float start = -0.45F;  // of the arcade's floor, at the kerb
    const auto level = [&](float y, float l, float r, float near, float far) {
        flat(b, {l, y, far}, {r, y, far}, {r, y, near}, {l, y, near}, 0.8F);
    };
    b.use(Stuff::mosaic);
    level(arcade_floor, x0, side.length + start, start, wall_z);
    level(gallery_floor, x0, x1, z0, wall_z);
    b.use(Stuff::white_plaster);
    flat(b, {x0, slab_bottom, z0}, {x1, slab_bottom, z0}, {x1, slab_bottom, wall_z}, {x0, slab_bottom, wall_z},
         texture_scale);
    b.use(Stuff::light_wood);  // the roof's boards, from below
    const float z2 = ridge_z, n = eaves_z, l = side.length;
    flat(b, {-n, eaves_y, n}, {l + n, eaves_y, n}, {l + z2, ridge_y, z2}, {-z2, ridge_y, z2});
    b.use(Stuff::dark_wood);
    const float apart = fine.value < 0.45 ? 1.24F : 0.62F;
    const int beams = static_cast<int>((side.length + 2 * wall_z) / apart);
    const int around = fine.of(9, 3), rounding = fine.of(0.7, 0);
    for (int i = 0; i < beams; ++i) {
        const float x = -wall_z + 0.3F + apart * static_cast<float>(i);
        if (x < side.length - 0.3F && std::abs(x) > 0.3F) {
            const std::array<Vec3, 2> log{{{x, slab_bottom - 0.03F, x < 0 ? -0.2F : arch_wall - 0.05F},
                                           {x, slab_bottom - 0.03F, wall_z + 0.05F}}};
            tube(b, log, 0.085F, around);
        }
        const float from = std::max({eaves_z + 0.03F, -x, x - side.length});
        if (from < wall_z - 0.3F) {
            bar(b, {x, roof_y(from) - 0.07F, from}, {x, roof_y(wall_z) - 0.07F, wall_z}, {0, 1, 0}, 0.1F, 0.13F,
                rounding, 0.015F);
        }
    }
    b.use(Stuff::white_plaster);  // outside and coping
    const float out = ridge_z + 0.25F;
    flat(b, {-out, 0, out}, {l + out, 0, out}, {l + out, ridge_y + 0.25F, out}, {-out, ridge_y + 0.25F, out},
         texture_scale);
    flat(b, {l + z2, ridge_y - 0.1F, z2}, {-z2, ridge_y - 0.1F, z2}, {-z2, ridge_y + 0.25F, z2},
         {l + z2, ridge_y + 0.25F, z2}, texture_scale);
    b.use(Stuff::pale_stone);
    bar(b, {-out, ridge_y + 0.3F, (out + z2) / 2}, {l + out, ridge_y + 0.3F, (out + z2) / 2}, {0, 1, 0}, 0.4F, 0.1F,
        rounding, 0.03F);
}

/// Stands outside the north-east corner and shows above the roof.
void bell_tower(MeshBuilder& b, Fineness fine) {
    const float h = 1.9F, base = 12.2F, top = 15.4F;
    b.use(Stuff::ochre_plaster);
    textured_box(b, {-h, 0, -h}, {h, base, h}, texture_scale);
    b.use(Stuff::pale_stone);
    box(b, {-h - 0.2F, base, -h - 0.2F}, {h + 0.2F, base + 0.3F, h + 0.2F});
    b.use(Stuff::white_plaster);
    const float spring_y = top - 1.5F, r = 0.75F;
    const int segments = 2 * fine.of(6, 3);
    for (int face = 0; face < 4; ++face) {
        const Transform outer = b.frame();
        b.frame(outer * turned(0.25 * face));
        for (const float x : {-h, r}) {
            textured_box(b, {x, base + 0.3F, h - 0.5F}, {x + h - r, spring_y, h}, texture_scale);
        }
        for (const bool back : {false, true}) {
            sheet(
                b, segments, 1,
                [&](float u, float v) {
                    const auto [c, s] = cos_sin(0.5 * static_cast<double>(back ? u : 1 - u));
                    const float y = spring_y + r * s;
                    return Vec3{r * c, y + (top - y) * v, back ? h - 0.5F : h};
                },
                {1.2F, 0.8F}, false);
            for (const float x : {-h, r}) {
                const float z = back ? h - 0.5F : h, l = back ? x + h - r : x, right = back ? x : x + h - r;
                flat(b, {l, spring_y, z}, {right, spring_y, z}, {right, top, z}, {l, top, z}, texture_scale);
            }
        }
        sheet(b, segments, 1,
              [&](float u, float v) {
                  const auto [c, s] = cos_sin(0.5 * static_cast<double>(u));
                  return Vec3{r * c, spring_y + r * s, h - 0.5F * v};
              },
              {1.0F, 0.2F});
        b.frame(outer);
    }
    b.use(Stuff::pale_stone);
    box(b, {-h - 0.25F, top, -h - 0.25F}, {h + 0.25F, top + 0.35F, h + 0.25F});
    b.use(Stuff::brass);
    constexpr std::array<Turning, 6> bell{
        {{0.62F, -1.3F}, {0.50F, -1.1F}, {0.38F, -0.7F}, {0.32F, -0.35F}, {0.2F, -0.18F}, {0, -0.14F}}};
    const Transform outer = b.frame();
    b.frame(outer * moved({0, top, 0}));
    lathe(b, curve(bell, fine.of(3, 1)), fine.of(18, 8));
    constexpr std::array<Turning, 10> dome{{{1.75F, 0.35F, true},
                                            {1.75F, 0.8F, true},
                                            {1.9F, 0.85F, true},
                                            {1.75F, 0.95F, true},
                                            {1.62F, 1.6F},
                                            {1.15F, 2.3F},
                                            {0.4F, 2.75F, true},
                                            {0.3F, 3.2F, true},
                                            {0.38F, 3.25F, true},
                                            {0, 3.7F}}};
    b.use(Stuff::blue_glaze);
    lathe(b, curve(dome, fine.of(3, 1)), fine.of(24, 12));
    b.frame(outer);
}

}  // namespace

void house(MeshBuilder& b, Fineness fine) {
    for (const Side& side : sides()) {
        b.frame(side.frame);
        storey(b, side, fine, false);
        storey(b, side, fine, true);
        floors_and_ceilings(b, side, fine);
    }
    b.frame(moved({16.6F, 0, -12.6F}));
    bell_tower(b, fine);
    b.frame({});
}

}  // namespace raycache::tracer::courtyard
