// The three textures of the room.
#include <array>

#include "tracer/scene/builtin/modelling/texture_maker.hpp"
#include "tracer/scene/builtin/room/materials.hpp"

namespace raycache::tracer::room {

using namespace modelling;

namespace {

/// Grain along U, near white, so that a material's colour shows through.
Texture wood() {
    const Noise bend(201, 4), ring(202, 64), fibre(203, 256);
    return make_texture("wood", 512, [&](int x, int y) -> Texel {
        const auto u = static_cast<float>(x) / 512, v = static_cast<float>(y) / 512;
        const float across = v + 0.04F * bend.at(4 * u, 4 * v);
        const float year = ring.at(2 * u, 64 * across), thread = fibre.at(8 * u, 256 * v);
        const float light = 168 + 62 * year + 24 * thread;
        return {byte(light), byte(light - 8), byte(light - 18), 255};
    });
}

/// Threads over and under each other.
Texture weave() {
    const Noise uneven(204, 64);
    return make_texture("weave", 256, [&](int x, int y) -> Texel {
        const bool over = (x / 4 + y / 4) % 2 == 0;
        const int along = over ? y % 4 : x % 4, across = std::min(along, 3 - along);
        const float light = 196 + 18 * static_cast<float>(across) +
                            24 * uneven.at(static_cast<float>(x) / 4, static_cast<float>(y) / 4);
        return {byte(light), byte(light - 2), byte(light - 6), 255};
    });
}

/// Hills under a low sun.
Texture painting() {
    const Noise ridge(205, 8), brush(206, 64);
    return make_texture("painting", 256, [&](int x, int y) -> Texel {
        const auto u = static_cast<float>(x) / 256, v = 1 - static_cast<float>(y) / 256;
        const float stroke = 0.86F + 0.28F * brush.at(16 * u, 64 * v);
        constexpr std::array<Vec3, 4> hills{{{176, 126, 104}, {128, 92, 100}, {74, 78, 96}, {38, 52, 60}}};
        Vec3 color = Vec3{236, 178, 112} * (1 - v) + Vec3{120, 152, 178} * v;
        const float dx = u - 0.62F, dy = v - 0.64F;
        if (dx * dx + dy * dy < 0.007F) color = {250, 226, 170};
        for (std::size_t i = 0; i < hills.size(); ++i) {
            const auto n = static_cast<float>(i);
            const float top = 0.58F - 0.14F * n + 0.2F * ridge.at((2 + n) * u + 1.3F * n, n);
            if (v < top) color = hills[i];
        }
        return {byte(color.x * stroke), byte(color.y * stroke), byte(color.z * stroke), 255};
    });
}

}  // namespace

std::vector<Texture> textures() { return {wood(), weave(), painting()}; }

}  // namespace raycache::tracer::room
