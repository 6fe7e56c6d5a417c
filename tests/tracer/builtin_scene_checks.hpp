// What every built-in scene must keep.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

inline double relative_error(const Scene& scene, std::uint64_t wanted) {
    return std::abs(static_cast<double>(scene.triangle_count()) / static_cast<double>(wanted) - 1);
}

inline float distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
    const Vec3 d = b - a;
    const float t = dot(d, d) > 0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0F, 1.0F) : 0;
    return length(p - (a + d * t));
}

inline float distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    const bool above =
        dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
    if (above && dot(n, n) > 0) return std::abs(dot(p - a, normalize(n)));
    return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

struct Corners {
    Vec3 a, b, c;
};
inline Corners corners(const Scene& scene, std::size_t triangle) {
    const std::uint32_t* i = &scene.indices[3 * triangle];
    return {scene.positions[i[0]], scene.positions[i[1]], scene.positions[i[2]]};
}

inline void check_well_formed(const Scene& scene) {
    REQUIRE(scene.indices.size() == 3 * scene.triangle_count());
    REQUIRE(scene.normals.size() == scene.positions.size());
    REQUIRE(scene.texcoords.size() == scene.positions.size());
    std::size_t bad_positions = 0, bad_normals = 0, bad_indices = 0, bad_materials = 0;
    for (const Vec3 p : scene.positions) bad_positions += is_finite(p) ? 0 : 1;
    for (const Vec3 n : scene.normals) {
        bad_normals += n == Vec3{} || std::abs(length(n) - 1) < 1e-4F ? 0 : 1;
    }
    for (const std::uint32_t i : scene.indices) bad_indices += i < scene.positions.size() ? 0 : 1;
    for (const std::uint16_t m : scene.material_of) bad_materials += m < scene.materials.size() ? 0 : 1;
    CHECK(bad_positions == 0);
    CHECK(bad_normals == 0);
    CHECK(bad_indices == 0);
    CHECK(bad_materials == 0);
}

inline std::vector<std::size_t> triangles_per_material(const Scene& scene) {
    std::vector<std::size_t> count(scene.materials.size());
    for (const std::uint16_t m : scene.material_of) ++count[m];
    return count;
}

inline void check_areas(const Scene& scene) {
    std::size_t flat = 0;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const auto [a, b, c] = corners(scene, t);
        flat += length(cross(b - a, c - a)) > 0 ? 0 : 1;
    }
    CHECK(flat == 0);
}

/// Smooth normals lie on the front side of their triangles.
inline void check_normals_face_outwards(const Scene& scene) {
    std::size_t smooth = 0, against = 0;
    std::string where;  // the material of the last
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const auto [a, b, c] = corners(scene, t);
        const Vec3 face = cross(b - a, c - a);
        for (int k = 0; k < 3; ++k) {
            const Vec3 n = scene.normals[scene.indices[3 * t + static_cast<std::size_t>(k)]];
            if (n == Vec3{}) continue;
            ++smooth;
            if (dot(n, face) >= 0) continue;
            ++against;
            where = scene.materials[scene.material_of[t]].name;
        }
    }
    CAPTURE(where);
    CHECK(smooth > scene.triangle_count() / 4);
    CHECK(static_cast<double>(against) < 0.001 * static_cast<double>(smooth));
}

inline void check_materials_used(const Scene& scene) {
    const std::vector<std::size_t> used = triangles_per_material(scene);
    std::vector<bool> texture_used(scene.textures.size());
    for (std::size_t m = 0; m < used.size(); ++m) {
        const Material& material = scene.materials[m];
        CAPTURE(material.name);
        CHECK(used[m] > 0);
        if (material.base_color_texture < 0) continue;
        REQUIRE(static_cast<std::size_t>(material.base_color_texture) < scene.textures.size());
        texture_used[static_cast<std::size_t>(material.base_color_texture)] = true;
    }
    for (const bool is_used : texture_used) CHECK(is_used);
    for (const Texture& t : scene.textures) CHECK(t.rgba.size() == 4U * t.width * t.height);
}

/// Wherever a material has a texture, its triangles have coordinates that span some of it.
inline void check_textures_laid_out(const Scene& scene) {
    double textured = 0, laid_out = 0;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        if (scene.materials[scene.material_of[t]].base_color_texture < 0) continue;
        const auto [a, b, c] = corners(scene, t);
        const double area = static_cast<double>(length(cross(b - a, c - a)));
        const std::uint32_t* i = &scene.indices[3 * t];
        const Vec2 p = scene.texcoords[i[0]], q = scene.texcoords[i[1]], r = scene.texcoords[i[2]];
        textured += area;
        if ((q.x - p.x) * (r.y - p.y) != (q.y - p.y) * (r.x - p.x)) laid_out += area;
    }
    CHECK(laid_out == Approx(textured));
}

/// Upright, inside, nothing within 20 cm, some floor half a metre to 2.2 m below.
inline void check_cameras(const Scene& scene) {
    const Box box = scene.bounds();
    for (const Camera& camera : scene.cameras) {
        CAPTURE(camera.name);
        CHECK(length(camera.forward) == Approx(1));
        CHECK(length(camera.up) == Approx(1));
        CHECK(dot(camera.forward, camera.up) == Approx(0).margin(1e-5));
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(camera.eye[axis] > box.lower[axis]);
            CHECK(camera.eye[axis] < box.upper[axis]);
        }
        float nearest = 1e30F, floor = -1e30F;
        const Vec3 eye = camera.eye;
        for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
            const auto [a, b, c] = corners(scene, t);
            nearest = std::min(nearest, distance_to_triangle(eye, a, b, c));
            const auto side = [&](Vec3 p, Vec3 q) { return (q.x - p.x) * (eye.z - p.z) - (q.z - p.z) * (eye.x - p.x); };
            const float ab = side(a, b), bc = side(b, c), ca = side(c, a);
            const bool over = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
            const float top = std::max({a.y, b.y, c.y});
            if (over && top < eye.y) floor = std::max(floor, top);
        }
        CHECK(nearest > 0.2F);
        CHECK(eye.y - floor > 0.5F);
        CHECK(eye.y - floor < 2.2F);
    }
}

}  // namespace raycache::tracer
