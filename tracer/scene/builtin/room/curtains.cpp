// Curtains in folds, with their rods and rings, at both sides of each window.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

constexpr float rod_y = 2.58F, rod_x = 0.13F, hem = 0.02F;

/// Hangs between `from` and `to`; its folds grow deeper downwards.
void drape(MeshBuilder& b, float from, float to, Random& random, Fineness fine) {
    constexpr int folds = 7;
    std::array<float, folds + 1> reach{}, lean{};
    for (float& r : reach) r = random.in(0.03F, 0.062F);
    for (float& l : lean) l = random.in(-0.012F, 0.012F);
    sheet(b, folds * fine.of(14, 8), fine.of(26, 6), [&](float u, float v) {
        const float fold = u * folds;
        const auto i = std::min(static_cast<std::size_t>(fold), reach.size() - 2);
        const float t = fold - static_cast<float>(i), s = t * t * (3 - 2 * t);
        const float amplitude = reach[i] + (reach[i + 1] - reach[i]) * s;
        const float away = lean[i] + (lean[i + 1] - lean[i]) * s;
        const auto [c, sine] = cos_sin(static_cast<double>(fold));
        const float loose = 1 - 0.55F * v;  // v = 1 at the rod
        return Vec3{rod_x + amplitude * c * loose + away * (1 - v), hem + (rod_y - 0.03F - hem) * v,
                    to - (to - from) * u + 0.12F * amplitude * sine * loose};
    });
}

}  // namespace

void curtains(MeshBuilder& b, Fineness fine) {
    Random random(311);
    for (const Window& w : windows) {
        b.use(Stuff::curtain);
        drape(b, w.from - 0.3F, w.from + 0.12F, random, fine);
        drape(b, w.to - 0.12F, w.to + 0.3F, random, fine);
        b.use(Stuff::brass);
        const std::array<Vec3, 2> rod{{{rod_x, rod_y, w.from - 0.36F}, {rod_x, rod_y, w.to + 0.36F}}};
        tube(b, rod, 0.013F, fine.of(12, 5));
        for (const float end : {w.from - 0.38F, w.to + 0.38F}) ball(b, {rod_x, rod_y, end}, 0.03F, fine.of(12, 5));
        for (const float at : {w.from - 0.3F, w.to + 0.3F}) {
            const std::array<Vec3, 2> bracket{{{0, rod_y, at}, {rod_x, rod_y, at}}};
            tube(b, bracket, 0.008F, fine.of(8, 4));
        }
    }
}

}  // namespace raycache::tracer::room
