// Miss classes, sharing, BVH depth and pixels: computed by hand for small launches, and held against the replay's own
// counts for random ones.
#include "cachesim/analysis/explainer.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "cachesim/cache/registry.hpp"
#include "cachesim/replay/replay.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

/// One line each: 128 bytes.
const std::vector<traces::Region> lines{region(ObjectKind::node, 0x200000, 128, 128, 1000)};

struct Explained {
    Findings findings;
    LaunchStatistics statistics;
    PixelCosts costs;
};

Explained explain(const Gpu& gpu, const Launch& launch, const LanePixels* pixels = nullptr) {
    const ElementDepth depth(launch.regions);
    Explainer explainer(gpu, launch.regions, depth, pixels);
    Replay replay(gpu, launch.regions, 0);
    replay.observe(explainer);
    for (const auto& warp : launch.warps) replay.push(warp);
    Explained done;
    done.statistics = replay.finish();
    done.findings = explainer.findings();
    done.costs = explainer.pixel_costs();
    return done;
}

/// A warp whose lane 0 reads these elements of region 0, one after the other.
std::shared_ptr<traces::WarpTrace> walk(std::uint32_t number, const std::vector<std::uint32_t>& elements) {
    auto warp = std::make_shared<traces::WarpTrace>();
    warp->warp = number;
    for (const std::uint32_t e : elements) {
        warp->records.push_back({1u, 0, traces::RayType::camera, 0, 0});
        warp->elements.push_back(e);
    }
    return warp;
}

/// One SM, one warp after the other; L1 of sets x ways lines, and a large L2 of one set.
Gpu one_sm(std::uint64_t sets, std::uint64_t ways) {
    Gpu gpu = small_gpu();
    gpu.sms = 1;
    gpu.warps_per_sm = gpu.warps_per_cta = 1;
    gpu.levels[0].sets = sets;
    gpu.levels[0].ways = ways;
    gpu.levels[1].sets = 1;
    gpu.levels[1].ways = 4096;
    return gpu;
}

MissCounts counts(std::uint64_t lookups, std::uint64_t compulsory, std::uint64_t capacity, std::uint64_t conflict,
                  std::uint64_t lucky) {
    return {4 * lookups, 4 * compulsory, 4 * capacity, 4 * conflict, 4 * lucky};  // four sectors a line
}

/// A root with the leaf of triangles 0 and 1, and with node 1, which has the leaves of triangle 2 and of triangle 3.
std::vector<traces::Region> small_tree() {
    std::vector<traces::Region> regions{region(ObjectKind::node, 0x200000, 64, 64, 3),
                                        region(ObjectKind::triangle, 0x400000, 48, 48, 4),
                                        region(ObjectKind::texel, 0x600000, 4, 4, 100)};
    const auto triangle = [](std::uint32_t e) { return 1u << 30 | e; };
    regions[0].degree = 2;
    regions[0].links = {triangle(0), 1, triangle(2), triangle(3), traces::no_link, traces::no_link};
    return regions;
}

const std::vector<traces::Region> mixed{region(ObjectKind::node, 0x7f5000000000, 64, 64, 300),
                                        region(ObjectKind::triangle, 0x7f5000200000, 48, 48, 200),
                                        region(ObjectKind::texel, 0x10000000000, 4, 4, 3000)};

}  // namespace

TEST_CASE("misses are classed as computed by hand") {
    // Two sets of one way: even lines share a set, odd lines share the other. The shadow has two lines.
    //   0, 2        compulsory; the shadow holds 0, 2
    //   0           conflict: the shadow has it
    //   1           compulsory; the shadow drops 2
    //   2           capacity; the shadow drops 0
    //   1           hit in both
    //   3           compulsory; the shadow drops 2
    //   2           a lucky hit: set 0 still holds it. The shadow drops 1
    const Explained e = explain(one_sm(2, 1), {lines, {walk(0, {0, 2, 0, 1, 2, 1, 3, 2})}});
    CHECK(e.findings.levels[0].all() == counts(8, 4, 1, 1, 1));
    CHECK(e.findings.levels[1].all() == counts(6, 4, 0, 0, 0));
}

TEST_CASE("what one L1 has held is still compulsory to another") {
    Gpu gpu = one_sm(1, 4);
    gpu.sms = 2;
    const Explained e = explain(gpu, {lines, {walk(0, {5}), walk(1, {5})}});
    CHECK(e.findings.levels[0].all() == counts(2, 2, 0, 0, 0));
    CHECK(e.findings.levels[1].all() == counts(2, 1, 0, 0, 0));
}

TEST_CASE("the classes add up to the misses of the replay in every cut") {
    const auto policy = GENERATE(from_range(cache_policies()));
    Gpu gpu = small_gpu();
    gpu.l1_per_sm = 2;
    gpu.levels[0].policy = gpu.levels[1].policy = policy;
    const Launch launch = random_launch(mixed, 60, 300, 11);
    const Explained e = explain(gpu, launch);
    const Counters all = e.statistics.all();
    const LevelFindings &l1 = e.findings.levels[0], &l2 = e.findings.levels[1];
    CHECK(l1.all().lookups == all.levels[0].sectors);
    CHECK(l1.all().misses() == all.levels[1].sectors);
    CHECK(l2.all().lookups == all.levels[1].sectors);
    CHECK(l2.all().misses() == all.dram_sectors);
    CHECK(l2.all().compulsory == all.dram_first_sectors);
    CHECK(e.findings.sharing.hits() == all.levels[0].hits);
    CHECK(l1.all().conflict > 0);
    CHECK(l1.all().lucky_hits > 0);
    for (const RayGroup& group : e.statistics.groups) {
        const std::size_t place = LevelFindings::place(group.ray, group.bounce);
        CHECK(l1.by_ray(place).lookups == group.all().levels[0].sectors);
        CHECK(l1.by_ray(place).misses() == group.all().levels[1].sectors);
        CHECK(l2.by_ray(place).misses() == group.all().dram_sectors);
    }
    for (unsigned kind = 0; kind < traces::object_kinds; ++kind) {
        std::uint64_t misses = 0;
        for (const RayGroup& group : e.statistics.groups) misses += group.by_kind[kind].dram_sectors;
        CHECK(l2.by_kind(static_cast<traces::ObjectKind>(kind)).misses() == misses);
    }
}

TEST_CASE("a fully associative LRU cache has no conflict misses and no lucky hits") {
    Gpu gpu = small_gpu();
    gpu.levels[0].sets = gpu.levels[1].sets = 1;
    gpu.levels[0].ways = 11;
    gpu.levels[1].ways = 40;
    const Explained e = explain(gpu, random_launch(mixed, 60, 300, 12));
    for (const LevelFindings& level : e.findings.levels) {
        CHECK(level.all().conflict == 0);
        CHECK(level.all().lucky_hits == 0);
        CHECK(level.all().capacity > 0);
    }
}

TEST_CASE("a hit is owed to the warp that fetched the sector last") {
    // CTAs of two warps, one SM with room for one CTA: warps 0 and 1 take turns, then 2 and 3.
    Gpu gpu = one_sm(1, 2);
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    //   warp 0: 5   5      6      warp 1:  5   5      7          then warp 2: 7   7
    //   in turn: 5 fetched by 0; 1 finds it (same CTA); 0 finds it (same warp); 1 again (same CTA); 6 fetched by 0;
    //   7 fetched by 1, dropping 5; warp 2 finds 7 twice (another CTA).
    const Explained e = explain(gpu, {lines, {walk(0, {5, 5, 6}), walk(1, {5, 5, 7}), walk(2, {7, 7}), walk(3, {})}});
    CHECK(e.findings.sharing == Sharing{4, 8, 8});
}

TEST_CASE("a sector that is fetched again belongs to the warp that fetched it again") {
    Gpu gpu = one_sm(1, 1);
    // One line of L1: warp 1 fetches 5 anew after 6, and finds its own.
    const Explained e = explain(gpu, {lines, {walk(0, {5, 6}), walk(1, {5, 5})}});
    CHECK(e.findings.sharing == Sharing{4, 0, 0});
}

TEST_CASE("depth counts links from the root, and the triangles of a leaf are as deep as its first") {
    const ElementDepth depth(small_tree());
    REQUIRE(depth.known());
    CHECK(depth(0, 0) == 0);
    CHECK(depth(0, 1) == 1);
    CHECK(depth(0, 2) == ElementDepth::none);
    CHECK(depth(1, 0) == 1);
    CHECK(depth(1, 1) == 1);
    CHECK(depth(1, 2) == 2);
    CHECK(depth(1, 3) == 2);
    CHECK(depth(2, 7) == ElementDepth::none);
    CHECK_FALSE(ElementDepth(lines).known());
    CHECK(ElementDepth(lines)(0, 0) == ElementDepth::none);
}

TEST_CASE("depth stops counting in a very deep tree") {
    std::vector<traces::Region> chain{region(ObjectKind::node, 0x200000, 64, 64, 400)};
    chain[0].degree = 1;
    for (std::uint32_t i = 1; i < 400; ++i) chain[0].links.push_back(i);
    chain[0].links.push_back(0);
    const ElementDepth depth(chain);
    CHECK(depth(0, 253) == 253);
    CHECK(depth(0, 399) == ElementDepth::deepest);
}

TEST_CASE("misses are charged to the depth of the object that was read") {
    auto warp = std::make_shared<traces::WarpTrace>();
    // Nodes 0 and 1 share a line, two sectors each. Triangle 1, bytes 48 to 95, lies in sectors 1 and 2.
    warp->records = {{3u, 0, traces::RayType::camera, 0, 0},
                     {1u, 1, traces::RayType::camera, 0, 0},
                     {1u, 2, traces::RayType::camera, 0, 0}};
    warp->elements = {0, 1, 1, 50};
    const Explained e = explain(one_sm(4, 4), {small_tree(), {warp}});
    const LevelFindings& l1 = e.findings.levels[0];
    CHECK(l1.by_depth[0] == MissCounts{2, 2, 0, 0, 0});
    CHECK(l1.by_depth[1] == MissCounts{4, 4, 0, 0, 0});
    CHECK(l1.by_kind(traces::ObjectKind{2}) == MissCounts{1, 1, 0, 0, 0});
}

TEST_CASE("after work without end, a first touch in a full cache is a capacity miss and no compulsory one") {
    const Gpu gpu = one_sm(4, 4);
    const ElementDepth depth(lines);
    std::vector<std::uint32_t> all(40);
    std::iota(all.begin(), all.end(), 0U);
    Replay replay(gpu, lines, 0);
    Explainer explainer(gpu, lines, depth, nullptr, History::endless);
    replay.observe(explainer);
    replay.push(walk(0, all));
    replay.finish();
    const Findings& found = explainer.findings();
    constexpr std::uint64_t sectors = 4;  // of a line; L1 has 16 lines
    CHECK(found.levels[0].all() == MissCounts{40 * sectors, 16 * sectors, 24 * sectors, 0, 0});
    CHECK(found.levels[1].all() == MissCounts{40 * sectors, 40 * sectors, 0, 0, 0});
}

TEST_CASE("costs go in equal parts to the pixels of the lanes that asked for a sector") {
    LanePixels pixels{2, 2, std::vector<std::uint32_t>(32, LanePixels::no_pixel)};
    for (std::uint32_t lane = 0; lane < 4; ++lane) pixels.of_lane[lane] = lane;
    auto warp = std::make_shared<traces::WarpTrace>();
    // Lanes 0, 1 and 3 read node 0, lane 2 reads node 1; then lane 0 reads node 0 again.
    warp->records = {{0xfu, 0, traces::RayType::camera, 0, 0}, {1u, 0, traces::RayType::camera, 0, 0}};
    warp->elements = {0, 0, 1, 0, 0};
    const Explained e = explain(one_sm(4, 4), {small_tree(), {warp}}, &pixels);
    constexpr std::uint64_t whole = PixelCosts::parts;
    const auto& p = e.costs.pixels();
    REQUIRE(p.size() == 4);
    const std::uint64_t third = whole / 3;  // the first lane gets what is left over
    CHECK(p[0] == PixelCost{2 * (third + 1) + 2 * whole, 2 * (third + 1), 2 * (third + 1), 2, 5});
    CHECK(p[1] == PixelCost{2 * third, 2 * third, 2 * third, 1, 4});
    CHECK(p[2] == PixelCost{2 * whole, 2 * whole, 2 * whole, 1, 4});
    CHECK(p[3] == p[1]);
}

TEST_CASE("the pixels of a launch add up to its counts") {
    const Launch launch = random_launch(mixed, 40, 200, 13);
    LanePixels pixels{32, 40, std::vector<std::uint32_t>(32 * 40)};
    for (std::uint32_t i = 0; i < pixels.of_lane.size(); ++i) pixels.of_lane[i] = i;
    const Explained e = explain(small_gpu(), launch, &pixels);
    PixelCost sum;
    for (const PixelCost& p : e.costs.pixels()) {
        sum.l1_parts += p.l1_parts;
        sum.l2_parts += p.l2_parts;
        sum.dram_parts += p.dram_parts;
        sum.accesses += p.accesses;
    }
    const Counters all = e.statistics.all();
    CHECK(sum.l1_parts == all.levels[0].sectors * PixelCosts::parts);
    CHECK(sum.l2_parts == all.levels[1].sectors * PixelCosts::parts);
    CHECK(sum.dram_parts == all.dram_sectors * PixelCosts::parts);
    CHECK(sum.accesses == all.lane_accesses);
    PixelCosts twice;
    twice += e.costs;
    twice += e.costs;
    CHECK(twice.pixels()[7].l1_parts == 2 * e.costs.pixels()[7].l1_parts);
}
