// Light sampling against what can be computed by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "test_meshes.hpp"
#include "tracer/paths/lights.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// A square of side 2 at height `height` around the y axis, of radiance `radiance`, in two triangles.
Scene square_light(float height, float radiance) {
    Scene scene = quad({-1, height, -1}, {1, height, -1}, {1, height, 1}, {-1, height, 1});
    scene.materials[0].emission = {radiance, radiance, radiance};
    return scene;
}

/// Irradiance at `from` on a plane with normal `normal`, by samples on a grid of numbers.
double irradiance(const Lights& lights, Vec3 from, Vec3 normal, int side = 1000) {
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const LightSample s = lights.sample(from, {(static_cast<float>(i) + 0.5F) / static_cast<float>(side),
                                                       (static_cast<float>(j) + 0.5F) / static_cast<float>(side)});
            sum += std::fmax(0.0, dot(normal, s.direction)) * s.radiance_over_pdf.x;
        }
    return sum / side / side;
}

/// Form factor from a small patch to a parallel rectangle a x b at distance c with one corner on the patch's normal.
double corner_form_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
}

}  // namespace

TEST_CASE("lights: a square gives the irradiance of its form factor") {
    for (const float height : {0.5F, 1.0F, 3.0F}) {
        const Lights lights(square_light(height, 5));
        const double expected = 5 * std::numbers::pi * 4 * corner_form_factor(1, 1, double{height});
        CHECK(irradiance(lights, {0, 0, 0}, {0, 1, 0}) == Approx(expected).epsilon(2e-3));
    }
}

TEST_CASE("lights: an emissive triangle shines from both sides") {
    const Lights lights(square_light(1, 5));
    CHECK(irradiance(lights, {0, 2, 0}, {0, -1, 0}, 500) ==
          Approx(irradiance(lights, {0, 0, 0}, {0, 1, 0}, 500)).epsilon(1e-3));
}

TEST_CASE("lights: the sun gives its irradiance times the cosine, from within its disc") {
    Scene scene = mesh({}, {});
    const Vec3 towards = normalize({1, 2, 2});
    scene.sun = Sun{towards, {3, 2, 1}, 0.02F};
    const Lights lights(scene);
    CHECK_FALSE(lights.empty());
    CHECK(irradiance(lights, {7, 8, 9}, towards, 100) == Approx(3).epsilon(1e-3));
    CHECK(irradiance(lights, {7, 8, 9}, {0, 1, 0}, 100) == Approx(3 * 2.0 / 3).epsilon(1e-3));
    for (const float x : {0.0F, 0.5F, 0.999F})
        for (const float y : {0.0F, 0.3F, 0.999F}) {
            const LightSample s = lights.sample({0, 0, 0}, {x, y});
            CHECK(length(s.direction) == Approx(1));
            CHECK(std::isinf(s.distance));
            CHECK(dot(s.direction, towards) >= std::cos(0.0201F));
        }
}

TEST_CASE("lights: with sun and emitters, half of the samples go to each and the sum stays right") {
    Scene scene = square_light(1, 5);
    scene.sun = Sun{{0, 1, 0}, {3, 3, 3}};
    const Lights lights(scene);
    const double expected = 3 + 5 * std::numbers::pi * 4 * corner_form_factor(1, 1, 1);
    CHECK(irradiance(lights, {0, 0, 0}, {0, 1, 0}) == Approx(expected).epsilon(2e-3));
    int sun = 0;
    for (int i = 0; i < 1000; ++i) sun += std::isinf(lights.sample({}, {static_cast<float>(i) / 1000, 0.5F}).distance);
    CHECK(sun == 500);
}

TEST_CASE("lights: triangles are picked in proportion to area times luminance") {
    // Areas 1 : 4, radiance 2 : 1 -> power 1 : 2. Told apart by their height.
    Scene scene = mesh({{0, 1, 0}, {1, 1, 0}, {0, 1, 1}, {0, 3, 0}, {2, 3, 0}, {0, 3, 2}}, {0, 1, 2, 3, 4, 5});
    scene.materials.resize(3);
    scene.materials[0].emission = {2, 2, 2};
    scene.materials[1].emission = {1, 1, 1};
    scene.material_of = {0, 1};
    const Lights lights(scene);
    int low = 0;
    for (int i = 0; i < 3000; ++i) {
        const LightSample s = lights.sample({0, 0, 0}, {(static_cast<float>(i) + 0.5F) / 3000, 0.25F});
        low += s.direction.y * s.distance < 2;
    }
    CHECK(low == Approx(1000).margin(1));
}

TEST_CASE("lights: points spread evenly over a triangle") {
    Scene scene = mesh({{0, 1, 0}, {1, 1, 0}, {0, 1, 1}}, {0, 1, 2});
    scene.materials[0].emission = {1, 1, 1};
    const Lights lights(scene);
    int cells[16] = {}, outside = 0;
    Random random(1);
    for (int i = 0; i < 160000; ++i) {
        const LightSample s = lights.sample({0, 0, 0}, {random.unit(), random.unit()});
        const Vec3 p = s.direction * s.distance;
        const int x = static_cast<int>(p.x * 4), z = static_cast<int>(p.z * 4);
        if (x < 0 || z < 0 || x > 3 || z > 3 || p.x + p.z > 1.00001F)
            ++outside;
        else
            ++cells[4 * z + x];
    }
    CHECK(outside == 0);
    for (int z = 0; z < 4; ++z)
        for (int x = 0; x < 4; ++x)
            CHECK(cells[4 * z + x] == Approx(x + z < 3 ? 20000 : x + z == 3 ? 10000 : 0).margin(700));
}

TEST_CASE("lights: black materials, zero-area triangles and a black sun are no lights") {
    Scene scene = mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0, 1, 3});
    scene.materials.resize(2);
    scene.materials[1].emission = {1, 1, 1};
    scene.material_of = {1, 0};  // the flat one is emissive
    scene.sun = Sun{};
    CHECK(Lights(scene).empty());
}

TEST_CASE("lights: every pair of numbers gives a finite sample, from a point on the light too") {
    Scene scene = square_light(0, 5);
    scene.sun = Sun{{0, 1, 0}, {1, 1, 1}};
    const Lights lights(scene);
    const float last = 0x1.fffffep-1F;
    for (const Vec3 from : {Vec3{0, 0, 0}, Vec3{1, 0, 1}, Vec3{-1, 0, -1}, Vec3{0, 1, 0}})
        for (const float x : {0.0F, 0x1p-24F, 0.25F, 0.5F, 0.75F, last})
            for (const float y : {0.0F, 0x1p-24F, 0.5F, last}) {
                const LightSample s = lights.sample(from, {x, y});
                CHECK(is_finite(s.direction));
                CHECK(is_finite(s.radiance_over_pdf));
                CHECK(s.radiance_over_pdf.x >= 0);
            }
}
