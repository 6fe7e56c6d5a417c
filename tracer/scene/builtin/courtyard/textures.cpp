// The three textures of the courtyard, computed from integers and square roots only.
#include <array>
#include <cstdlib>

#include "tracer/scene/builtin/courtyard/materials.hpp"
#include "tracer/scene/builtin/courtyard/random.hpp"

namespace raycache::tracer::courtyard {
namespace {

using Texel = std::array<std::uint8_t, 4>;

template <class Shade>
Texture make(const char* name, std::uint32_t size, const Shade& shade) {
    Texture t;
    t.name = name;
    t.width = t.height = size;
    t.rgba.reserve(4 * static_cast<std::size_t>(size) * size);
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const Texel c = shade(static_cast<int>(x), static_cast<int>(y));
            t.rgba.insert(t.rgba.end(), c.begin(), c.end());
        }
    }
    return t;
}

std::uint8_t byte(float v) { return static_cast<std::uint8_t>(std::min(255.0F, std::max(0.0F, v))); }

/// Value noise that repeats after `period` cells.
class Noise {
public:
    Noise(std::uint64_t stream, int period) : period_(period) {
        Random random(stream);
        for (int i = 0; i < period * period; ++i) values_.push_back(random.unit());
    }
    float at(float x, float y) const {
        const int ix = static_cast<int>(x), iy = static_cast<int>(y);
        const float fx = smooth(x - static_cast<float>(ix)), fy = smooth(y - static_cast<float>(iy));
        const float low = cell(ix, iy) + (cell(ix + 1, iy) - cell(ix, iy)) * fx;
        const float high = cell(ix, iy + 1) + (cell(ix + 1, iy + 1) - cell(ix, iy + 1)) * fx;
        return low + (high - low) * fy;
    }

private:
    int period_;
    std::vector<float> values_;

    static float smooth(float t) { return t * t * (3 - 2 * t); }
    float cell(int x, int y) const { return values_[static_cast<std::size_t>((y % period_) * period_ + x % period_)]; }
};

/// Lime wash: near white, so that a material's colour shows through, with blotches and grain.
Texture plaster() {
    const Noise blotch(101, 4), cloud(102, 16), grain(103, 128);
    return make("plaster", 256, [&](int x, int y) -> Texel {
        const auto fx = static_cast<float>(x) / 256, fy = static_cast<float>(y) / 256;
        const float v =
            203 + 28 * blotch.at(4 * fx, 4 * fy) + 20 * cloud.at(16 * fx, 16 * fy) + 14 * grain.at(128 * fx, 128 * fy);
        return {byte(v), byte(v - 3), byte(v - 8), 255};
    });
}

/// Four glazed tiles a side, each with a quarter-circle star in blue, ochre and cream, and grout between.
Texture mosaic() {
    const Noise glaze(104, 32);
    return make("mosaic", 512, [&](int x, int y) -> Texel {
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
    return make("cut paper", 128, [](int x, int y) -> Texel {
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
