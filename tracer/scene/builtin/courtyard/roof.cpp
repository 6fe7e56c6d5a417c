// Roof tiles: rows of channels with their backs down, and rows of covers with their backs up over the joints.
#include "tracer/scene/builtin/courtyard/parts.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

/// Half a cone of unit width and length along +Z, back up (`rise` > 0) or down. The lower end is the wider one, so that
/// each tile covers the next below; its edge is thick.
void tile(MeshBuilder& b, float rise, int across, int along, bool lip) {
    const auto at = [&](float u, float v, float shrink) {
        const float radius = 0.5F * (1 - 0.18F * v) * shrink;
        const auto [c, s] = cos_sin(0.5 * static_cast<double>(u));
        return Vec3{radius * c, rise * (radius * s - 0.12F * v), v};
    };
    if (rise > 0) {
        sheet(b, across, along, [&](float u, float v) { return at(u, v, 1); });
        if (lip)
            sheet(
                b, across, 1, [&](float u, float v) { return at(u, 0, 0.86F + 0.14F * v); }, {}, false);
        if (lip) sheet(b, across, along, [&](float u, float v) { return at(1 - u, v, 0.86F); });
    } else {
        sheet(b, across, along, [&](float u, float v) { return at(u, v, 1); });
    }
}

}  // namespace

void roof(MeshBuilder& b, Fineness fine) {
    const bool coarse = fine.value < 0.3;  // covers only, on the bed
    const float width = coarse             ? 0.52F
                        : fine.value < 0.5 ? 0.44F
                        : fine.value < 0.9 ? 0.32F
                                           : 0.24F;  // from cover to cover
    const float length = 1.7F * width;
    const int across = fine.of(5, 2), along = fine.of(1.5, 1);
    MeshBuilder cover = b.part(), channel = b.part();
    tile(cover, 1, across, along, fine.value > 0.6);
    tile(channel, -1, across, along, false);
    const float slope = (ridge_y - eaves_y) / (ridge_z - eaves_z);
    const Vec3 up_slope = normalize(Vec3{0, slope, 1}), out = normalize(Vec3{0, 1, -slope});
    const float run = length * up_slope.z;
    Random random(21);
    for (const Side& side : sides()) {
        b.frame(side.frame);
        const float first = -ridge_z, span = side.length + 2 * ridge_z;
        const int strips = static_cast<int>(span / width);
        for (int i = 0; i < 2 * strips; ++i) {
            const float x = first + (static_cast<float>(i) + 0.5F) * span / static_cast<float>(2 * strips);
            const bool back_up = i % 2 == 0;
            if (coarse && !back_up) continue;
            for (float z = eaves_z; z < ridge_z - 0.3F * run; z += run) {
                const float middle = z + run / 2;
                const float wobble_x = random.in(-0.012F, 0.012F), wobble_y = random.in(-0.006F, 0.010F);
                const float twist = random.in(-0.03F, 0.03F);
                const std::uint32_t colour = random.below(8);
                if (middle < -x - run / 2 || middle < x - side.length - run / 2) continue;  // beyond the valley
                const Vec3 across_slope = normalize(Vec3{1, 0, twist});
                const Transform place{
                    across_slope * (0.72F * width), out * (0.72F * width), up_slope * (1.15F * length),
                    Vec3{x + wobble_x, roof_y(z) + wobble_y, z} + out * (0.05F + (back_up ? 0.03F : 0.34F * width))};
                const Stuff clay = colour < 4 ? Stuff::tile_red : colour < 7 ? Stuff::tile_orange : Stuff::tile_brown;
                b.add(back_up ? cover : channel, place, clay);
            }
        }
        b.use(Stuff::tile_brown);  // the bed below
        const float n = eaves_z, l = side.length, z2 = ridge_z, lift = 0.03F;
        flat(b, {l + n, eaves_y + lift, n}, {-n, eaves_y + lift, n}, {-z2, ridge_y + lift, z2},
             {l + z2, ridge_y + lift, z2});
        b.use(Stuff::dark_wood);
        bar(b, {-n, eaves_y - 0.01F, n}, {l + n, eaves_y - 0.01F, n}, {0, 1, 0}, 0.04F, 0.12F, 0);
    }
    b.frame({});
}

}  // namespace raycache::tracer::courtyard
