// The triangle test: where it hits, who wins, and that closed meshes are closed.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <utility>

#include "exact_judge.hpp"
#include "test_rays.hpp"
#include "tracer/bvh/ray_triangle.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

LeafTriangle triangle(Vec3 a, Vec3 b, Vec3 c, std::uint32_t index = 0) {
    return {{a.x, b.x, c.x}, index, {a.y, b.y, c.y}, 0, {a.z, b.z, c.z}, 0};
}

Hit hit_of(const LeafTriangle& t, const Ray& ray) {
    ShearedRay prepared;
    prepared.set(ray);
    Hit hit;
    hit.t = ray.t_max;
    test_triangle(t, prepared, hit);
    return hit;
}

/// The test as its authors write it, number by number.
void test_plainly(const LeafTriangle& triangle, const Ray& ray, Hit& hit) {
    const Vec3 d = ray.direction, size{std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
    const int kz = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    int kx = (kz + 1) % 3, ky = (kx + 1) % 3;
    if (d[kz] < 0) std::swap(kx, ky);
    const float sz = 1.0F / d[kz], sx = d[kx] * sz, sy = d[ky] * sz;
    std::array<float, 3> x{}, y{}, z{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 from_origin = triangle.vertex(static_cast<int>(i)) - ray.origin;
        z[i] = from_origin[kz];
        x[i] = from_origin[kx] - sx * z[i];
        y[i] = from_origin[ky] - sy * z[i];
    }
    float e0 = x[2] * y[1] - y[2] * x[1], e1 = x[0] * y[2] - y[0] * x[2], e2 = x[1] * y[0] - y[1] * x[0];
    if (e0 == 0 || e1 == 0 || e2 == 0) {
        e0 = static_cast<float>(double{x[2]} * double{y[1]} - double{y[2]} * double{x[1]});
        e1 = static_cast<float>(double{x[0]} * double{y[2]} - double{y[0]} * double{x[2]});
        e2 = static_cast<float>(double{x[1]} * double{y[0]} - double{y[1]} * double{x[0]});
    }
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return;
    const float determinant = e0 + e1 + e2;
    if (determinant == 0) return;
    float t = (e0 * (sz * z[0]) + e1 * (sz * z[1]) + e2 * (sz * z[2])) / determinant;
    if (const float reach = std::max({std::fabs(z[0]), std::fabs(z[1]), std::fabs(z[2])});
        t > ray.t_min && t < near_share * reach * std::fabs(sz)) {
        const auto turned = [&](Vec3 v) { return Vec3d(v[kx], v[ky], v[kz]); };
        t = static_cast<float>(plane_distance(turned(triangle.vertex(0)), turned(triangle.vertex(1)),
                                              turned(triangle.vertex(2)), turned(ray.origin),
                                              Vec3d(sx, sy, 1) * (1 / double{sz})));
    }
    if (t > ray.t_min && t <= hit.t) hit = {t, e1 / determinant, e2 / determinant, triangle.triangle};
}

Ray along(Vec3 origin, Vec3 direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    return ray;
}

const LeafTriangle right_angle = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});

/// Rays from points well inside a sphere of the given place and size, at its vertices, edges and anywhere: how many get
/// out?
std::uint64_t leaks(const Scene& sphere, float scale, Vec3 centre, std::size_t count, std::uint32_t seed) {
    const PreparedScene scene(Scene(sphere), BvhSettings{});
    const float reach = 0.45F * scale;  // an icosahedron's inscribed sphere has radius 0.79
    const Box inside{centre - Vec3{reach, reach, reach}, centre + Vec3{reach, reach, reach}};
    std::vector<Ray> rays = aimed_rays(scene.scene(), inside, count / 2, seed);
    const std::vector<Ray> others = random_rays(inside, count - rays.size(), seed + 1);
    rays.insert(rays.end(), others.begin(), others.end());
    std::uint64_t out = 0;
    for (const Hit& hit : closest_hits(scene, rays)) out += !hit.found();
    for (const bool hit : any_hits(scene, rays)) out += !hit;
    return out;
}

}  // namespace

TEST_CASE("triangle test: a ray at a known point hits it with known t, u, v") {
    const Hit hit = hit_of(right_angle, along({0.25F, 0.5F, 2}, {0, 0, -4}));
    REQUIRE(hit.found());
    CHECK(hit.t == 0.5F);
    CHECK(hit.u == 0.25F);  // weight of the second vertex
    CHECK(hit.v == 0.5F);
    CHECK(hit.triangle == 0);
}

TEST_CASE("triangle test: vectors give the numbers of the plain formula, bit for bit, also where some are 0 or huge") {
    Random random(5);
    const Box cube{{-1, -1, -1}, {1, 1, 1}};
    const auto coarse = [&] { return static_cast<float>(static_cast<int>(random.below(9)) - 4) / 4; };
    const auto on_grid = [&] { return Vec3{coarse(), coarse(), coarse()}; };
    std::uint64_t hits = 0, exact = 0, different = 0;
    for (int i = 0; i < 600000; ++i) {
        const bool grid = i % 3 == 0;  // many edges met exactly
        const float scale = i % 7 == 0 ? 1e18F : i % 11 == 0 ? 1e-18F : 1.0F;
        const auto point = [&] { return (grid ? on_grid() : random.in(cube)) * scale; };
        const LeafTriangle t = triangle(point(), point(), point(), static_cast<std::uint32_t>(i));
        const Vec3 from = point(), to = i % 2 == 0 ? (t.vertex(0) + t.vertex(1) + t.vertex(2)) / 3 : point();
        if (from == to) continue;
        const Ray ray = along(from, to - from);
        const Hit hit = hit_of(t, ray);
        Hit plain;
        plain.t = ray.t_max;
        test_plainly(t, ray, plain);
        hits += hit.found();
        exact += hit.found() && (hit.u == 0 || hit.v == 0);
        different += std::memcmp(&hit, &plain, sizeof(Hit)) != 0;
    }
    CHECK(different == 0);
    CHECK(hits > 100000);
    CHECK(exact > 1000);
}

TEST_CASE("triangle test: both sides count") {
    CHECK(hit_of(right_angle, along({0.25F, 0.25F, 1}, {0, 0, -1})).found());
    CHECK(hit_of(right_angle, along({0.25F, 0.25F, -1}, {0, 0, 1})).found());
}

TEST_CASE("triangle test: rays past each edge, parallel to the plane or away from it miss") {
    for (const Vec3 beside : {Vec3{-0.01F, 0.5F, 1}, Vec3{0.5F, -0.01F, 1}, Vec3{0.51F, 0.5F, 1}})
        CHECK_FALSE(hit_of(right_angle, along(beside, {0, 0, -1})).found());
    CHECK_FALSE(hit_of(right_angle, along({0.25F, 0.25F, 1}, {1, 0, 0})).found());
    CHECK_FALSE(hit_of(right_angle, along({-1, 0.25F, 0}, {1, 0, 0})).found());  // in the plane
    CHECK_FALSE(hit_of(right_angle, along({0.25F, 0.25F, 1}, {0, 0, 1})).found());
}

TEST_CASE("triangle test: edges and vertices belong to the triangle") {
    for (const Vec3 p :
         {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.5F, 0, 0}, Vec3{0, 0.5F, 0}, Vec3{0.5F, 0.5F, 0}})
        CHECK(hit_of(right_angle, along(p + Vec3{0, 0, 1}, {0, 0, -1})).found());
}

TEST_CASE("triangle test: all 60 directions of signs and zeros hit a facing triangle around the target") {
    for (int code = 0; code < 64; ++code) {
        constexpr std::array<float, 4> values{0.0F, -0.0F, 1.0F, -1.0F};
        const Vec3 d{values.at(code % 4), values.at(code / 4 % 4), values.at(code / 16)};
        if (d == Vec3{}) continue;
        const Vec3 n = normalize(d), side = normalize(cross(n, std::fabs(n.x) < 0.5F ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
        const Vec3 up = cross(n, side);
        const LeafTriangle facing = triangle(side * 2 - up, up * 2, side * -2 - up);
        for (const float scale : {1.0F, 1e-6F, 1e6F}) {
            const Hit hit = hit_of(facing, along(d * -3, d * scale));
            INFO(d.x << ' ' << d.y << ' ' << d.z << " x " << scale);
            REQUIRE(hit.found());
            CHECK(hit.t == Approx(3 / scale).epsilon(1e-6));
        }
        CHECK_FALSE(hit_of(facing, along(d * 3, d)).found());
    }
}

TEST_CASE("triangle test: t_min is excluded and t_max included") {
    Ray ray = along({0.25F, 0.25F, 1}, {0, 0, -1});  // t = 1
    const float before = std::nextafter(1.0F, 0.0F), after = std::nextafter(1.0F, 2.0F);
    ray.t_max = 1;
    CHECK(hit_of(right_angle, ray).found());
    ray.t_max = before;
    CHECK_FALSE(hit_of(right_angle, ray).found());
    ray.t_max = 5;
    ray.t_min = 1;
    CHECK_FALSE(hit_of(right_angle, ray).found());
    ray.t_min = before;
    CHECK(hit_of(right_angle, ray).found());
    ray.t_min = after;
    CHECK_FALSE(hit_of(right_angle, ray).found());
}

TEST_CASE("triangle test: a ray that starts on the triangle does not hit it") {
    for (const Vec3 direction : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 1, 1}, Vec3{-1, 0.5F, 0.25F}})
        CHECK_FALSE(hit_of(right_angle, along({0.25F, 0.25F, 0}, direction)).found());
}

TEST_CASE("triangle test: zero-area triangles are met by no ray that passes farther off than rounding error") {
    // Closer rays may meet them, and must: in a closed mesh whose small triangles have collapsed to lines they are what
    // keeps the triangles on either side together.
    Random random(1);
    std::uint64_t hits = 0, at_points = 0;
    for (int i = 0; i < 1000000; ++i) {
        const Box cube{{-1, -1, -1}, {1, 1, 1}};
        const auto small = [&] { return static_cast<float>(static_cast<int>(random.below(17)) - 8) / 8; };
        const Vec3 a{small(), small(), small()}, step{small(), small(), small()};
        const Vec3 b = i % 3 == 0 ? a : a + step, c = i % 5 == 0 ? a : a + step * 2;  // exactly in line
        const Ray ray = ray_to(random.in(cube), random.in(cube));
        if (!hit_of(triangle(a, b, c), ray).found()) continue;
        ++hits;
        const Crossing crossing = ExactRay(ray).crossing(mesh({a, b, c}, {0, 1, 2}), 0);
        at_points += !crossing.perhaps();
    }
    CHECK(at_points == 0);
    CHECK(hits < 10);
}

TEST_CASE("triangle test: triangles without extent are never hit") {
    Random random(12);
    std::uint64_t hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 a = random.direction();
        hits += hit_of(triangle(a, a, a), ray_to(random.direction() * 2, a)).found();
    }
    CHECK(hits == 0);
}

TEST_CASE("triangle test: a closed mesh leaks no ray even where its triangles have collapsed to lines and points") {
    // At 1e5 floats stand 2^-7 apart, as wide as the triangles of this sphere were.
    const Scene sphere = moved(icosphere(4), 0.1F, {1e5F, -1e5F, 1e5F});
    std::uint64_t flat = 0;
    for (std::uint32_t t = 0; t < sphere.triangle_count(); ++t)
        flat +=
            cross(corner(sphere, t, 1) - corner(sphere, t, 0), corner(sphere, t, 2) - corner(sphere, t, 0)) == Vec3{};
    CHECK(flat > 100);
    CHECK(leaks(sphere, 0.1F, {1e5F, -1e5F, 1e5F}, 200000, 3) == 0);
}

TEST_CASE("triangle test: at equal distance the lower index wins, whatever the order of the visits") {
    const Ray ray = along({0.25F, 0.25F, 1}, {0, 0, -1});
    ShearedRay prepared;
    prepared.set(ray);
    LeafTriangle low = right_angle, high = right_angle;
    low.triangle = 3;
    high.triangle = 8;
    for (const auto& [first, second] : {std::pair{low, high}, std::pair{high, low}}) {
        Hit hit;
        CHECK(test_triangle(first, prepared, hit));
        test_triangle(second, prepared, hit);
        CHECK(hit.triangle == 3);
        CHECK_FALSE(test_triangle(low, prepared, hit));  // itself again, as after a spatial split
    }
}

TEST_CASE("triangle test: a miss leaves the hit alone") {
    Hit hit{0.5F, 0.1F, 0.2F, 7};
    ShearedRay prepared;
    prepared.set(along({0.25F, 0.25F, 1}, {0, 0, -1}));
    CHECK_FALSE(test_triangle(right_angle, prepared, hit));  // at t = 1, behind the hit
    CHECK((hit.t == 0.5F && hit.u == 0.1F && hit.v == 0.2F && hit.triangle == 7));
}

TEST_CASE("triangle test: two triangles with a common edge leave no gap, in any order of their vertices") {
    Random random(2);
    std::uint64_t gaps = 0;
    for (int i = 0; i < 500000; ++i) {
        const Box cube{{-1, -1, -1}, {1, 1, 1}};
        const Vec3 a = random.in(cube), b = random.in(cube), c = random.in(cube), d = random.in(cube);
        const Vec3 on_edge = a + (b - a) * random.unit();
        const Ray ray = ray_to(random.in({{-4, -4, -4}, {4, 4, 4}}), on_edge);
        // As the ray sees them, c and d must stand on either side of the edge, well away from it.
        const Vec3 plane = cross(b - a, ray.direction);
        const float left = dot(c - a, plane), right = dot(d - a, plane);
        if (!(left * right < 0 && std::fabs(left) > 0.01F && std::fabs(right) > 0.01F)) continue;
        if (length(on_edge - a) < 1e-3F || length(on_edge - b) < 1e-3F) continue;  // beyond a vertex is a miss by right
        gaps += !hit_of(triangle(a, b, c), ray).found() &&
                !hit_of(i % 2 == 0 ? triangle(b, a, d) : triangle(d, a, b), ray).found();
    }
    CHECK(gaps == 0);
}

TEST_CASE("triangle test: a closed mesh leaks none of a million rays at its edges, vertices and anywhere", "[slow]") {
    CHECK(leaks(icosphere(4), 1, {0, 0, 0}, 1000000, 1) == 0);
}

TEST_CASE("triangle test: a closed mesh times 1e-6 or 1e6, or moved by 1e5, leaks no ray", "[slow]") {
    const auto check = [](float scale, Vec3 offset, int level) {
        INFO("scale " << scale << ", offset " << offset.x << ", level " << level);
        CHECK(leaks(moved(icosphere(level), scale, offset), scale, offset, 200000, 7) == 0);
    };
    for (const int level : {0, 4}) {
        check(1e-6F, {0, 0, 0}, level);
        check(1e6F, {0, 0, 0}, level);
        check(1e6F, {1e5F, 1e5F, 1e5F}, level);
    }
    check(1.0F, {1e5F, -1e5F, 1e5F}, 0);
    check(10.0F, {1e5F, -1e5F, 1e5F}, 2);
    check(1000.0F, {-1e5F, 1e5F, 1e5F}, 4);
}

TEST_CASE("triangle test: a closed mesh leaks none of the rays parallel to an axis or to a face's diagonal") {
    // Vertices on a grid and rays at its points: every ray meets edges or vertices exactly.
    Scene cube = quad({0, 0, 0}, {0, 4, 0}, {4, 4, 0}, {4, 0, 0});
    for (const Scene& side :
         {quad({0, 0, 4}, {4, 0, 4}, {4, 4, 4}, {0, 4, 4}), quad({0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4}),
          quad({0, 4, 0}, {0, 4, 4}, {4, 4, 4}, {4, 4, 0}), quad({0, 0, 0}, {0, 0, 4}, {0, 4, 4}, {0, 4, 0}),
          quad({4, 0, 0}, {4, 4, 0}, {4, 4, 4}, {4, 0, 4})})
        append(cube, side);
    const PreparedScene scene(std::move(cube), BvhSettings{});
    std::vector<Ray> rays;
    for (int x = 1; x < 4; ++x)
        for (int y = 1; y < 4; ++y)
            for (int z = 1; z < 4; ++z)
                for (int d = 0; d < 27; ++d) {
                    if (d == 13) continue;
                    rays.push_back(along({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)},
                                         {static_cast<float>(d % 3 - 1), static_cast<float>(d / 3 % 3 - 1),
                                          static_cast<float>(d / 9 - 1)}));
                }
    std::uint64_t out = 0;
    for (const Hit& hit : closest_hits(scene, rays)) out += !hit.found();
    CHECK(out == 0);
}
