// The builder's tree.
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "test_rays.hpp"
#include "tracer/bvh/bvh.hpp"
#include "traces/error.hpp"
#include "trees.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

Box box_of(const Scene& scene, std::uint32_t triangle) {
    Box box;
    for (std::uint32_t c = 0; c < 3; ++c) box.add(corner(scene, triangle, c));
    return box;
}

double area(const Box& box) {
    const Vec3 size = box.upper - box.lower;
    return 2 * (double{size.x} * size.y + double{size.y} * size.z + double{size.z} * size.x);
}

/// Expected steps and tests of a random ray that meets the root's box.
double sah_cost(const Bvh& bvh) {
    double cost = 0;
    for (const Bvh::Node& node : bvh.nodes) cost += area(node.box) * (node.is_leaf() ? node.count : 1);
    return cost / area(bvh.nodes[0].box);
}

}  // namespace

TEST_CASE("bvh: every triangle stands in exactly one leaf, whose box contains it") {
    for (const std::uint32_t leaf_size : {1U, 2U, 4U, 7U})
        for (const Scene& scene : {soup(5000, 0.2F, 1), icosphere(3), sticks()}) {
            const Bvh bvh = build_bvh(scene, {leaf_size, false});
            check_shape(bvh, leaf_size);
            std::vector<std::uint32_t> sorted = bvh.triangles;
            std::sort(sorted.begin(), sorted.end());
            REQUIRE(sorted.size() == scene.triangle_count());
            for (std::uint32_t t = 0; t < sorted.size(); ++t) REQUIRE(sorted[t] == t);
            for (const Bvh::Node& node : bvh.nodes)
                for (std::uint32_t k = 0; k < node.count; ++k)
                    REQUIRE(contains(node.box, box_of(scene, bvh.triangles[node.first + k])));
            CHECK(bvh.nodes[0].box == scene.bounds());
        }
}

TEST_CASE("bvh: with spatial splits every triangle stands in some leaf, and its leaves' boxes cover it") {
    for (const Scene& scene : {soup(3000, 0.5F, 2), sticks()}) {
        const Bvh bvh = build_bvh(scene, {4, true});
        check_shape(bvh, 4);
        CHECK(bvh.triangles.size() > scene.triangle_count());
        std::vector<std::vector<Box>> boxes(scene.triangle_count());
        for (const Bvh::Node& node : bvh.nodes)
            for (std::uint32_t k = 0; k < node.count; ++k) boxes[bvh.triangles[node.first + k]].push_back(node.box);
        Random random(4);
        std::uint64_t outside = 0;
        for (std::uint32_t t = 0; t < boxes.size(); ++t) {
            REQUIRE(!boxes[t].empty());
            for (int i = 0; i < 50; ++i) {
                const float u = random.unit(), v = (1 - u) * random.unit();
                const Vec3 p = corner(scene, t, 0) * (1 - u - v) + corner(scene, t, 1) * u + corner(scene, t, 2) * v;
                const Vec3 rounding{1e-6F, 1e-6F, 1e-6F};
                outside += std::none_of(boxes[t].begin(), boxes[t].end(), [&](const Box& b) {
                    return contains({b.lower - rounding, b.upper + rounding}, {p, p});
                });
            }
        }
        CHECK(outside == 0);
    }
}

TEST_CASE("bvh: spatial splits lower the SAH cost of long triangles and change no hit") {
    Scene scene = sticks();
    const double plain = sah_cost(build_bvh(scene, {4, false})), split = sah_cost(build_bvh(scene, {4, true}));
    INFO(plain << " -> " << split);
    CHECK(split < 0.9 * plain);
    const PreparedScene one(Scene(scene), BvhSettings{4, false}), other(Scene(scene), BvhSettings{4, true});
    const auto rays = random_rays({{-1, -1, -1}, {1, 1, 1}}, 100000, 5);
    const auto a = closest_hits(one, rays), b = closest_hits(other, rays);
    std::uint64_t differ = 0, found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        differ += a[i].triangle != b[i].triangle || a[i].t != b[i].t;
        found += a[i].found();
    }
    CHECK(differ == 0);
    CHECK(found > 10000);
}

TEST_CASE("bvh: equal scenes give equal trees, on any number of threads", "[slow]") {
    const Scene scene = soup(20000, 0.1F, 6);
    for (const bool splits : {false, true}) {
        const Bvh first = build_bvh(scene, {4, splits});
        for (const int threads : {1, 2, 4}) {
            tbb::task_arena arena(threads);
            arena.execute([&] { CHECK(equal(first, build_bvh(scene, {4, splits}))); });
        }
    }
}

TEST_CASE("bvh: duplicate triangles are split among leaves") {
    Scene scene = icosphere(0);
    for (int i = 0; i < 6; ++i) append(scene, Scene(scene));
    const Bvh bvh = build_bvh(scene, {});
    check_shape(bvh, 4);
    CHECK(bvh.triangles.size() == 20 * 64);
}

TEST_CASE("bvh: a thousand triangles on one spot make a tree of bounded depth") {
    Scene scene = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    for (int i = 0; i < 9; ++i) append(scene, Scene(scene));
    const Bvh bvh = build_bvh(scene, {});
    check_shape(bvh, 4);
    CHECK(bvh.depth <= 20);
}

TEST_CASE("bvh: scenes times 1e-6 and 1e6, moved by 1e5, and up to the largest coordinate build sound trees") {
    for (const auto& [scale, offset] :
         {std::pair{1e-6F, 0.0F}, {1e6F, 0.0F}, {1.0F, 1e5F}, {1e-6F, 1e5F}, {4e17F, 0.0F}}) {
        INFO("scale " << scale << " offset " << offset);
        const Scene scene = moved(soup(2000, 0.2F, 7), scale, {offset, -offset, offset});
        const Bvh bvh = build_bvh(scene, {});
        check_shape(bvh, 4);
        CHECK(bvh.triangles.size() == 2000);
    }
}

TEST_CASE("bvh: a scene without triangles or with a coordinate beyond the limit is refused in one line") {
    CHECK_THROWS_AS(build_bvh(mesh({}, {})), Error);
    CHECK_THROWS_WITH(build_bvh(mesh({}, {})), Catch::Contains("test: no triangle") && !Catch::Contains("\n"));
    for (const float bad : {2e18F, -2e18F, std::numeric_limits<float>::infinity()})
        CHECK_THROWS_WITH(build_bvh(mesh({{0, 0, 0}, {1, 0, 0}, {0, bad, 0}}, {0, 1, 2})),
                          Catch::Contains("scale the scene down") && !Catch::Contains("\n"));
}
