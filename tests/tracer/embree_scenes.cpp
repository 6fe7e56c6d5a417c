// The traversal against Embree's robust mode on whole scenes, with a judge in double arithmetic for the differences.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "embree_comparison.hpp"
#include "path_rays.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// Shares of rays about which two right answers may differ, as measured with a margin: rays as they come, and rays aimed
/// at edges and vertices on purpose.
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
    CHECK(result.ours_wrong == 0);
    CHECK(result.embree_wrong == 0);
    CHECK(static_cast<double>(result.excused) <= 2 + share * static_cast<double>(result.rays));
}

class Clock {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }
private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A million rays: those of paths, random ones, and some aimed at edges.
void compare_on(Scene scene, const BvhSettings& settings, std::size_t million) {
    Clock clock;
    const PreparedScene prepared(opaque(std::move(scene)), settings);
    const double build = clock.lap();
    const EmbreeReference embree(prepared.scene());
    const double build2 = clock.lap();
    const std::size_t from_paths = million * 6 / 10, others = million / 10;
    RayCollector collector(prepared);
    trace_pictures(prepared, collector, 256, PathSettings{.bounces = 4, .russian_roulette = false},
                   [&] { return collector.closest_rays.size() + collector.shadow_rays.size() < from_paths; });
    const Box box = widened(prepared.scene().bounds());

    const Comparison path = compare_closest(prepared, embree, collector.closest_rays);
    const Comparison shadow = compare_any(prepared, embree, collector.shadow_rays);
    const Comparison random = compare_closest(prepared, embree, random_rays(box, others, 1));
    const Comparison segments = compare_closest(prepared, embree, random_segments(box, others, 2));
    const Comparison any = compare_any(prepared, embree, random_segments(box, others, 3));
    const auto at_edges = aimed_rays(prepared.scene(), box, others, 4);
    const Comparison aimed = compare_closest(prepared, embree, at_edges), aimed_any = compare_any(prepared, embree, at_edges);
    INFO("path " << path.text() << "\nshadow " << shadow.text() << "\nrandom " << random.text() << "\nsegments "
                          << segments.text() << "\nany " << any.text() << "\naimed " << aimed.text() << "\naimed any "
                          << aimed_any.text());
    if (std::getenv("H_VERBOSE")) WARN("path " << path.text() << "\nshadow " << shadow.text() << "\nrandom " << random.text() << "\nsegments "
                          << segments.text() << "\nany " << any.text() << "\naimed " << aimed.text() << "\naimed any "
                          << aimed_any.text() << "\nbuild " << build << " embree " << build2 << " trace " << clock.lap());
    for (const Comparison& result : {path, shadow, random, segments, any}) check(result, excused_share);
    check(aimed, excused_aimed_share);
    check(aimed_any, excused_aimed_share);
}

std::string scenes_folder() {
    const char* given = std::getenv("RAYCACHE_SCENES");
    return given != nullptr ? given : RAYCACHE_SOURCE_DIR "/../shared/scenes";
}

}  // namespace

TEST_CASE("embree: hits equal Embree's on a million rays in each built scene") {
    const std::size_t million = 1000000;
    SECTION("soup of small triangles") { compare_on(soup(20000, 0.1F, 1), {}, million); }
    SECTION("soup of large triangles with spatial splits") {
        compare_on(soup(2000, 1.0F, 2), {.max_leaf_size = 4, .spatial_splits = true}, million);
    }
    SECTION("sphere in a box") {
        Scene scene = icosphere(5);
        append(scene, moved(icosphere(0), 4, {0, 0, 0}));
        compare_on(std::move(scene), {}, million);
    }
}

TEST_CASE("embree: hits equal Embree's on a million rays in each real scene", "[slow]") {
    for (const char* name : {"cornell_box", "wooden_staircase", "sponza", "contemporary_bathroom", "white_room",
                             "country_kitchen", "bistro_interior", "san_miguel"}) {
        DYNAMIC_SECTION(name) {
            const std::string path = scenes_folder() + "/" + name + ".glb";
            if (!std::filesystem::exists(path)) {
                WARN(path << " is absent: not compared");
                continue;
            }
            compare_on(load_gltf(path, nullptr), {}, 1000000);
        }
    }
}
