// The traversal against Embree's robust mode on whole scenes, with a judge in double arithmetic for the differences.
#include <catch2/catch.hpp>

#include "embree_comparison.hpp"
#include "path_rays.hpp"
#include "tests/real_data.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// Shares of rays about which two right answers may differ, as measured with a margin: rays as they come, and rays
/// aimed at edges and vertices on purpose.
constexpr double excused_share = 1e-5, excused_aimed_share = 0.1;

Box widened(const Box& box) {
    const Vec3 border = (box.upper - box.lower) * 0.1F;
    return {box.lower - border, box.upper + border};
}

/// Segments of random length in the box.
std::vector<Ray> random_segments(const Box& box, std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray = ray_to(random.in(box), random.in(box));
        ray.t_min = random.below(2) == 0 ? 0.0F : 0.25F;
        ray.t_max = 1;
    }
    return rays;
}

void check(const Comparison& result, double share) {
    INFO(result.text());
    CHECK(result.ours_wrong == 0);
    CHECK(result.embree_wrong == 0);
    CHECK(static_cast<double>(result.excused) <= share * static_cast<double>(result.rays));
}

/// A million rays: those of paths, random ones, and some aimed at edges.
void compare_on(Scene scene, const BvhSettings& settings, std::size_t million) {
    const PreparedScene prepared(opaque(std::move(scene)), settings);
    const EmbreeScene embree(prepared.scene());
    const std::size_t from_paths = million * 6 / 10, others = million / 10;
    RayCollector collector(prepared);
    trace_pictures(prepared, collector, 256, PathSettings{.bounces = 4, .russian_roulette = false},
                   [&] { return collector.closest_rays.size() + collector.shadow_rays.size() < from_paths; });
    const Box box = widened(prepared.scene().bounds());

    const auto random = random_rays(box, others, 1);
    const auto segments = random_segments(box, others, 2), blocked = random_segments(box, others, 3);
    const auto at_edges = aimed_rays(prepared.scene(), box, others, 4);
    for (const char* layout : {"bvh2", "bvh4", "cwbvh8"}) {
        INFO(layout);
        const PreparedScene& walked = prepared.in_layout(layout);
        Comparison found = compare_closest(walked, embree, collector.closest_rays, prepared);
        found += compare_any(walked, embree, collector.shadow_rays, prepared);
        found += compare_closest(walked, embree, random, prepared);
        found += compare_closest(walked, embree, segments, prepared);
        found += compare_any(walked, embree, blocked, prepared);
        check(found, excused_share);

        Comparison aimed = compare_closest(walked, embree, at_edges, prepared);
        aimed += compare_any(walked, embree, at_edges, prepared);
        check(aimed, excused_aimed_share);
    }
}

}  // namespace

TEST_CASE("embree: hits equal Embree's on a million rays in each built scene, in every kind of node", "[slow]") {
    const std::size_t million = 1000000;
    const Camera outside{"outside", {0.1F, 0.2F, 4}, {0, 0, -1}, {0, 1, 0}, 40};
    SECTION("soup of small triangles") {
        Scene scene = soup(20000, 0.1F, 1);
        scene.cameras = {outside};
        compare_on(std::move(scene), {}, million);
    }
    SECTION("soup of large triangles with spatial splits") {
        Scene scene = soup(2000, 1.0F, 2);
        scene.cameras = {outside};
        compare_on(std::move(scene), {.max_leaf_size = 4, .spatial_splits = true}, million);
    }
    SECTION("sphere in a box") {
        Scene scene = icosphere(5);
        append(scene, moved(icosphere(0), 8, {0, 0, 0}));
        scene.cameras = {outside};
        compare_on(std::move(scene), {}, million);
    }
}

TEST_CASE("embree: hits equal Embree's on a million rays in each real scene, in every kind of node", "[slow][data]") {
    for (const char* name : {"cornell_box", "wooden_staircase", "sponza", "contemporary_bathroom", "white_room",
                             "country_kitchen", "bistro_interior", "san_miguel"}) {
        DYNAMIC_SECTION(name) {
            const auto path = raycache::test::real_scene(name + std::string(".glb"));
            if (path) compare_on(load_gltf(*path, nullptr), {}, 1000000);
        }
    }
}
