// The warp traversal: right hits, lanes that do not disturb each other, records that obey the lock-step rule.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "exact_judge.hpp"
#include "reference_warp.hpp"
#include "test_rays.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;
using raycache::traces::RayType;
using raycache::traces::Record;
using raycache::traces::WarpTrace;

namespace {

const Box cube{{-1.2F, -1.2F, -1.2F}, {1.2F, 1.2F, 1.2F}};

bool equal(const Hit& a, const Hit& b) { return a.triangle == b.triangle && a.t == b.t && a.u == b.u && a.v == b.v; }

Hit brute_force(const PreparedScene& scene, const Ray& ray) {
    ShearedRay prepared;
    prepared.set(ray);
    Hit hit;
    hit.t = ray.t_max;
    for (const LeafTriangle& t : bvh2_of(scene).triangles) test_triangle(t, prepared, hit);
    return hit;
}

struct Recorded {
    WarpTrace trace;
    std::vector<Hit> hits = std::vector<Hit>(32);
    std::uint32_t occluded = 0;
};

Recorded record(const PreparedScene& scene, std::uint32_t mask, const Ray* rays, bool any_hit) {
    WarpRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    Recorded out;
    if (any_hit)
        out.occluded = traversal->occluded(mask, RayType::shadow, 3, rays);
    else
        traversal->closest(mask, RayType::bounce, 2, rays, out.hits.data());
    recorder.store(out.trace);
    return out;
}

/// Groups of 32 rays, some coherent and some not.
std::vector<Ray> warps_of_rays(std::size_t warps, std::uint32_t seed) {
    std::vector<Ray> rays = random_rays(cube, 32 * warps, seed);
    Random random(seed + 1);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (i / 32 % 2 == 0) {
            rays[i].origin = rays[i / 32 * 32].origin;
            rays[i].direction = normalize(rays[i / 32 * 32].direction + rays[i].direction * 0.1F);
        }
        if (random.below(4) == 0) rays[i].t_max = random.unit();
    }
    return rays;
}

}  // namespace

TEST_CASE("warp traversal: the closest hit is that of testing every triangle") {
    for (const bool splits : {false, true}) {
        const PreparedScene scene(soup(500, 0.6F, 1), BvhSettings{4, splits});
        const auto rays = warps_of_rays(600, 2);
        const auto hits = closest_hits(scene, rays);
        const auto any = any_hits(scene, rays);
        std::uint64_t other = 0, wrong = 0, any_wrong = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = brute_force(scene, rays[i]);
            if (!equal(hits[i], expected) && (hits[i].found() || expected.found())) {
                ++other;  // a box may end a rounding error before its triangle: the judge decides
                wrong += !justified(crossings(scene, rays[i]), rays[i], hits[i]);
            }
            any_wrong += any[i] != expected.found();
        }
        CHECK(other <= 2);
        CHECK(wrong == 0);
        CHECK(any_wrong <= 2);
    }
}

TEST_CASE("warp traversal: any-hit finds something exactly where closest-hit does") {
    const PreparedScene plain(soup(20000, 0.1F, 3), {});
    const PreparedScene holes = with_holes(soup(20000, 0.1F, 3));
    for (const PreparedScene* scene : {&plain, &holes}) {
        const auto rays = warps_of_rays(3000, 4);
        const auto hits = closest_hits(*scene, rays);
        const auto any = any_hits(*scene, rays);
        std::uint64_t differ = 0, found = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            differ += hits[i].found() != any[i];
            found += any[i];
        }
        CHECK(differ == 0);
        CHECK(found > rays.size() / 10);
        CHECK(found < rays.size());
    }
}

TEST_CASE("warp traversal: a lane's hit does not depend on the other lanes, nor on its place") {
    const PreparedScene scene = with_holes(soup(5000, 0.2F, 5));
    const auto rays = warps_of_rays(100, 6);
    Random random(7);
    std::uint64_t differ = 0;
    for (std::size_t first = 0; first < rays.size(); first += 32) {
        const Recorded all = record(scene, ~0U, &rays[first], false), all_any = record(scene, ~0U, &rays[first], true);
        for (const std::uint32_t mask : {random.bits(), random.bits() & random.bits(), 1U << random.below(32)}) {
            if (mask == 0) continue;
            const Recorded some = record(scene, mask, &rays[first], false),
                           some_any = record(scene, mask, &rays[first], true);
            for (unsigned l = 0; l < 32; ++l)
                differ += ((mask >> l) & 1U) != 0 ? !equal(some.hits[l], all.hits[l]) : !equal(some.hits[l], Hit{});
            differ += some_any.occluded != (all_any.occluded & mask);
        }
        std::vector<unsigned> order(32);
        std::iota(order.begin(), order.end(), 0U);
        for (unsigned l = 31; l > 0; --l) std::swap(order[l], order[random.below(l + 1)]);
        std::vector<Ray> permuted(32);
        for (unsigned l = 0; l < 32; ++l) permuted[l] = rays[first + order[l]];
        const Recorded other = record(scene, ~0U, permuted.data(), false);
        for (unsigned l = 0; l < 32; ++l) differ += !equal(other.hits[l], all.hits[order[l]]);
    }
    CHECK(differ == 0);
}

TEST_CASE("warp traversal: records are those of lone rays laid side by side in lock step") {
    const PreparedScene plain(soup(3000, 0.3F, 8), {});
    const PreparedScene holes = with_holes(soup(3000, 0.3F, 8), {7, false});
    const PreparedScene split = with_holes(soup(300, 1.0F, 8), {2, true});
    Random random(10);
    for (const PreparedScene* scene : {&plain, &holes, &split})
        for (const bool any_hit : {false, true}) {
            const auto rays = warps_of_rays(200, 9);
            std::uint64_t differ = 0, texels = 0;
            for (std::size_t first = 0; first < rays.size(); first += 32) {
                const std::uint32_t mask = first % 64 == 0 ? ~0U : random.bits() | 1U;
                std::vector<LoneRay> lanes;
                for (unsigned l = 0; l < 32; ++l) lanes.emplace_back(*scene, rays[first + l], any_hit);
                const Recorded got = record(*scene, mask, &rays[first], any_hit);
                const WarpTrace expected =
                    any_hit ? lock_step(lanes, mask, RayType::shadow, 3) : lock_step(lanes, mask, RayType::bounce, 2);
                differ += got.trace != expected;
                for (unsigned l = 0; l < 32; ++l)
                    if (((mask >> l) & 1U) != 0)
                        differ += any_hit ? (((got.occluded >> l) & 1U) != 0) != lanes[l].hit.found()
                                          : !equal(got.hits[l], lanes[l].hit);
                for (const Record& r : got.trace.records) texels += r.is_access() && r.region == Bvh2::region_count;
            }
            CHECK(differ == 0);
            CHECK((texels > 0) == (scene != &plain));
        }
}

TEST_CASE("warp traversal: a trace begins with a ray start and the root, and holds only lanes of the mask") {
    const PreparedScene scene = with_holes(soup(2000, 0.3F, 11));
    const auto rays = warps_of_rays(50, 12);
    for (const std::uint32_t mask : {~0U, 0x0000ffffU, 0x80000001U, 0x00010000U}) {
        for (std::size_t first = 0; first < rays.size(); first += 32) {
            const Recorded got = record(scene, mask, &rays[first], false);
            const auto& records = got.trace.records;
            REQUIRE(records.size() >= 2);
            REQUIRE(records[0] == Record{mask, raycache::traces::ray_start, RayType::bounce, 2, 0});
            REQUIRE(records[1] == Record{mask, Bvh2::node_region, RayType::bounce, 2, 0});
            std::size_t elements = 0;
            for (const Record& r : records) {
                REQUIRE(r.mask != 0);
                REQUIRE((r.mask & ~mask) == 0);
                if (r.is_access()) elements += r.lanes();
            }
            REQUIRE(elements == got.trace.elements.size());
            REQUIRE(std::all_of(got.trace.elements.begin(), got.trace.elements.begin() + records[0].lanes(),
                                [](std::uint32_t e) { return e == 0; }));
        }
    }
}

TEST_CASE("warp traversal: the same ray in every lane makes full warps") {
    const PreparedScene scene(soup(2000, 0.3F, 13), {});
    const std::vector<Ray> rays(32, random_rays(cube, 1, 14)[0]);
    for (const Record& r : record(scene, ~0U, rays.data(), false).trace.records) CHECK(r.mask == ~0U);
}

TEST_CASE("warp traversal: holes let rays through to what is behind, for closest and shadow rays") {
    // Two textured squares, one behind the other; texture alpha is a chessboard of 4x4.
    Scene scene = quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
    append(scene, quad({0, 0, -1}, {4, 0, -1}, {4, 4, -1}, {0, 4, -1}));
    PreparedScene made = [&] {
        Texture texture{4, 4, {}, "chessboard"};
        for (std::uint32_t i = 0; i < 16; ++i)
            for (const int byte : {255, 255, 255, (i + i / 4) % 2 == 0 ? 255 : 0})
                texture.rgba.push_back(static_cast<std::uint8_t>(byte));
        scene.textures.push_back(texture);
        scene.materials[0].alpha_mask = true;
        scene.materials[0].base_color_texture = 0;
        scene.materials.emplace_back();
        scene.material_of = {0, 0, 1, 1};
        for (int square = 0; square < 2; ++square)
            for (const Vec2 t : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) scene.texcoords.push_back(t);
        return PreparedScene(std::move(scene), BvhSettings{});
    }();
    for (std::uint32_t i = 0; i < 16; ++i) {
        Ray ray;
        ray.origin = {static_cast<float>(i % 4) + 0.4F, static_cast<float>(i / 4) + 0.3F, 1};
        ray.direction = {0, 0, -1};
        const bool solid = (i + i / 4) % 2 == 0;
        const Recorded closest = record(made, 1, &ray, false);
        CHECK(closest.hits[0].t == (solid ? 1.0F : 2.0F));
        CHECK(closest.hits[0].triangle / 2 == (solid ? 0U : 1U));
        ray.t_max = 1.5F;
        const Recorded shadow = record(made, 1, &ray, true);
        CHECK(shadow.occluded == (solid ? 1U : 0U));
        for (const Recorded& got : {closest, shadow})
            CHECK(std::count_if(got.trace.records.begin(), got.trace.records.end(),
                                [](const Record& r) { return r.is_access() && r.region == Bvh2::region_count; }) == 1);
    }
}

TEST_CASE("warp traversal: a constant alpha decides without a texel read, below the cutoff a hole, at it solid") {
    for (const float alpha : {0.0F, 0.49F, 0.5F, 1.0F}) {
        Scene square = quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
        square.materials[0].alpha_mask = true;
        square.materials[0].alpha = alpha;
        const PreparedScene scene(std::move(square), BvhSettings{});
        Ray ray;
        ray.origin = {1, 2, 1};
        ray.direction = {0, 0, -1};
        const Recorded closest = record(scene, 1, &ray, false);
        CHECK(closest.hits[0].found() == (alpha >= 0.5F));
        CHECK(record(scene, 1, &ray, true).occluded == (alpha >= 0.5F ? 1U : 0U));
        for (const Record& r : closest.trace.records) CHECK(r.region != Bvh2::region_count);
    }
}

TEST_CASE("warp traversal: alpha counts only where the material is a mask") {
    Scene square = quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
    square.materials[0].alpha = 0;
    const PreparedScene scene(std::move(square), BvhSettings{});
    Ray ray;
    ray.origin = {1, 2, 1};
    ray.direction = {0, 0, -1};
    CHECK(record(scene, 1, &ray, false).hits[0].found());
}

TEST_CASE("warp traversal: of duplicate triangles the lower index is hit") {
    Scene twice = soup(3000, 0.2F, 15);
    const auto count = static_cast<std::uint32_t>(twice.triangle_count());
    append(twice, Scene(twice));
    const PreparedScene scene(std::move(twice), BvhSettings{});
    const auto rays = warps_of_rays(5000, 16);
    std::uint64_t higher = 0, found = 0;
    for (const Hit& hit : closest_hits(scene, rays)) {
        found += hit.found();
        higher += hit.found() && hit.triangle >= count;
    }
    CHECK(found > 50000);
    CHECK(higher == 0);
}
