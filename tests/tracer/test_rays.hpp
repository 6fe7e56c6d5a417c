// Rays for tests, and the answers of the warp traversal to a list of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "test_meshes.hpp"
#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/simt/make_traversal.hpp"
#include "tracer/simt/recorder.hpp"

namespace raycache::tracer::test {

/// Of a scene in layout bvh2, or in one that differs from it in its order alone.
inline const Bvh2& bvh2_of(const PreparedScene& scene) { return dynamic_cast<const Bvh2&>(scene.bvh()); }

/// A 4x4 texture whose alpha is 0 or 255 in a chessboard, on some of the triangles; and one constant material below,
/// one above the cutoff, one textured without holes.
inline PreparedScene with_holes(Scene scene, const BvhSettings& settings = {},
                                const std::string& layout = default_layout) {
    Texture texture{4, 4, {}, "chessboard"};
    for (std::uint32_t i = 0; i < 16; ++i)
        for (const int byte : {200, 100, 50, (i + i / 4) % 2 == 0 ? 255 : 0})
            texture.rgba.push_back(static_cast<std::uint8_t>(byte));
    scene.textures.push_back(texture);
    scene.materials.resize(5);
    scene.materials[1].alpha_mask = scene.materials[2].alpha_mask = scene.materials[3].alpha_mask = true;
    scene.materials[1].base_color_texture = scene.materials[4].base_color_texture = 0;
    scene.materials[2].alpha = 0.25F;
    scene.materials[3].alpha = 0.75F;
    Random random(9);
    for (auto& m : scene.material_of) m = static_cast<std::uint16_t>(random.below(5));
    for (std::size_t i = 0; i < scene.positions.size(); ++i)
        scene.texcoords.push_back({random.between(-2, 2), random.between(-2, 2)});
    return PreparedScene(std::move(scene), settings, layout);
}

/// Calls body(mask, rays of the warp, index of lane 0) for one warp after another.
template <class Body>
void for_each_warp(std::span<const Ray> rays, Body body) {
    for (std::size_t first = 0; first < rays.size(); first += traces::warp_lanes) {
        const auto count = static_cast<unsigned>(std::min<std::size_t>(traces::warp_lanes, rays.size() - first));
        const std::uint32_t mask = count == 32 ? ~0U : (1U << count) - 1;
        body(mask, &rays[first], first);
    }
}

inline std::vector<Hit> closest_hits(const PreparedScene& scene, std::span<const Ray> rays) {
    NullRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    std::vector<Hit> hits(rays.size() + traces::warp_lanes);
    for_each_warp(rays, [&](std::uint32_t mask, const Ray* warp, std::size_t first) {
        traversal->closest(mask, traces::RayType::camera, 0, warp, &hits[first]);
    });
    hits.resize(rays.size());
    return hits;
}

inline std::vector<bool> any_hits(const PreparedScene& scene, std::span<const Ray> rays) {
    NullRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    std::vector<bool> hits(rays.size());
    for_each_warp(rays, [&](std::uint32_t mask, const Ray* warp, std::size_t first) {
        const std::uint32_t occluded = traversal->occluded(mask, traces::RayType::shadow, 0, warp);
        for (unsigned lane = 0; lane < 32 && first + lane < rays.size(); ++lane)
            hits[first + lane] = ((occluded >> lane) & 1U) != 0;
    });
    return hits;
}

inline Ray ray_to(Vec3 from, Vec3 to) {
    Ray ray;
    ray.origin = from;
    ray.direction = to - from;
    return ray;
}

/// Rays from random points of the box in random directions.
inline std::vector<Ray> random_rays(const Box& box, std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.origin = random.in(box);
        ray.direction = random.direction();
    }
    return rays;
}

inline Vec3 corner(const Scene& scene, std::uint32_t triangle, std::uint32_t corner) {
    return scene.positions[scene.indices[3 * std::size_t{triangle} + corner]];
}

/// Rays from random points of the box at vertices and at points of edges of random triangles; directions not
/// normalised.
inline std::vector<Ray> aimed_rays(const Scene& scene, const Box& box, std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const std::uint32_t t = random.below(static_cast<std::uint32_t>(scene.triangle_count()));
        const std::uint32_t c = random.below(3);
        const Vec3 a = corner(scene, t, c), b = corner(scene, t, (c + 1) % 3);
        const Ray ray = ray_to(random.in(box), rays.size() % 2 == 0 ? a : a + (b - a) * random.unit());
        if (length(ray.direction) > 0) rays.push_back(ray);
    }
    return rays;
}

}  // namespace raycache::tracer::test
