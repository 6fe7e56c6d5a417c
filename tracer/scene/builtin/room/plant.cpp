// A fig in its pot, in the corner beside the window.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

MeshBuilder leaf(const MeshBuilder& like, Fineness fine) {
    MeshBuilder part = like.part();
    part.use(Stuff::leaf_dark);
    // Along +Y, folded along its middle, drooping towards +Z.
    sheet(part, 2 * fine.of(1, 1), fine.of(4, 2), [](float u, float v) {
        const float x = 2 * u - 1, wide = 0.05F * (0.08F + 3.6F * v * (1 - v) * (1.25F - 0.5F * v));
        return Vec3{x * wide, 0.15F * v, 0.05F * v * v + 0.35F * wide * (x < 0 ? -x : x)};
    });
    return part;
}

}  // namespace

void plant(MeshBuilder& b, Fineness fine) {
    Random random(351);
    b.frame(moved(plant_at));
    constexpr std::array<Turning, 7> pot{{{0, 0},
                                          {0.14F, 0, true},
                                          {0.19F, 0.3F},
                                          {0.2F, 0.34F, true},
                                          {0.18F, 0.34F, true},
                                          {0.17F, 0.3F, true},
                                          {0, 0.3F}}};
    b.use(Stuff::porcelain);
    lathe(b, curve(pot, fine.of(3, 1)), fine.of(40, 10));
    b.use(Stuff::soil);
    disc(b, {0, 0.305F, 0}, 0.172F, fine.of(24, 8));
    const MeshBuilder one = leaf(b, fine);
    constexpr int stems = 5, leaves_of_stem = 46;
    for (int s = 0; s < stems; ++s) {
        const auto [c, sine] = cos_sin((s + 0.2 * static_cast<double>(random.unit())) / stems);
        const float reach = random.in(0.1F, 0.34F), tall = random.in(0.95F, 1.5F);
        const auto at = [&, c = c, sine = sine](float t) {
            const float out = 0.04F + reach * t * t;
            return Vec3{out * c, 0.29F + tall * t * (1.15F - 0.15F * t), -out * sine};
        };
        std::vector<Vec3> path;
        std::vector<float> radii;
        const int pieces = fine.of(14, 4);
        for (int i = 0; i <= pieces; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(pieces);
            path.push_back(at(t));
            radii.push_back(0.013F - 0.009F * t);
        }
        b.use(Stuff::bark);
        tube(b, path, radii, fine.of(9, 4));
        for (int i = 0; i < leaves_of_stem; ++i) {
            const float t = 0.22F + 0.78F * (static_cast<float>(i) + random.unit()) / leaves_of_stem;
            const auto [lc, ls] = cos_sin(0.381966 * i + 0.05 * static_cast<double>(random.unit()));
            const float rise = random.in(0.1F, 0.9F), size = random.in(0.75F, 1.25F);
            const double roll = static_cast<double>(random.in(-0.08F, 0.08F));
            const Vec3 out{lc, rise, -ls};
            b.add(one, aligned(out, roll, at(t)) * scaled({size, size, size}),
                  random.below(4) == 0 ? Stuff::leaf_light : Stuff::leaf_dark);
        }
    }
    b.frame({});
}

}  // namespace raycache::tracer::room
