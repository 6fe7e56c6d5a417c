// Walls, ceiling with its cornice, skirting, windows with the daylight behind them, radiators.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

/// A piece of the wall at X = 0, seen from the room.
void window_wall(MeshBuilder& b, float z0, float z1, float y0, float y1) {
    flat(b, {0, y0, z1}, {0, y0, z0}, {0, y1, z0}, {0, y1, z1});
}

void walls(MeshBuilder& b) {
    b.use(Stuff::blue_wall);
    flat(b, {0, 0, 0}, {width, 0, 0}, {width, height, 0}, {0, height, 0});
    b.use(Stuff::wall);
    flat(b, {width, 0, 0}, {width, 0, depth}, {width, height, depth}, {width, height, 0});
    flat(b, {width, 0, depth}, {0, 0, depth}, {0, height, depth}, {width, height, depth});
    window_wall(b, 0, depth, 0, sill);
    window_wall(b, 0, depth, lintel, height);
    float z = 0;
    for (const Window& w : windows) {
        window_wall(b, z, w.from, sill, lintel);
        z = w.to;
    }
    window_wall(b, z, depth, sill, lintel);
    b.use(Stuff::ceiling);
    flat(b, {0, height, 0}, {width, height, 0}, {width, height, depth}, {0, height, depth});
    b.use(Stuff::dark_wood);  // below the boards
    flat(b, {0, -0.01F, depth}, {width, -0.01F, depth}, {width, -0.01F, 0}, {0, -0.01F, 0});
}

/// Runs once around the room. Points of the profile: distance from the wall, and height.
void moulding(MeshBuilder& b, std::span<const Vec2> profile, int pieces) {
    const auto corner = [](float in, int i) {
        return Vec2{i == 0 || i == 3 ? in : width - in, i < 2 ? in : depth - in};
    };
    for (int side = 0; side < 4; ++side) {
        sheet(
            b, pieces, static_cast<int>(profile.size()) - 1,
            [&](float u, float v) {
                const float place = v * static_cast<float>(profile.size() - 1);
                const auto i = std::min(static_cast<std::size_t>(place + 0.5F), profile.size() - 1);
                const Vec2 p = corner(profile[i].x, side), q = corner(profile[i].x, (side + 1) % 4);
                return Vec3{p.x + (q.x - p.x) * u, profile[i].y, p.y + (q.y - p.y) * u};
            },
            {0, 0}, false);
    }
}

void window(MeshBuilder& b, const Window& w, Fineness fine) {
    const float out = -wall_thickness;
    // A lit sheet at the end of a box outside; so far out that no shadow ray from a reveal is short, which would make
    // the light there all noise.
    const float sky = out - 0.4F, margin = 0.25F, z0 = w.from - margin, z1 = w.to + margin;
    const float y0 = sill - margin, y1 = lintel + margin;
    b.use(Stuff::daylight);
    flat(b, {sky, y0, z1}, {sky, y0, z0}, {sky, y1, z0}, {sky, y1, z1});
    b.use(Stuff::wall);
    flat(b, {sky, y0, z0}, {out, y0, z0}, {out, y1, z0}, {sky, y1, z0});
    flat(b, {out, y0, z1}, {sky, y0, z1}, {sky, y1, z1}, {out, y1, z1});
    flat(b, {sky, y1, z0}, {out, y1, z0}, {out, y1, z1}, {sky, y1, z1});
    flat(b, {sky, y0, z1}, {out, y0, z1}, {out, y0, z0}, {sky, y0, z0});
    b.use(Stuff::white_paint);  // reveals
    flat(b, {out, sill, w.from}, {0, sill, w.from}, {0, lintel, w.from}, {out, lintel, w.from});
    flat(b, {0, sill, w.to}, {out, sill, w.to}, {out, lintel, w.to}, {0, lintel, w.to});
    flat(b, {out, lintel, w.from}, {0, lintel, w.from}, {0, lintel, w.to}, {out, lintel, w.to});
    const int rounding = fine.of(2, 1);
    const float z = -0.2F, middle = (w.from + w.to) / 2;
    for (const float at : {w.from + 0.03F, middle, w.to - 0.03F})
        bar(b, {z, sill, at}, {z, lintel, at}, {1, 0, 0}, at == middle ? 0.09F : 0.06F, 0.06F, rounding);
    for (const float y : {sill + 0.03F, lintel - 0.5F, lintel - 0.03F})
        bar(b, {z, y, w.from}, {z, y, w.to}, {0, 1, 0}, 0.06F, 0.06F, rounding);
    bar(b, {-0.12F, sill, w.from - 0.04F}, {-0.12F, sill, w.to + 0.04F}, {0, 1, 0}, 0.42F, 0.04F, rounding, 0.015F);
    b.use(Stuff::brass);
    ball(b, {z + 0.05F, sill + 0.7F, middle}, 0.018F, fine.of(12, 6));
    const std::array<Vec3, 3> handle{
        {{z + 0.03F, sill + 0.7F, middle}, {z + 0.07F, sill + 0.7F, middle}, {z + 0.08F, sill + 0.58F, middle}}};
    tube(b, handle, 0.008F, fine.of(10, 4));
}

void radiator(MeshBuilder& b, const Window& w, Fineness fine) {
    b.use(Stuff::white_paint);
    const int rounding = fine.of(2, 1);
    for (float z = w.from + 0.08F; z < w.to - 0.06F; z += 0.052F)
        bar(b, {0.09F, 0.14F, z}, {0.09F, 0.7F, z}, {1, 0, 0}, 0.034F, 0.1F, rounding, 0.016F);
    for (const float y : {0.18F, 0.66F}) {
        const std::array<Vec3, 2> pipe{{{0.09F, y, w.from + 0.04F}, {0.09F, y, w.to - 0.04F}}};
        tube(b, pipe, 0.022F, fine.of(12, 5));
    }
}

}  // namespace

void shell(MeshBuilder& b, Fineness fine) {
    walls(b);
    b.use(Stuff::white_paint);
    // Outwards from the wall and upwards, so that the front is the room's.
    std::vector<Vec2> cornice{{0, height - 0.16F}, {0.02F, height - 0.16F}},
        skirting{{0.018F, 0}, {0.018F, 0.09F}, {0.012F, 0.1F}, {0, 0.11F}};
    const int steps = fine.of(6, 2);
    for (int i = 0; i <= steps; ++i) {
        const auto [c, s] = cos_sin(0.25 * i / steps);
        cornice.push_back({0.14F - 0.12F * c, height - 0.14F + 0.12F * s});
    }
    cornice.push_back({0.14F, height});
    moulding(b, cornice, fine.of(4, 1));
    moulding(b, skirting, fine.of(4, 1));
    for (const Window& w : windows) {
        window(b, w, fine);
        radiator(b, w, fine);
    }
}

void floor_boards(MeshBuilder& b, Fineness fine) {
    Random random(301);
    b.use(Stuff::oak);
    constexpr float board = 0.142F, gap = 0.002F;
    const int along = fine.of(4, 1), across = std::max(2, fine.of(3, 2));
    for (float z = 0; z < depth - 0.01F; z += board) {
        float x = 0;
        float next = random.in(0.4F, 1.8F);
        while (x < width - 0.01F) {
            const float end = std::min(width, x + next), far = std::min(depth, z + board);
            next = random.in(1.3F, 2.2F);
            const float tilt = random.in(-0.0006F, 0.0006F);
            sheet(
                b, along, across,
                [&](float u, float v) {
                    const float edge = std::min(v, 1 - v) * board;
                    const float drop = edge < 0.004F ? 0.0015F : 0;
                    return Vec3{x + gap + (end - x - 2 * gap) * u, tilt * (u - 0.5F) - drop,
                                far - gap - (far - z - 2 * gap) * v};
                },
                {(end - x) * 0.5F, board * 0.5F}, false);
            x = end;
        }
    }
}

}  // namespace raycache::tracer::room
