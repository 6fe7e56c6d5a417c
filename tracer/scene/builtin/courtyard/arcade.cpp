// Columns, round arches with their mouldings, and the cornice below the gallery.
#include <array>

#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Points of a moulding: how far out of the wall (x) against how far across it (y).
constexpr std::array<Vec2, 9> archivolt{{{0, 0.30F},
                                         {0.05F, 0.30F},
                                         {0.07F, 0.27F},
                                         {0.05F, 0.235F},
                                         {0.04F, 0.20F},
                                         {0.04F, 0.09F},
                                         {0.06F, 0.07F},
                                         {0.05F, 0.02F},
                                         {0, 0}}};
constexpr std::array<Vec2, 10> cornice{{{0, 0},
                                        {0.05F, 0.01F},
                                        {0.06F, 0.05F},
                                        {0.05F, 0.08F},
                                        {0.10F, 0.11F},
                                        {0.16F, 0.15F},
                                        {0.18F, 0.18F},
                                        {0.22F, 0.19F},
                                        {0.22F, 0.27F},
                                        {0, 0.28F}}};

/// The point at `t` in [0, 1] of a moulding.
template <std::size_t n>
Vec2 along(const std::array<Vec2, n>& points, float t) {
    const float x = t * static_cast<float>(n - 1);
    const auto i = std::min(static_cast<std::size_t>(x), n - 2);
    const float f = x - static_cast<float>(i);
    return {points[i].x + (points[i + 1].x - points[i].x) * f, points[i].y + (points[i + 1].y - points[i].y) * f};
}

void column(MeshBuilder& b, Fineness fine, float height) {
    b.use(Stuff::pale_stone);
    box(b, {-0.29F, 0, -0.29F}, {0.29F, 0.34F, 0.29F});
    constexpr std::array<Turning, 20> profile{
        {{0.28F, 0.34F, true},  {0.28F, 0.39F, true},   {0.255F, 0.395F, true}, {0.27F, 0.43F},
         {0.25F, 0.465F, true}, {0.22F, 0.475F, true},  {0.20F, 0.50F},         {0.22F, 0.53F, true},
         {0.19F, 0.56F, true},  {0.192F, 1.1F},         {0.165F, 2.02F, true},  {0.185F, 2.03F, true},
         {0.195F, 2.05F},       {0.185F, 2.075F, true}, {0.165F, 2.09F, true},  {0.168F, 2.16F, true},
         {0.21F, 2.19F},        {0.24F, 2.26F, true},   {0.26F, 2.27F, true},   {0.26F, 2.31F, true}}};
    const float stretch = (height - 0.14F) / 2.31F;
    std::vector<Turning> points;
    // Coarse columns keep only the silhouette.
    constexpr std::array<std::size_t, 7> coarse{0, 3, 8, 10, 15, 17, 19};
    if (fine.value < 0.45) {
        for (const std::size_t i : coarse) points.push_back(profile[i]);
    } else {
        points.assign(profile.begin(), profile.end());
    }
    for (Turning& p : points)
        p.y = p.y < 0.35F ? p.y : 0.34F + (p.y - 0.34F) * (stretch * 2.31F - 0.34F) / (2.31F - 0.34F);
    lathe(b, curve(points, fine.of(3, 1)), fine.of(20, 6));
    box(b, {-0.29F, height - 0.14F, -0.29F}, {0.29F, height, 0.29F});
}

/// A corner has a square pier; its mouldings stand out on all sides.
void pier(MeshBuilder& b) {
    b.use(Stuff::pale_stone);
    box(b, {-0.40F, 0, -0.40F}, {0.40F, 0.34F, 0.40F});
    box(b, {-0.36F, 0.34F, -0.36F}, {0.36F, 0.42F, 0.36F});
    box(b, {-0.31F, 0.42F, -0.31F}, {0.31F, spring - 0.2F, 0.31F});
    box(b, {-0.34F, spring - 0.2F, -0.34F}, {0.34F, spring - 0.12F, 0.34F});
    box(b, {-0.38F, spring - 0.12F, -0.38F}, {0.38F, spring, 0.38F});
    b.use(Stuff::ochre_plaster);
    textured_box(b, {-0.28F, spring, -0.28F}, {0.28F, slab_bottom, 0.28F}, 0.4F);
}

/// One bay: x = 0 is the axis of its left column. Both faces of the wall above the arch, soffit, mouldings, keystone.
void arch(MeshBuilder& b, Fineness fine, float pitch) {
    const float middle = pitch / 2, r = pitch / 2 - impost;
    const int segments = 2 * fine.of(9, 3);
    const auto on_arch = [&](float t, float radius) {
        const auto [c, s] = cos_sin(0.5 * static_cast<double>(t));
        return Vec3{middle - radius * c, spring + radius * s, 0};
    };
    b.use(Stuff::ochre_plaster);
    const float uv = 0.4F;
    for (const float face : {-1.F, 1.F}) {
        const float z = face * arch_wall;
        const int rows = fine.of(1.2, 1);
        const auto strip = [&](float u, float v) {
            const Vec3 p = on_arch(face < 0 ? 1 - u : u, r);
            return Vec3{p.x, p.y + (slab_bottom - p.y) * v, z};
        };
        sheet(b, segments, rows, strip, {uv * 2 * r, uv * 1.5F}, false);
        for (const float x : {0.F, pitch - impost}) {
            const float left = face < 0 ? x + impost : x, right = face < 0 ? x : x + impost;
            flat(b, {left, spring, z}, {right, spring, z}, {right, slab_bottom, z}, {left, slab_bottom, z}, uv);
        }
    }
    b.use(Stuff::stone);
    sheet(b, segments, fine.of(2, 1), [&](float u, float v) {
        const Vec3 p = on_arch(1 - u, r);
        return Vec3{p.x, p.y, arch_wall - 2 * arch_wall * v};
    });
    const int pieces = fine.value < 0.45 ? 2 : fine.value < 0.6 ? 4 : std::max(8, fine.of(8, 8));
    for (const float face : {-1.F, 1.F}) {
        if (face > 0 && fine.value < 0.45) continue;
        sheet(b, segments, face < 0 ? pieces : 4, [&](float u, float v) {
            const Vec2 m = along(archivolt, face < 0 ? v : 1 - v);
            const Vec3 p = on_arch(u, r + m.y);
            return Vec3{p.x, p.y, face * (arch_wall + m.x)};
        });
    }
    b.use(Stuff::pale_stone);
    bar(b, {middle, spring + r - 0.06F, -arch_wall - 0.03F}, {middle, spring + r + 0.38F, -arch_wall - 0.03F},
        {0, 0, 1}, 0.2F, 0.18F, fine.of(0.8, 0), 0.02F);
}

}  // namespace

void arcade(MeshBuilder& b, Fineness fine) {
    MeshBuilder round = b.part();
    column(round, fine, spring - arcade_floor);
    MeshBuilder corner = b.part();
    pier(corner);
    for (const Side& side : sides()) {
        MeshBuilder bay = b.part();
        arch(bay, fine, side.pitch());
        b.frame(side.frame);
        b.add(corner, moved({0, 0, 0}));
        for (int i = 0; i < side.bays; ++i) {
            b.add(bay, moved({side.column(i), 0, 0}));
            if (i > 0) b.add(round, moved({side.column(i), arcade_floor, 0}));
        }
        b.use(Stuff::pale_stone);
        const float length = side.length;
        sheet(b, fine.of(2, 1) * side.bays, fine.value < 0.45 ? 3 : std::max(9, fine.of(9, 9)), [&](float u, float v) {
            const Vec2 m = along(cornice, v);
            return Vec3{length * (1 - u), slab_bottom - 0.02F + m.y, -arch_wall - m.x};
        });
    }
    b.frame({});
}

}  // namespace raycache::tracer::courtyard
