// Textures computed from integers and square roots only, the same on every machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer::modelling {

using Texel = std::array<std::uint8_t, 4>;

/// Square, `size` texels a side; `shade(x, y)` gives each.
template <class Shade>
Texture make_texture(const char* name, std::uint32_t size, const Shade& shade) {
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

inline std::uint8_t byte(float v) { return static_cast<std::uint8_t>(std::min(255.0F, std::max(0.0F, v))); }

/// Value noise that repeats after `period` cells.
class Noise {
public:
    Noise(std::uint64_t stream, int period) : period_(period) {
        Random random(stream);
        for (int i = 0; i < period * period; ++i) values_.push_back(random.unit());
    }
    /// In [0, 1]; `x` and `y` in cells, at least 0.
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

}  // namespace raycache::tracer::modelling
