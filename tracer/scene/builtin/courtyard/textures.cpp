// The three textures of the courtyard.
#include <cstdlib>

#include "tracer/scene/builtin/courtyard/materials.hpp"
#include "tracer/scene/builtin/modelling/texture_maker.hpp"

namespace raycache::tracer::courtyard {

using namespace modelling;
namespace {

/// Lime wash: near white, so that a material's colour shows through, with blotches and grain.
Texture plaster() {
    const Noise blotch(101, 4), cloud(102, 16), grain(103, 128);
    return make_texture("plaster", 256, [&](int x, int y) -> Texel {
        const auto fx = static_cast<float>(x) / 256, fy = static_cast<float>(y) / 256;
        const float v =
            203 + 28 * blotch.at(4 * fx, 4 * fy) + 20 * cloud.at(16 * fx, 16 * fy) + 14 * grain.at(128 * fx, 128 * fy);
        return {byte(v), byte(v - 3), byte(v - 8), 255};
    });
}

/// Four glazed tiles a side, each with a quarter-circle star in blue, ochre and cream, and grout between.
Texture mosaic() {
    const Noise glaze(104, 32);
    return make_texture("mosaic", 512, [&](int x, int y) -> Texel {
        constexpr int tile = 128, grout = 3;
        const int tx = x % tile, ty = y % tile;
        if (tx < grout || ty < grout) return {126, 112, 98, 255};
        const int cx = std::min(tx, tile - 1 - tx), cy = std::min(ty, tile - 1 - ty);  // fold to one quarter
        const float corner = std::sqrt(static_cast<float>(cx * cx + cy * cy));
        const int diamond = std::abs(tx - tile / 2) + std::abs(ty - tile / 2);
        const bool odd = ((x / tile) + (y / tile)) % 2 != 0;
        Vec3 color{222, 205, 172};
        if (corner < 22)
            color = {150, 62, 40};
        else if (corner < 40)
            color = odd ? Vec3{52, 78, 124} : Vec3{196, 146, 70};
        else if (corner < 46)
            color = {60, 46, 44};
        else if (diamond < 14)
            color = {196, 146, 70};
        else if (diamond < 34)
            color = odd ? Vec3{150, 62, 40} : Vec3{52, 78, 124};
        else if (diamond < 38)
            color = {60, 46, 44};
        const float worn = 0.86F + 0.2F * glaze.at(static_cast<float>(x) / 16, static_cast<float>(y) / 16);
        return {byte(color.x * worn), byte(color.y * worn), byte(color.z * worn), 255};
    });
}

/// A sheet of papel picado: white paper (materials colour it) with petals, dots and a fringe cut out.
Texture cut_paper() {
    return make_texture("cut paper", 128, [](int x, int y) -> Texel {
        const int dx = std::min(x, 127 - x), from_middle = std::abs(2 * x - 127), cy = 56;
        bool hole = false;
        if (y >= 112) hole = (x / 8) % 2 == 0;                  // fringe
        const int mx = from_middle / 2, my = std::abs(y - cy);  // quarter of the flower
        const float r = std::sqrt(static_cast<float>(mx * mx + my * my));
        if (r > 10 && r < 36 && std::abs(mx - my) > 5 && mx > 3 && my > 3) hole = true;  // petals
        if (r < 5) hole = true;
        const int ex = (dx % 14) - 7, ey = (y % 14) - 7;
        if (r > 44 && y > 12 && y < 106 && dx > 4 && ex * ex + ey * ey < 20) hole = true;  // dots
        return {255, 255, 255, static_cast<std::uint8_t>(hole ? 0 : 255)};
    });
}

}  // namespace

std::vector<Texture> textures() { return {plaster(), mosaic(), cut_paper()}; }

}  // namespace raycache::tracer::courtyard
