// Ray orders: keys against hand-computed values, the sort, and what it costs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "test_meshes.hpp"
#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "tracer/simt/orders/sort_cost.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;
using Catch::Matchers::Contains;

namespace {

/// Two walls at x = 0 and x = 1 of the unit cube.
Scene unit_walls() {
    return test::mesh({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 1, 1}},
                      {0, 1, 2, 1, 3, 2, 4, 5, 6, 5, 7, 6});
}

std::uint32_t key(const std::string& order, Vec3 origin, Vec3 direction) {
    return ray_order_entry(order).make(unit_walls())->key({origin, direction});
}

}  // namespace

TEST_CASE("Morton codes interleave x, y, z from the highest bit") {
    CHECK(morton_code({1, 0, 0}) == 4);
    CHECK(morton_code({0, 1, 0}) == 2);
    CHECK(morton_code({0, 0, 1}) == 1);
    CHECK(morton_code({2, 0, 1}) == 0b100'001);
    CHECK(morton_code({1023, 1023, 1023}) == (1U << 30) - 1);
    CHECK(morton_code({0b10'0000'0000, 0, 0}) == 1U << 29);
}

TEST_CASE("cells of a grid clamp what lies outside, and an axis without extent has one cell") {
    CHECK(cell_of(-1, 8) == 0);
    CHECK(cell_of(0.999F, 8) == 7);
    CHECK(cell_of(1, 8) == 7);
    CHECK(cell_of(std::numeric_limits<float>::infinity(), 8) == 7);
    CHECK(cell_of(std::numeric_limits<float>::quiet_NaN(), 8) == 0);
    const CellGrid flat({{0, 5, 0}, {2, 5, 2}}, 4);
    CHECK(flat({1, 5, 1.9F}) == Cell{2, 0, 3});
}

TEST_CASE("ray order keys are those computed by hand") {
    // Origin (0.5, 0, 0): x = 512 of 1024, one bit of Morton code.
    CHECK(key("morton", {0.5F, 0, 0}, {1, 0, 0}) == 1U << 29);
    CHECK(key("morton", {0, 0, 0.25F}, {1, 0, 0}) == 1U << 24);
    CHECK(key("morton", {0.5F, 0, 0}, {-1, 3, 0}) == 1U << 29);  // whatever the direction

    CHECK(key("octant-morton", {0.5F, 0, 0}, {1, 0, 0}) == 1U << 26);
    CHECK(key("octant-morton", {0.5F, 0, 0}, {-1, 1, -1}) == (0b101U << 27 | 1U << 26));

    // Direction (1,0,0): cells (7, 4, 4) of 8: triples from the top 111, 100, 100.
    CHECK(key("garanzha-loop", {0, 0, 0}, {2, 0, 0}) == 0b111'100'100);
    CHECK(key("garanzha-loop", {0.5F, 0, 0}, {2, 0, 0}) == (1U << 23 | 0b111'100'100U));

    // Origin cells (32, 0, 1) of 64: triples 100 000 000 000 000 001. Direction cells (15, 8, 8) of 16: 111 100 100
    // 100. O O O D O D O D O D.
    CHECK(key("meister", {0.5F, 0, 0.02F}, {1, 0, 0}) == 0b100'000'000'111'000'100'000'100'001'100);

    // The scene's extent is 1, so a ray is expected to end 0.25 on: cell (8, 0, 0) of 32, triples 000 100 000 000 000.
    CHECK(key("meister-two-point", {0, 0, 0}, {4, 0, 0}) == 0b000'000'000'100'000'000'000'000'000'000);
    CHECK(key("meister-two-point", {0.5F, 0, 0}, {0, 0, 7}) == 0b100'100'000'001'000'000'000'000'000'000);

    CHECK(key("pharr", {0.5F, 0.99F, 0.07F}, {1, 0, 0}) == (1U << 8 | 15U << 4 | 8U));
}

TEST_CASE("the two-point key ends no later than the ray") {
    const auto order = ray_order_entry("meister-two-point").make(unit_walls());
    CHECK(order->key({{0, 0, 0}, {1, 0, 0}, 0, 0.01F}) == 0);
}

TEST_CASE("Moon's key is the Morton code of where the ray enters the first voxel of another surface") {
    const CellGrid grid({{0, 0, 0}, {1, 1, 1}}, 1024);
    // From the wall x = 0 to the voxels of the wall x = 1, which begin at x = 63/64.
    CHECK(key("moon", {0, 0.4F, 0.6F}, {1, 0, 0}) == morton_code(grid({0.984375F, 0.4F, 0.6F})));
    // The length of the direction does not matter.
    CHECK(key("moon", {0, 0.4F, 0.6F}, {9, 0, 0}) == morton_code(grid({0.984375F, 0.4F, 0.6F})));
    // Between the walls upwards: nothing until the ray leaves at y = 1.
    CHECK(key("moon", {0.5F, 0.4F, 0.6F}, {0, 1, 0}) == morton_code(grid({0.5F, 1, 0.6F})));
    CHECK(key("moon", {0.5F, 0.4F, 0.6F}, {0, -1, 0}) == morton_code(grid({0.5F, 0, 0.6F})));
}

TEST_CASE("every order's keys fit its key bits and depend on nothing but the ray") {
    const Scene scene = test::moved(unit_walls(), 7, {-3, 2, 100});
    test::Random random(3);
    for (const RayOrderEntry& entry : ray_orders()) {
        INFO(entry.name);
        const auto order = entry.make(scene);
        if (entry.name == "none") {
            CHECK(!order);
            continue;
        }
        const auto again = entry.make(scene);
        bool fits = true, same = true;
        for (int i = 0; i < 2000; ++i) {
            // Outside the scene, too.
            const Ray ray{random.in({{-10, -10, 80}, {10, 10, 120}}), random.direction()};
            const std::uint32_t k = order->key(ray);
            fits = fits && std::uint64_t{k} < std::uint64_t{1} << order->key_bits();
            same = same && again->key(ray) == k;
        }
        CHECK(fits);
        CHECK(same);
    }
}

TEST_CASE("the keys of a scene without extent are defined") {
    const Scene point = test::mesh({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {0, 1, 2});
    for (const RayOrderEntry& entry : ray_orders())
        if (const auto order = entry.make(point)) {
            INFO(entry.name);
            CHECK(order->key({{1, 1, 1}, {0, 0, 1}}) == order->key({{1, 1, 1}, {0, 0, 1}}));
        }
}

TEST_CASE("sorting is a stable permutation") {
    CHECK(sorted_indices({3, 1, 2, 1, 3}) == std::vector<std::uint32_t>{1, 3, 2, 0, 4});
    test::Random random(8);
    std::vector<std::uint32_t> keys(5000);
    for (std::uint32_t& k : keys) k = random.below(50);
    const auto order = sorted_indices(keys);
    bool stable = true;
    for (std::size_t i = 1; i < order.size(); ++i)
        stable = stable && std::pair(keys[order[i - 1]], order[i - 1]) < std::pair(keys[order[i]], order[i]);
    CHECK(stable);
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(keys.size());
    std::iota(all.begin(), all.end(), 0U);
    CHECK(sorted == all);
}

TEST_CASE("the cost of a sort follows the passes that its keys need") {
    const auto cost = [](const char* order) { return sort_cost(*ray_order_entry(order).make(unit_walls())); };
    CHECK(cost("morton").bytes_per_ray == 40 + 4 + 4 * 16);
    CHECK(cost("morton").bytes_per_run == 0);
    CHECK(cost("pharr").bytes_per_ray == 40 + 4 + 2 * 16);
    CHECK(cost("garanzha-loop").bytes_per_ray == 60);
    CHECK(cost("garanzha-loop").bytes_per_run == 24 + 4 + 3 * 16);
}

TEST_CASE("an unknown ray order is refused with the valid names") {
    CHECK_THROWS_WITH(ray_order_entry("hilbert"), Contains("unknown ray order 'hilbert'") &&
                                                      Contains("none, morton, octant-morton") && Contains("moon"));
    CHECK_THROWS_AS(ray_order_entry("hilbert"), UsageError);
}
