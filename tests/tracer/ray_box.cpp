// The box test: conservative, and ordered.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "test_meshes.hpp"
#include "tracer/bvh/layouts/bvh2_node.hpp"
#include "tracer/bvh/ray_box.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

Bvh2Node node_of(const Box& first, const Box& second) {
    Bvh2Node node{};
    for (const auto& [box, c] : {std::pair{first, 0}, std::pair{second, 1}}) {
        node.x[c] = box.lower.x, node.y[c] = box.lower.y, node.z[c] = box.lower.z;
        node.x[c + 2] = box.upper.x, node.y[c + 2] = box.upper.y, node.z[c + 2] = box.upper.z;
    }
    return node;
}

struct Found {
    std::uint32_t mask;  ///< bit c: child c is hit
    std::uint32_t near;  ///< the child to visit first
};

Found found(const Bvh2Node& node, const BoxRay& ray) {
    const BoxHits& hits = test_boxes(node, ray);
    return {std::uint32_t{hits.child(0)} | std::uint32_t{hits.child(1)} << 1, hits.near_shift / 32};
}

Found hits(const Box& first, const Box& second, const Ray& ray) {
    BoxRay prepared;
    prepared.set(ray);
    return found(node_of(first, second), prepared);
}

/// Whether the exact ray meets the closed box between t_min and t_max; long double holds a difference of floats of like
/// size and its quotient with an error far below that of float.
bool enters(const Box& box, const Ray& ray) {
    long double low = ray.t_min, high = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const long double o = ray.origin[axis], d = ray.direction[axis];
        const long double a = box.lower[axis] - o, b = box.upper[axis] - o;
        if (a > b) return false;
        if (d == 0) {
            if (a > 0 || b < 0) return false;
            continue;
        }
        low = std::max(low, std::min(a / d, b / d));
        high = std::min(high, std::max(a / d, b / d));
    }
    return low <= high;
}

Box box_of(Vec3 a, Vec3 b) {
    Box box;
    box.add(a);
    box.add(b);
    return box;
}

/// A number a path tracer might feed in: small, large, zero of either sign, a power of two.
float awkward(Random& random) {
    const float sign = random.below(2) == 0 ? 1.0F : -1.0F;
    switch (random.below(8)) {
        case 0:
            return sign * 0.0F;
        case 1:
            return sign;
        case 2:
            return sign * std::ldexp(1.0F, static_cast<int>(random.below(40)) - 20);
        case 3:
            return sign * 1e5F * random.unit();
        case 4:
            return sign * 1e-6F * random.unit();
        default:
            return sign * random.unit();
    }
}

constexpr std::array<float, 4> axis_values{0.0F, -0.0F, 1.0F, -1.0F};

/// The 60 directions out of zeros of both signs and ones that are not null.
template <class Body>
void for_sign_combinations(Body body) {
    for (const float x : axis_values)
        for (const float y : axis_values)
            for (const float z : axis_values)
                if (x != 0 || y != 0 || z != 0) body(Vec3{x, y, z});
}

}  // namespace

TEST_CASE("box test: every box that the exact ray enters is hit, for four million rays near corners and edges") {
    Random random(1);
    std::uint64_t missed = 0, entered = 0, extra = 0, outside = 0;
    for (int i = 0; i < 4000000; ++i) {
        // Flat and thin boxes are the ones a rounding error loses.
        const Vec3 size{random.below(3) == 0 ? 0.0F : random.unit(), random.below(3) == 0 ? 0.0F : random.unit(),
                        random.below(3) == 0 ? 0.0F : random.unit()};
        const Vec3 at{random.between(-4, 4), random.between(-4, 4), random.between(-4, 4)};
        const Box box = box_of(at, at + size);
        Ray ray;
        ray.origin = {random.between(-4, 4), random.between(-4, 4), random.between(-4, 4)};
        // Towards a corner, a point of an edge or a point of a face.
        const Vec3 target{random.below(2) == 0 ? box.lower.x : box.upper.x,
                          random.below(2) == 0 ? box.lower.y : box.upper.y,
                          random.below(2) == 0 ? box.lower.z : random.between(box.lower.z, box.upper.z)};
        ray.direction = target - ray.origin;
        if (random.below(2) == 0) ray.direction = normalize(ray.direction);
        if (random.below(2) == 0) ray.t_max = 1;
        const bool inside = enters(box, ray);
        const bool hit_it = (hits(box, Box{}, ray).mask & 1) != 0;
        entered += inside;
        missed += inside && !hit_it;
        outside += !inside;
        extra += !inside && hit_it;
    }
    CHECK(entered > 1000000);
    CHECK(missed == 0);
    CHECK(extra < outside);  // these rays pass within rounding error of the box, so many count as hits
}

TEST_CASE("box test: every box that the exact ray enters is hit, for awkward numbers", "[slow]") {
    Random random(2);
    std::uint64_t missed = 0, entered = 0;
    for (int i = 0; i < 4000000; ++i) {
        const Vec3 corner{awkward(random), awkward(random), awkward(random)};
        const Box box = box_of(corner, {awkward(random), awkward(random), awkward(random)});
        Ray ray;
        ray.direction = {awkward(random), awkward(random), awkward(random)};
        if (ray.direction == Vec3{}) continue;
        // Origins inside, on planes, on corners, far off.
        ray.origin = random.below(2) == 0 ? Vec3{awkward(random), awkward(random), awkward(random)}
                                          : corner - ray.direction * awkward(random);
        if (random.below(2) == 0) ray.t_max = random.unit();
        if (random.below(4) == 0) ray.t_min = ray.t_max < infinity ? ray.t_max * random.unit() : 0.5F;
        const bool inside = enters(box, ray);
        entered += inside;
        missed += inside && (hits(Box{}, box, ray).mask & 2) == 0;
    }
    CHECK(entered > 500000);
    CHECK(missed == 0);
}

TEST_CASE("box test: random rays hit what the exact ray enters and little else") {
    Random random(3);
    std::uint64_t missed = 0, extra = 0;
    for (int i = 0; i < 1000000; ++i) {
        const Box box = box_of(random.in({{-1, -1, -1}, {1, 1, 1}}), random.in({{-1, -1, -1}, {1, 1, 1}}));
        Ray ray;
        ray.origin = random.in({{-2, -2, -2}, {2, 2, 2}});
        ray.direction = random.direction();
        ray.t_max = random.between(0, 4);
        const bool hit_it = hits(box, Box{}, ray).mask != 0;
        missed += enters(box, ray) && !hit_it;
        extra += !enters(box, ray) && hit_it;
    }
    CHECK(missed == 0);
    CHECK(extra <= 10);
}

TEST_CASE("box test: the worst roundings on both sides do not lose a box") {
    // Found by search: the exact ray passes the box's edge inside by less than 1e-9, and the near distance comes out
    // more than 4 * 2^-24 above the far one.
    struct Worst {
        float ox, oy, dx, dy, px, py;
    };
    for (const Worst& w :
         {Worst{-0x1.0d97e8p+0F, -0x1.21e958p+0F, 0x1.c82634p-1F, 0x1.e501dp-1F, 0x1.db48ep-5F, 0x1.90f3ap-5F},
          Worst{-0x1.037d3p+0F, -0x1.16668ep+0F, 0x1.b4dabp-1F, 0x1.d34c74p-1F, 0x1.af3286p-7F, 0x1.634a74p-7F},
          Worst{-0x1.022144p+0F, -0x1.140102p+0F, 0x1.c4fccap-1F, 0x1.cdf42ap-1F, 0x1.00b17p-4F, 0x1.cc517cp-7F}}) {
        const Box box{{w.px, w.py - 1, -1}, {w.px + 1, w.py, 1}};
        Ray ray;
        ray.origin = {w.ox, w.oy, 0};
        ray.direction = {w.dx, w.dy, 0};
        CHECK(enters(box, ray));
        CHECK(hits(box, Box{}, ray).mask == 1);
    }
}

TEST_CASE("box test: all combinations of signs and zeros of the direction") {
    const Box box = box_of({-1, -1, -1}, {1, 1, 1});
    for_sign_combinations([&](Vec3 direction) {
        for (const float scale : {1.0F, 1e-6F, 1e6F}) {
            Ray ray;
            ray.direction = direction * scale;
            INFO("direction " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z);
            ray.origin = {0, 0, 0};
            CHECK(hits(box, Box{}, ray).mask == 1);
            ray.origin = direction * -3;
            CHECK(hits(Box{}, box, ray).mask == 2);
            ray.origin = direction * 3;  // behind
            CHECK(hits(box, box, ray).mask == 0);
            for (int axis = 0; axis < 3; ++axis) {  // beside: off along an axis with direction zero
                if (direction[axis] != 0) continue;
                for (const float off : {-1.5F, 1.5F}) {
                    ray.origin = direction * -3 + Vec3{axis == 0 ? off : 0, axis == 1 ? off : 0, axis == 2 ? off : 0};
                    CHECK(hits(box, box, ray).mask == 0);
                }
            }
        }
    });
}

TEST_CASE("box test: a ray in the plane of a face, along an edge or from a corner hits the box") {
    const Box box = box_of({1, 2, 3}, {4, 5, 6});
    for_sign_combinations([&](Vec3 direction) {
        // From each of the points of the box's 3x3x3 grid, which lie on its planes, edges and corners.
        for (const float x : {1.0F, 2.5F, 4.0F})
            for (const float y : {2.0F, 3.5F, 5.0F})
                for (const float z : {3.0F, 4.5F, 6.0F}) {
                    Ray ray;
                    ray.direction = direction;
                    ray.origin = {x, y, z};
                    CHECK(hits(box, Box{}, ray).mask == 1);
                    ray.origin = ray.origin - direction * 8;
                    CHECK(hits(box, Box{}, ray).mask == 1);
                }
    });
}

TEST_CASE("box test: a flat box is hit from both sides and along its plane") {
    const Box flat = box_of({-1, 0, -1}, {1, 0, 1});
    for_sign_combinations([&](Vec3 direction) {
        Ray ray;
        ray.direction = direction;
        ray.origin = direction * -2;
        CHECK(hits(flat, Box{}, ray).mask == 1);
    });
}

TEST_CASE("box test: an empty box is never hit") {
    Random random(4);
    std::uint64_t wrong = 0;
    for (int i = 0; i < 1000000; ++i) {
        Ray ray;
        ray.origin = {awkward(random), awkward(random), awkward(random)};
        ray.direction = {awkward(random), awkward(random), awkward(random)};
        if (ray.direction == Vec3{}) continue;
        if (random.below(2) == 0) ray.t_max = random.unit();
        wrong += hits(Box{}, Box{}, ray).mask != 0;
    }
    CHECK(wrong == 0);
}

TEST_CASE("box test: a huge scene and a tiny one lose no box") {
    Random random(5);
    for (const float scale : {1e-18F, 1e-12F, 1e-6F, 1e6F, 1e12F, 1e15F}) {
        std::uint64_t missed = 0;
        for (int i = 0; i < 100000; ++i) {
            const Vec3 at = random.in({{-1, -1, -1}, {1, 1, 1}}) * scale;
            const Box box = box_of(at, at + random.in({{0, 0, 0}, {0.1F, 0.1F, 0}}) * scale);
            Ray ray;
            ray.origin = random.in({{-1, -1, -1}, {1, 1, 1}}) * scale;
            ray.direction = normalize((random.in(box)-ray.origin) / scale);
            missed += enters(box, ray) && hits(box, Box{}, ray).mask != 1;
        }
        INFO("scale " << scale);
        CHECK(missed == 0);
    }
}

TEST_CASE("box test: directions with denormal components lose no box") {
    Random random(6);
    const float tiny = std::numeric_limits<float>::denorm_min();
    std::uint64_t missed = 0;
    for (int i = 0; i < 100000; ++i) {
        Ray ray;
        ray.direction = random.direction();
        const float x = tiny * static_cast<float>(1 + random.below(1000)) * (random.below(2) == 0 ? 1.0F : -1.0F);
        (i % 3 == 0 ? ray.direction.x : i % 3 == 1 ? ray.direction.y : ray.direction.z) = x;
        const Vec3 at = random.in({{-1, -1, -1}, {1, 1, 1}});
        const Box box = box_of(at, at + random.in({{0, 0, 0}, {1, 1, 1}}));
        ray.origin =
            random.below(2) == 0 ? box.lower - ray.direction * random.unit() : random.in({{-1, -1, -1}, {1, 1, 1}});
        missed += enters(box, ray) && hits(box, Box{}, ray).mask != 1;
    }
    CHECK(missed == 0);
}

TEST_CASE("box test: the box entered first is near, and child 0 on a tie") {
    const Box low = box_of({0, 0, 0}, {1, 1, 1}), high = box_of({2, 0, 0}, {3, 1, 1});
    Ray ray;
    ray.origin = {-1, 0.5F, 0.5F};
    ray.direction = {1, 0, 0};
    CHECK(hits(low, high, ray).mask == 3);
    CHECK(hits(low, high, ray).near == 0);
    CHECK(hits(high, low, ray).near == 1);
    ray.origin = {4, 0.5F, 0.5F};
    ray.direction = {-1, 0, 0};
    CHECK(hits(low, high, ray).near == 1);
    CHECK(hits(high, low, ray).near == 0);
    CHECK(hits(low, low, ray).near == 0);
    ray.origin = {0.5F, 0.5F, 0.5F};  // in both: entered at t_min
    CHECK(hits(low, low, ray).near == 0);
    // One child hit: that one is near.
    ray.origin = {2.5F, 0.5F, 0.5F};
    ray.direction = {0, 1, 0};
    CHECK(hits(low, high, ray).mask == 2);
    CHECK(hits(low, high, ray).near == 1);
    CHECK(hits(high, low, ray).mask == 1);
    CHECK(hits(high, low, ray).near == 0);
}

TEST_CASE("box test: a shorter t_max drops boxes behind it") {
    const Box box = box_of({0, 0, 0}, {1, 1, 1});
    Ray ray;
    ray.origin = {-1, 0.5F, 0.5F};
    ray.direction = {1, 0, 0};
    BoxRay prepared;
    prepared.set(ray);
    const Bvh2Node node = node_of(box, box);
    CHECK(found(node, prepared).mask == 3);
    prepared.set_t_max(1);
    CHECK(found(node, prepared).mask == 3);
    prepared.set_t_max(0.99F);
    CHECK(found(node, prepared).mask == 0);
}
