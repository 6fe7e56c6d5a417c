// Punctual lights: what a file says, what arrives on a surface, and what they decide.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/tracer/pictures.hpp"
#include "tracer/paths/lights.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

SquareFile lit_by(const json& light, const json& node = {{"translation", {0, 0, 2}}}) {
    SquareFile file(grey(0.5));
    json with_light = node;
    with_light["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.doc["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
    file.doc["extensionsUsed"] = {"KHR_lights_punctual"};
    file.finish();
    file.node(with_light);
    return file;
}

PunctualLight light_of(const json& light, const json& node = {{"translation", {0, 0, 2}}}) {
    return load(lit_by(light, node)).scene.punctual_lights.at(0);
}

/// Irradiance at `from` on a plane of this normal.
double irradiance(const Scene& scene, Vec3 from, Vec3 normal) {
    const Lights lights(scene);
    double sum = 0;
    constexpr int side = 400;
    for (int i = 0; i < side * side; ++i) {
        const LightSample s = lights.sample(
            from, {(static_cast<float>(i % side) + 0.5F) / side, (static_cast<float>(i / side) + 0.5F) / side});
        sum += std::fmax(0.0, dot(normal, s.direction)) * s.radiance_over_pdf.x;
    }
    return sum / side / side;
}

}  // namespace

TEST_CASE("punctual lights: a file that has one gets neither sky nor sun, one whose light is black does") {
    const auto [scene, warnings] = load_lit(lit_by({{"type", "point"}, {"color", {1, 0, 0}}, {"intensity", 100}}));
    CHECK(warnings.empty());
    CHECK(scene.sky == Vec3{0, 0, 0});
    CHECK_FALSE(scene.sun);
    const Vec3 seen = mean(picture(scene, 8, 4));
    CHECK(seen.x > 0.5F);
    CHECK(seen.y == 0);
    for (const json& dark : {json{{"type", "point"}, {"intensity", 0}}, json{{"type", "point"}, {"color", {0, 0, 0}}}})
        CHECK(load_lit(lit_by(dark)).scene.sun);
}

TEST_CASE("punctual lights: a point gives intensity over distance squared") {
    const Scene scene = load(lit_by({{"type", "point"}, {"intensity", 8}})).scene;
    CHECK(irradiance(scene, {0, 0, 0}, {0, 0, 1}) == Approx(2).epsilon(1e-4));
    CHECK(irradiance(scene, {0, 0, 1}, {0, 0, 1}) == Approx(8).epsilon(1e-4));
    CHECK(irradiance(scene, {2, 0, 2}, {-1, 0, 0}) == Approx(2).epsilon(1e-4));
}

TEST_CASE("punctual lights: a directional one shines along its node's -Z with its irradiance, however it is scaled") {
    const json node = {{"rotation", {0, 0.7071068, 0, 0.7071068}}, {"scale", {7, 7, 7}}};
    const PunctualLight light = light_of({{"type", "directional"}, {"intensity", 3}}, node);
    CHECK(length(light.direction - Vec3{-1, 0, 0}) < 1e-5F);
    const Scene scene = load(lit_by({{"type", "directional"}, {"intensity", 3}}, node)).scene;
    CHECK(irradiance(scene, {50, 0, 9}, {1, 0, 0}) == Approx(3).epsilon(1e-4));
    CHECK(irradiance(scene, {50, 0, 9}, {-1, 0, 0}) == 0);
}

TEST_CASE("punctual lights: a spot is full in its inner cone, dark outside the outer one, and falls in between") {
    const json spot = {
        {"type", "spot"}, {"intensity", 4}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}};
    const Scene scene = load(lit_by(spot)).scene;
    const auto at = [&](double angle) {
        const auto x = static_cast<float>(2 * std::tan(angle));
        const Vec3 from{x, 0, 0};
        return irradiance(scene, from, normalize(Vec3{0, 0, 2} - from)) * (4 + double{x} * x);
    };
    CHECK(at(0) == Approx(4).epsilon(1e-4));
    CHECK(at(0.19) == Approx(4).epsilon(1e-3));
    CHECK(at(0.61) == 0);
    const double half = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    CHECK(at(0.4) == Approx(4 * half * half).epsilon(1e-3));
    const PunctualLight unset = light_of({{"type", "spot"}, {"spot", json::object()}});
    CHECK(unset.cos_inner == 1);
    CHECK(unset.cos_outer == Approx(std::numbers::sqrt2 / 2));
}

TEST_CASE("punctual lights: a range fades the light out to nothing at its end") {
    const Scene scene = load(lit_by({{"type", "point"}, {"intensity", 4}, {"range", 4}})).scene;
    CHECK(irradiance(scene, {0, 0, 0}, {0, 0, 1}) == Approx(1 - 1.0 / 16).epsilon(1e-4));
    CHECK(irradiance(scene, {0, 0, -2.1F}, {0, 0, 1}) == 0);
}

TEST_CASE("punctual lights: they are chosen beside emitters by power, and the sum is right with a sun too") {
    Scene scene = load(lit_by({{"type", "point"}, {"intensity", 8}})).scene;
    const double point = irradiance(scene, {0, 0, 0}, {0, 0, 1});
    scene.materials[0].emission = {1, 1, 1};
    const double square = irradiance(scene, {0, 0, 0.5F}, {0, 0, -1});
    CHECK(irradiance(scene, {0, 0, 0.5F}, {0, 0, 1}) == Approx(8 / 2.25).epsilon(0.01));
    scene.punctual_lights.clear();
    CHECK(irradiance(scene, {0, 0, 0.5F}, {0, 0, -1}) == Approx(square).epsilon(0.02));
    scene.punctual_lights = load(lit_by({{"type", "point"}, {"intensity", 8}})).scene.punctual_lights;
    scene.sun = Sun{{0, 0, 1}, {3, 3, 3}};
    scene.materials[0].emission = {0, 0, 0};
    CHECK(irradiance(scene, {0, 0, 0}, {0, 0, 1}) == Approx(point + 3).epsilon(1e-3));
}

TEST_CASE("punctual lights: pictures are the same by nee and mis, dark by bsdf") {
    const auto seen = [&](LightSampling lights) {
        PathSettings paths;
        paths.lights = lights;
        return mean(picture(load(lit_by({{"type", "point"}, {"intensity", 8}})).scene, 8, 16, paths)).x;
    };
    CHECK(seen(LightSampling::nee) > 0.1F);
    CHECK(seen(LightSampling::mis) == Approx(seen(LightSampling::nee)).epsilon(1e-3));
    CHECK(seen(LightSampling::bsdf) == 0);
}

TEST_CASE("punctual lights: numbers out of their limits become the nearest, with one warning; types are checked") {
    const auto warned = [](const json& light) {
        const auto warnings = load(lit_by(light)).warnings;
        return warnings.size() == 1 &&
               warnings[0].find("1 punctual lights have a colour, intensity") != std::string::npos;
    };
    CHECK(warned({{"type", "point"}, {"intensity", -1}}));
    CHECK(warned({{"type", "point"}, {"color", {-1, 0, 0}}}));
    CHECK(warned({{"type", "point"}, {"color", {2, 0, 0}}}));
    CHECK(warned({{"type", "point"}, {"range", -1}}));
    CHECK(warned({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}, {"outerConeAngle", 0.5}}}}));
    CHECK(warned({{"type", "spot"}, {"spot", {{"outerConeAngle", 3}}}}));
    CHECK_FALSE(warned({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}));
    CHECK(error_of(lit_by({{"type", "spot"}})).find("lights[0].spot: expected an object, found none") !=
          std::string::npos);
    CHECK(error_of(lit_by({{"type", "area"}}))
              .find("lights[0].type: expected point, spot, directional, found \"area\"") != std::string::npos);
    CHECK(
        error_of(lit_by({{"type", "point"}, {"intensity", 1e30}})).find("an intensity of at most 1e+18, found 1e+30") !=
        std::string::npos);
}
