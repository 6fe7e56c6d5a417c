// The traversal against Embree's robust mode where rounding is worst: axis-parallel directions, origins on the
// geometry, tiny, huge and far-off scenes, degenerate and duplicate triangles.
#include <catch2/catch.hpp>

#include "embree_comparison.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

constexpr float axis_values[] = {0.0F, -0.0F, 1.0F, -1.0F};

/// All combinations of signs and zeros, from each origin.
std::vector<Ray> axis_rays(std::span<const Vec3> origins, float scale) {
    std::vector<Ray> rays;
    for (const Vec3 origin : origins)
        for (const float x : axis_values)
            for (const float y : axis_values)
                for (const float z : axis_values) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    Ray ray;
                    ray.origin = origin;
                    ray.direction = Vec3{x, y, z} * scale;
                    rays.push_back(ray);
                }
    return rays;
}

/// Vertices, middles of edges and of faces, points of the faces' planes.
std::vector<Vec3> points_on(const Scene& scene) {
    std::vector<Vec3> points;
    for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
        const Vec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2);
        for (const Vec3 p : {a, (a + b) * 0.5F, (a + b + c) / 3, b + (b - a) + (c - a)}) points.push_back(p);
    }
    return points;
}

/// Embree's answers may be unjustified on this share of rays: a triangle whose normal is all rounding gives it a t
/// beyond the triangle's ends.
constexpr double embree_share_on_slivers = 1e-3;

/// Our answers justified on every ray, and Embree's but for `embree_share` of them; no claim about how many differ.
void check(const Scene& scene, std::span<const Ray> rays, const BvhSettings& settings = {}, double embree_share = 0) {
    const PreparedScene prepared(Scene(scene), settings);
    const EmbreeScene embree(prepared.scene());
    Comparison found = compare_closest(prepared, embree, rays);
    found += compare_any(prepared, embree, rays);
    INFO(found.text());
    CHECK(found.ours_wrong == 0);
    CHECK(static_cast<double>(found.embree_wrong) <= embree_share * static_cast<double>(found.rays));
    // And the judge on ours alone, whatever Embree says.
    const auto hits = closest_hits(prepared, rays);
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) wrong += !justified(crossings(prepared, rays[i]), rays[i], hits[i]);
    CHECK(wrong == 0);
}

/// A box of 12 triangles around the origin, its coordinates powers of two.
Scene cube() {
    Scene scene = quad({-2, -1, -1}, {-2, 1, -1}, {2, 1, -1}, {2, -1, -1});
    for (const Scene& side : {quad({-2, -1, 1}, {2, -1, 1}, {2, 1, 1}, {-2, 1, 1}),
                              quad({-2, -1, -1}, {2, -1, -1}, {2, -1, 1}, {-2, -1, 1}),
                              quad({-2, 1, -1}, {-2, 1, 1}, {2, 1, 1}, {2, 1, -1}),
                              quad({-2, -1, -1}, {-2, -1, 1}, {-2, 1, 1}, {-2, 1, -1}),
                              quad({2, -1, -1}, {2, 1, -1}, {2, 1, 1}, {2, -1, 1})})
        append(scene, side);
    return scene;
}

std::vector<Ray> mixed_rays(const Scene& scene, std::size_t count) {
    const Box box = scene.bounds();
    std::vector<Ray> rays = random_rays(box, count / 2, 1);
    for (const Ray& ray : aimed_rays(scene, box, count / 2, 2)) rays.push_back(ray);
    return rays;
}

}  // namespace

TEST_CASE("embree: all sign and zero combinations of the direction, from inside, from planes, edges and vertices") {
    for (const Scene& scene : {cube(), icosphere(1), soup(50, 0.8F, 3)}) {
        std::vector<Vec3> origins = points_on(scene);
        for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{0.5F, 0.25F, -0.5F}, Vec3{5, 1, 1}, Vec3{-5, 0, 0}, Vec3{0, 7, -1}})
            origins.push_back(p);
        for (const float scale : {1.0F, 1e-3F, 1e3F}) check(scene, axis_rays(origins, scale));
    }
}

TEST_CASE("embree: rays from the geometry in any direction") {
    for (const Scene& scene : {cube(), icosphere(2), soup(200, 0.5F, 4)}) {
        Random random(5);
        std::vector<Ray> rays;
        for (const Vec3 point : points_on(scene))
            for (int i = 0; i < 50; ++i) {
                Ray ray;
                ray.origin = point;
                ray.direction = random.direction();
                rays.push_back(ray);
            }
        check(scene, rays);
    }
}

TEST_CASE("embree: scenes times 1e-6 and 1e6, and moved by 1e5", "[slow]") {
    for (const float offset : {0.0F, 1e5F})
        for (const float scale : {1e-6F, 1.0F, 1e6F}) {
            if (scale < 1 && offset > 0) continue;  // nothing is left of it: below
            INFO("scale " << scale << " offset " << offset);
            for (const Scene& base : {icosphere(3), soup(2000, 0.3F, 6)}) {
                const Scene scene = moved(base, scale, {offset, -offset, offset});
                check(scene, mixed_rays(scene, 20000));
            }
        }
}

TEST_CASE("embree: a scene that rounding has collapsed to a point is never hit") {
    const Scene scene = moved(icosphere(1), 1e-6F, {1e5F, 1e5F, 1e5F});
    const PreparedScene prepared(Scene(scene), BvhSettings{});
    for (const Hit& hit :
         closest_hits(prepared, random_rays({{99999, 99999, 99999}, {100001, 100001, 100001}}, 10000, 7)))
        REQUIRE_FALSE(hit.found());
}

TEST_CASE("embree: rays of any length from 1e-6 to 1e6 give the same hits at t over the length") {
    const Scene scene = soup(2000, 0.3F, 8);
    for (const float length : {1e-6F, 1e-3F, 1e3F, 1e6F}) {
        std::vector<Ray> rays = mixed_rays(scene, 10000);
        for (Ray& ray : rays) ray.direction = ray.direction * length;
        check(scene, rays);
    }
}

TEST_CASE("embree: degenerate triangles among sound ones", "[slow]") {
    Scene scene = soup(500, 0.4F, 9);
    Random random(10);
    for (int i = 0; i < 500; ++i) {
        const Vec3 a = random.in({{-1, -1, -1}, {1, 1, 1}}), b = random.in({{-1, -1, -1}, {1, 1, 1}});
        switch (i % 4) {
            case 0:
                append(scene, mesh({a}, {0, 0, 0}));
                break;
            case 1:
                append(scene, mesh({a, b}, {0, 1, 1}));
                break;
            case 2:
                append(scene, mesh({a, b}, {0, 1, 0}));
                break;
            default:
                append(scene, mesh({a, b, (a + b) * 0.5F}, {0, 1, 2}));
        }
    }
    check(scene, mixed_rays(scene, 50000), {}, embree_share_on_slivers);
    check(scene, mixed_rays(scene, 50000), {.max_leaf_size = 4, .spatial_splits = true}, embree_share_on_slivers);
}

TEST_CASE("embree: duplicate triangles, coplanar overlapping ones and flipped ones") {
    Scene scene = soup(200, 0.5F, 11);
    append(scene, Scene(scene));
    Scene flipped = soup(200, 0.5F, 11);
    for (std::size_t i = 0; i < flipped.indices.size(); i += 3) std::swap(flipped.indices[i], flipped.indices[i + 1]);
    append(scene, flipped);
    for (int i = 0; i < 20; ++i) {  // sheets in one plane
        const float x = static_cast<float>(i) * 0.125F - 1;
        append(scene, quad({x, 0, -1}, {x + 0.5F, 0, -1}, {x + 0.5F, 0, 1}, {x, 0, 1}));
    }
    check(scene, mixed_rays(scene, 50000));
}

TEST_CASE("embree: t_min and t_max before, at and behind the hits") {
    const Scene scene = soup(1000, 0.4F, 12);
    const PreparedScene prepared(Scene(scene), BvhSettings{});
    std::vector<Ray> rays = mixed_rays(scene, 50000);
    const auto hits = closest_hits(prepared, rays);
    Random random(13);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found()) continue;
        const float t = hits[i].t;
        switch (random.below(6)) {
            case 0:
                rays[i].t_max = t;
                break;
            case 1:
                rays[i].t_max = std::nextafter(t, 0.0F);
                break;
            case 2:
                rays[i].t_max = t * 0.9F;
                break;
            case 3:
                rays[i].t_min = t;
                break;
            case 4:
                rays[i].t_min = t * 1.1F;
                break;
            default:
                rays[i].t_min = t * 0.5F, rays[i].t_max = t * 2;
        }
    }
    check(scene, rays);
}
