#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "tracer/scene/builtin/courtyard/courtyard.hpp"
#include "tracer/scene/builtin/courtyard/random.hpp"
#include "tracer/scene/scene.hpp"

using namespace raycache::tracer;

namespace {

constexpr std::uint64_t small = courtyard::min_detail;

const Scene& default_scene() {
    static const Scene scene = courtyard::build(0);
    return scene;
}

double relative_error(const Scene& scene, std::uint64_t wanted) {
    return std::abs(static_cast<double>(scene.triangle_count()) / static_cast<double>(wanted) - 1);
}

float distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
    const Vec3 d = b - a;
    const float t = dot(d, d) > 0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0F, 1.0F) : 0;
    return length(p - (a + d * t));
}

float distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    const bool above =
        dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
    if (above && dot(n, n) > 0) return std::abs(dot(p - a, normalize(n)));
    return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

struct Corners {
    Vec3 a, b, c;
};
Corners corners(const Scene& scene, std::size_t triangle) {
    const std::uint32_t* i = &scene.indices[3 * triangle];
    return {scene.positions[i[0]], scene.positions[i[1]], scene.positions[i[2]]};
}

void check_well_formed(const Scene& scene) {
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

std::vector<std::size_t> triangles_per_material(const Scene& scene) {
    std::vector<std::size_t> count(scene.materials.size());
    for (const std::uint16_t m : scene.material_of) ++count[m];
    return count;
}

}  // namespace

TEST_CASE("courtyard stays within five per cent of the wanted triangle count", "[courtyard][slow]") {
    for (std::uint64_t wanted = small; wanted <= 2'000'000; wanted += wanted / 7) {
        CAPTURE(wanted);
        const Scene scene = courtyard::build(wanted);
        CHECK(relative_error(scene, wanted) < 0.05);
        CHECK(scene.name == "courtyard(detail=" + std::to_string(wanted) + ")");
    }
}

TEST_CASE("courtyard reaches its greatest detail", "[courtyard][slow]") {
    const Scene scene = courtyard::build(courtyard::max_detail);
    CHECK(relative_error(scene, courtyard::max_detail) < 0.05);
    check_well_formed(scene);
}

TEST_CASE("courtyard is the same on every build", "[courtyard]") {
    const Scene one = courtyard::build(small), two = courtyard::build(small);
    CHECK(one.hash == two.hash);
    CHECK(one.positions == two.positions);
    CHECK(one.normals == two.normals);
    CHECK(one.texcoords == two.texcoords);
    CHECK(one.indices == two.indices);
    CHECK(courtyard::build(small + 1000).hash != one.hash);
}

TEST_CASE("courtyard is the same on every machine", "[courtyard]") {
    // A changed number here means that every published figure for the scene changes too.
    CHECK(courtyard::build(small).hash == 0x32150ca6a3533382ULL);
    CHECK(default_scene().hash == 0x5c40b8ec8ec85d3fULL);
}

TEST_CASE("courtyard takes a detail of nought for its default and clamps the rest", "[courtyard]") {
    CHECK(default_scene().name == "courtyard(detail=500000)");
    CHECK(courtyard::build(1).hash == courtyard::build(small).hash);
}

TEST_CASE("courtyard has finite positions, indices in range and normals of length one or nought", "[courtyard]") {
    check_well_formed(default_scene());
    check_well_formed(courtyard::build(small));
}

TEST_CASE("courtyard has no triangle without area", "[courtyard]") {
    for (const Scene& scene : {default_scene(), courtyard::build(small)}) {
        std::size_t flat = 0;
        for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
            const auto [a, b, c] = corners(scene, t);
            flat += length(cross(b - a, c - a)) > 0 ? 0 : 1;
        }
        CHECK(flat == 0);
    }
}

TEST_CASE("courtyard faces its smooth normals outwards", "[courtyard]") {
    const Scene& scene = default_scene();
    std::size_t smooth = 0, against = 0;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const auto [a, b, c] = corners(scene, t);
        const Vec3 face = cross(b - a, c - a);
        for (int k = 0; k < 3; ++k) {
            const Vec3 n = scene.normals[scene.indices[3 * t + static_cast<std::size_t>(k)]];
            if (n == Vec3{}) continue;
            ++smooth;
            against += dot(n, face) < 0 ? 1 : 0;
        }
    }
    CHECK(smooth > scene.triangle_count() / 4);
    CHECK(static_cast<double>(against) < 0.001 * static_cast<double>(smooth));
}

TEST_CASE("courtyard uses every material and every texture", "[courtyard]") {
    for (const Scene& scene : {default_scene(), courtyard::build(small)}) {
        const std::vector<std::size_t> used = triangles_per_material(scene);
        std::vector<bool> texture_used(scene.textures.size());
        bool masked = false;
        for (std::size_t m = 0; m < used.size(); ++m) {
            const Material& material = scene.materials[m];
            CAPTURE(material.name);
            CHECK(used[m] > 0);
            masked = masked || material.alpha_mask;
            if (material.base_color_texture < 0) continue;
            REQUIRE(static_cast<std::size_t>(material.base_color_texture) < scene.textures.size());
            texture_used[static_cast<std::size_t>(material.base_color_texture)] = true;
        }
        CHECK(masked);
        for (const bool is_used : texture_used) CHECK(is_used);
        for (const Texture& t : scene.textures) CHECK(t.rgba.size() == 4U * t.width * t.height);
    }
}

TEST_CASE("courtyard lays its textures out wherever a material has one", "[courtyard]") {
    const Scene& scene = default_scene();
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

TEST_CASE("courtyard has holes only in its cut paper", "[courtyard]") {
    const Scene& scene = default_scene();
    for (const Material& m : scene.materials) {
        bool holes = false;
        if (m.base_color_texture >= 0) {
            const Texture& t = scene.textures[static_cast<std::size_t>(m.base_color_texture)];
            for (std::size_t i = 3; i < t.rgba.size(); i += 4) holes = holes || t.rgba[i] < 128;
        }
        CHECK(holes == m.alpha_mask);
    }
}

TEST_CASE("courtyard's cameras stand in the open with floor below", "[courtyard]") {
    for (const Scene& scene : {default_scene(), courtyard::build(small)}) {
        REQUIRE(scene.cameras.size() == 3);
        CHECK(scene.cameras[0].name == "yard");
        CHECK(scene.cameras[1].name == "gallery");
        CHECK(scene.cameras[2].name == "table");
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
                const auto side = [&](Vec3 p, Vec3 q) {
                    return (q.x - p.x) * (eye.z - p.z) - (q.z - p.z) * (eye.x - p.x);
                };
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
}

TEST_CASE("courtyard is lit by sun and sky and by nothing else", "[courtyard]") {
    const Scene& scene = default_scene();
    REQUIRE(scene.sun.has_value());
    CHECK(length(scene.sun->direction) == Approx(1));
    CHECK(scene.sun->direction.y > 0.3F);
    CHECK(luminance(scene.sky) > 0);
    for (const Material& m : scene.materials) CHECK(m.emission == Vec3{});
}

TEST_CASE("courtyard is in the registry of built-in scenes", "[courtyard]") {
    REQUIRE(!builtin_scenes().empty());
    const BuiltinScene& scene = builtin_scenes()[0];
    CHECK(scene.name == "courtyard");
    CHECK(scene.min_detail == 50'000);
    CHECK(scene.max_detail == 10'500'000);
    CHECK(scene.build(scene.min_detail).hash == courtyard::build(small).hash);
}

TEST_CASE("courtyard's own cosine and sine agree with the library's", "[courtyard]") {
    for (int i = -1000; i <= 1000; ++i) {
        const double turns = i * 0.00317;
        const auto [c, s] = courtyard::cos_sin(turns);
        CHECK(c == Approx(std::cos(turns * 6.283185307179586)).margin(1e-7));
        CHECK(s == Approx(std::sin(turns * 6.283185307179586)).margin(1e-7));
    }
}

TEST_CASE("courtyard's generator is PCG32", "[courtyard]") {
    courtyard::Random reference(54, 42);  // the first numbers of O'Neill's own demonstration program
    for (const std::uint32_t expected : {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU}) {
        CHECK(reference.bits() == expected);
    }
    courtyard::Random random(7);
    double sum = 0;
    for (int i = 0; i < 10'000; ++i) {
        const float u = random.unit();
        REQUIRE(u >= 0);
        REQUIRE(u < 1);
        sum += static_cast<double>(u);
    }
    CHECK(sum / 10'000 == Approx(0.5).margin(0.01));
}
