#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "tests/tracer/builtin_scene_checks.hpp"
#include "tracer/scene/builtin/courtyard/courtyard.hpp"
#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/scene.hpp"

using namespace raycache::tracer;

namespace {

constexpr std::uint64_t small = courtyard::min_detail;

const Scene& default_scene() {
    static const Scene scene = courtyard::build(0);
    return scene;
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
    check_areas(default_scene());
    check_areas(courtyard::build(small));
}

TEST_CASE("courtyard faces its smooth normals outwards", "[courtyard]") {
    check_normals_face_outwards(default_scene());
}

TEST_CASE("courtyard uses every material and every texture", "[courtyard]") {
    check_materials_used(default_scene());
    check_materials_used(courtyard::build(small));
}

TEST_CASE("courtyard lays its textures out wherever a material has one", "[courtyard]") {
    check_textures_laid_out(default_scene());
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
        check_cameras(scene);
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
        const auto [c, s] = modelling::cos_sin(turns);
        CHECK(c == Approx(std::cos(turns * 6.283185307179586)).margin(1e-7));
        CHECK(s == Approx(std::sin(turns * 6.283185307179586)).margin(1e-7));
    }
}

TEST_CASE("courtyard's generator is PCG32", "[courtyard]") {
    modelling::Random reference(54, 42);  // the first numbers of O'Neill's own demonstration program
    for (const std::uint32_t expected : {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU}) {
        CHECK(reference.bits() == expected);
    }
    modelling::Random random(7);
    double sum = 0;
    for (int i = 0; i < 10'000; ++i) {
        const float u = random.unit();
        REQUIRE(u >= 0);
        REQUIRE(u < 1);
        sum += static_cast<double>(u);
    }
    CHECK(sum / 10'000 == Approx(0.5).margin(0.01));
}
