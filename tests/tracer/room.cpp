#include <catch2/catch.hpp>

#include <string>

#include "tests/tracer/builtin_scene_checks.hpp"
#include "tracer/scene/builtin/room/room.hpp"
#include "tracer/scene/emission.hpp"

using namespace raycache::tracer;

namespace {

constexpr std::uint64_t small = room::min_detail;

const Scene& default_scene() {
    static const Scene scene = room::build(0);
    return scene;
}

const Scene& small_scene() {
    static const Scene scene = room::build(small);
    return scene;
}

}  // namespace

TEST_CASE("room stays within five per cent of the wanted triangle count", "[room]") {
    for (const std::uint64_t wanted : {small, std::uint64_t{130'000}, std::uint64_t{270'000}, std::uint64_t{740'000}}) {
        CAPTURE(wanted);
        const Scene scene = room::build(wanted);
        CHECK(relative_error(scene, wanted) < 0.05);
        CHECK(scene.name == "room(detail=" + std::to_string(wanted) + ")");
    }
}

TEST_CASE("room reaches its greatest detail", "[room][slow]") {
    const Scene scene = room::build(room::max_detail);
    CHECK(relative_error(scene, room::max_detail) < 0.05);
    check_well_formed(scene);
    check_areas(scene);
}

TEST_CASE("room is the same on every build and every machine", "[room]") {
    CHECK(room::build(small).positions == small_scene().positions);
    CHECK(room::build(small + 1000).hash != small_scene().hash);
    CHECK(room::build(1).hash == small_scene().hash);
    // A changed number here means that every published figure for the scene changes too.
    CHECK(small_scene().hash == 0x34a89126f7758d50ULL);
    CHECK(default_scene().hash == 0xaa6bc68083944d70ULL);
}

TEST_CASE("room keeps what every built-in scene must keep", "[room]") {
    for (const Scene* scene : {&default_scene(), &small_scene()}) {
        check_well_formed(*scene);
        check_areas(*scene);
        check_normals_face_outwards(*scene);
        check_materials_used(*scene);
        check_textures_laid_out(*scene);
        check_cameras(*scene);
        REQUIRE(scene->cameras.size() == 3);
        CHECK(scene->cameras[0].name == "sofa");
        CHECK(scene->cameras[1].name == "windows");
        CHECK(scene->cameras[2].name == "table");
    }
}

TEST_CASE("room has glass and metal, and is lit by its windows and lamps alone", "[room]") {
    const Scene& scene = default_scene();
    CHECK(emits_light(scene));
    CHECK(!scene.sun);
    CHECK(luminance(scene.sky) == 0);
    int metal = 0, glass = 0, lights = 0;
    for (const Material& m : scene.materials) {
        metal += m.metallic > 0 ? 1 : 0;
        glass += m.transmission > 0 ? 1 : 0;
        lights += luminance(m.emission) > 0 ? 1 : 0;
    }
    CHECK(metal == 4);
    CHECK(glass == 1);
    CHECK(lights == 3);
    CHECK(find_builtin_scene("room") != nullptr);
}
