// Small scenes and random numbers for the tests of bvh, simt and paths.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::test {

class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
    std::uint32_t below(std::uint32_t n) { return bits() % n; }
    float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24F; }
    float between(float a, float b) { return a + (b - a) * unit(); }
    Vec3 in(const Box& box) {
        return {between(box.lower.x, box.upper.x), between(box.lower.y, box.upper.y),
                between(box.lower.z, box.upper.z)};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v{between(-1, 1), between(-1, 1), between(-1, 1)};
            if (const float l = dot(v, v); l > 0.01F && l <= 1) return normalize(v);
        }
    }

private:
    std::mt19937 engine_;
};

/// Triangles of one white material.
inline Scene mesh(std::vector<Vec3> positions, std::vector<std::uint32_t> indices) {
    Scene scene;
    scene.name = "test";
    scene.positions = std::move(positions);
    scene.indices = std::move(indices);
    scene.material_of.assign(scene.indices.size() / 3, 0);
    scene.materials.resize(1);
    scene.cameras.resize(1);
    return scene;
}

/// Adds the triangles of `b`, whose materials are those of `a`.
inline void append(Scene& a, const Scene& b) {
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const std::uint32_t i : b.indices) a.indices.push_back(first + i);
    a.material_of.insert(a.material_of.end(), b.material_of.begin(), b.material_of.end());
}

/// The same triangles at p * scale + offset.
inline Scene moved(Scene scene, float scale, Vec3 offset) {
    for (Vec3& p : scene.positions) p = p * scale + offset;
    return scene;
}

/// Unit sphere of 20 * 4^level triangles, closed, vertices shared, fronts outward.
inline Scene icosphere(int level) {
    const float g = (1 + std::sqrt(5.0F)) / 2;
    std::vector<Vec3> p{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                        {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (Vec3& v : p) v = normalize(v);
    std::vector<std::uint32_t> index{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                     4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                     6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int l = 0; l < level; ++l) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
        const auto between = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, made] =
                middle.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(p.size()));
            if (made) p.push_back(normalize(p[a] + p[b]));
            return found->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t t = 0; t < index.size(); t += 3) {
            const std::uint32_t a = index[t], b = index[t + 1], c = index[t + 2];
            const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
            for (const std::uint32_t i : {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca}) finer.push_back(i);
        }
        index = std::move(finer);
    }
    return mesh(std::move(p), std::move(index));
}

/// Two triangles: a, b, c and a, c, d.
inline Scene quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return mesh({a, b, c, d}, {0, 1, 2, 0, 2, 3}); }

/// Unconnected triangles in the cube [-1, 1]^3, edges up to about `size`; some are long and thin.
inline Scene soup(std::uint32_t triangles, float size, std::uint32_t seed) {
    Random random(seed);
    std::vector<Vec3> p;
    std::vector<std::uint32_t> index;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const Vec3 corner = random.in({{-1, -1, -1}, {1, 1, 1}});
        const float thin = t % 5 == 0 ? 0.02F : 1.0F;
        const Vec3 along = random.direction() * (size * random.unit());
        for (const Vec3 v : {corner, corner + along, corner + along * 0.5F + random.direction() * (size * thin)}) {
            index.push_back(static_cast<std::uint32_t>(p.size()));
            p.push_back(v);
        }
    }
    return mesh(std::move(p), std::move(index));
}

}  // namespace raycache::tracer::test
