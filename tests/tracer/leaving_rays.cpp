// Rays that leave a triangle, of any size, at any place: they must not meet it again.
#include <catch2/catch.hpp>
#include <cmath>

#include "test_rays.hpp"
#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/surface.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

struct Shape {
    float place, width, times_as_long;
};

/// One triangle, `width` long, about `place` from the origin; every third one along two axes.
Scene triangle(const Shape& shape, int number, Random& random) {
    const Vec3 corner = random.direction() * shape.place;
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Vec3 along = number % 3 == 0 ? axes[number / 3 % 3] : random.direction();
    const Vec3 other = number % 3 == 0 ? axes[(number / 3 + 1) % 3] : random.direction();
    const Vec3 across = normalize(other - along * dot(along, other));
    return mesh({corner, corner + along * shape.width,
                 corner + along * (shape.width * random.unit()) + across * (shape.width / shape.times_as_long)},
                {0, 1, 2});
}

/// Rays that leave points of the triangle, on either side, many of them almost along it.
std::vector<Ray> leaving(const Scene& scene, float width, float least_sine, Random& random) {
    const Vec3 a = scene.positions[0], b = scene.positions[1], c = scene.positions[2];
    const Vec3 normal = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a)).rounded() / (width * width);
    std::vector<Ray> rays;
    for (int i = 0; i < 100; ++i) {
        float u = random.unit(), v = i % 4 == 1 ? 0 : random.unit();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        Hit hit{0, u, v, 0};
        Ray ray;
        ray.direction = normalize(normalize(normal) * (i % 2 == 0 ? 1.0F : -1.0F) + random.direction() * 0.9F);
        const Vec3 met = a * (1 - u - v) + b * u + c * v;
        ray.origin = met - ray.direction * width;
        const Surface s = surface_at(scene, ray, hit);
        const Vec3 n = s.geometric_normal;
        for (const float up : {0.5F, 0.05F, 1e-3F, least_sine}) {
            const Vec3 d = random.direction();
            Ray out;
            out.direction = normalize(normalize(d - n * dot(d, n)) + n * up);
            if (!(dot(out.direction, n) > 0)) continue;
            out.origin = s.leave(out.direction);
            rays.push_back(out);
        }
    }
    return rays;
}

}  // namespace

TEST_CASE("a ray that leaves a triangle does not meet it again, whatever its size, its place and the angle") {
    Random random(3);
    for (const Shape& shape : {Shape{0, 1, 1}, Shape{1, 1, 30}, Shape{10, 1, 1}, Shape{1000, 1, 30}, Shape{0, 1e-5F, 5},
                               Shape{1, 1e-4F, 1}, Shape{1e5F, 10, 2}, Shape{1, 1e7F, 1}, Shape{1e10F, 1e10F, 10}}) {
        std::size_t rays = 0, ours = 0, embrees = 0;
        for (int number = 0; number < 60; ++number) {
            const PreparedScene prepared(triangle(shape, number, random), {});
            const auto out = leaving(prepared.scene(), shape.width, 1e-5F, random);
            rays += out.size();
            for (const Hit& hit : closest_hits(prepared, out)) ours += hit.found();
            for (const Ray& ray : out) embrees += prepared.embree().intersect(ray).found();
        }
        INFO("place " << shape.place << ", width " << shape.width << ", " << shape.times_as_long << " times as long");
        CHECK(rays > 20000);
        CHECK(ours == 0);
        CHECK(embrees == 0);
    }
}

TEST_CASE("rays leave a giant triangle from beside it, though float does not tell its two sides apart") {
    Random random(4);
    for (const float width : {1e5F, 1e7F}) {
        std::size_t ours = 0, embrees = 0, rays = 0;
        float farthest = 0;
        for (int number = 0; number < 60; ++number) {
            Scene scene = triangle({0, width, 1}, number, random);
            for (int small = 0; small < 3; ++small)  // what makes the giant one: they stand far away
                append(scene, moved(mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}), 1, {0, 0, 3e7F}));
            const PreparedScene prepared(std::move(scene), {});
            REQUIRE(prepared.scene().giant_above < width);
            const auto out = leaving(prepared.scene(), width, 2e-3F, random);
            rays += out.size();
            for (const Hit& hit : closest_hits(prepared, out)) ours += hit.triangle == 0;
            for (const Ray& ray : out) {
                embrees += prepared.embree().intersect(ray).triangle == 0;
                embrees += prepared.embree().occluded({ray.origin, ray.direction, 0, width / 100});
            }
            // Near a corner of the triangle at the origin the clearance is that of small triangles.
            const Surface s = surface_at(prepared.scene(), {{0, 0, 0}, {0, 0, 1}}, {0, 0, 0, 0});
            farthest = std::max(farthest, s.clearance);
        }
        INFO("width " << width);
        CHECK(rays > 20000);
        CHECK(ours == 0);
        CHECK(embrees == 0);
        CHECK(farthest < 0.1F);
    }
}

TEST_CASE("the clearance follows where the hit lies, not what else the scene holds") {
    const Scene near = mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    Scene with_outlier = near;
    append(with_outlier, mesh({{1e7F, 0, 0}, {1.1e7F, 0, 0}, {1e7F, 1e6F, 0}}, {0, 1, 2}));
    const Ray ray{{0.2F, 0.2F, 1}, {0, 0, -1}};
    const Hit hit{1, 0.2F, 0.2F, 0};
    const Surface alone = surface_at(near, ray, hit), beside = surface_at(with_outlier, ray, hit);
    CHECK(alone.clearance == beside.clearance);
    CHECK(alone.clearance < 1e-5F);
    // A plane z = constant is rounded along z alone: far in x and y costs nothing.
    const Scene far = moved(near, 1, {1000, 1000, 0});
    const Surface s = surface_at(far, {{1000.2F, 1000.2F, 1}, {0, 0, -1}}, hit);
    CHECK(s.clearance == Approx(alone.clearance).epsilon(0.01));
}

TEST_CASE("a hit on a wide triangle lies on its ray, as exactly as float can say") {
    const Scene floor = mesh({{-1e7F, -1, -7e6F}, {-9e6F, -1, 1e7F}, {1e7F, -1, 1e7F}}, {0, 1, 2});
    const PreparedScene prepared(floor, {});
    Random random(5);
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i)
        rays.push_back({{-1e6F, 0, 2e6F}, normalize(Vec3{random.between(-1, 1), -1, random.between(-1, 1)})});
    const auto hits = closest_hits(prepared, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        REQUIRE(hits[i].found());
        const Surface s = surface_at(prepared.scene(), rays[i], hits[i]);
        const Vec3d expected = Vec3d(rays[i].origin) + Vec3d(rays[i].direction) * (1 / -double{rays[i].direction.y});
        CHECK(s.position == expected.rounded());
    }
}

TEST_CASE("edges far beyond and below those whose fourth power a float holds have a normal") {
    for (const float size : {1e18F, 1e12F, 1e-12F, 1e-20F, 1e-37F}) {
        const Scene scene = mesh({{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {0, 1, 2});
        CHECK(surface_at(scene, {{0, 0, size}, {0, 0, -1}}, {size, 0.2F, 0.2F, 0}).geometric_normal == Vec3{0, 0, 1});
    }
}
