// What holds of every layout in the list, what a layout may differ in, and how the list is asked.
#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <map>

#include "embree_comparison.hpp"
#include "tests/traces/files.hpp"
#include "tracer/bvh/layouts/node_order.hpp"
#include "tracer/capture.hpp"
#include "tracer/simt/warp_traversal.hpp"
#include "traces/error.hpp"
#include "traces/read_launch.hpp"
#include "traces/reader.hpp"
#include "traces/writer.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;
using Catch::Matchers::Contains;

namespace {

const Box cube{{-1.2F, -1.2F, -1.2F}, {1.2F, 1.2F, 1.2F}};

Scene lit_soup() {
    Scene scene = soup(2000, 0.3F, 1);
    scene.sun = Sun{{0, 1, 0}, {1, 1, 1}};
    scene.cameras[0] = {"front", {0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 45};
    return scene;
}

CaptureSettings picture() {
    CaptureSettings settings;
    settings.width = 48;
    settings.height = 32;
    settings.trace_samples = 2;
    settings.strategy.samples.spp = 16;
    return settings;
}

void check(const Comparison& result) {
    INFO(result.text());
    CHECK(result.ours_wrong == 0);
    CHECK(result.embree_wrong == 0);
    CHECK(result.rays == 20000);
}

traces::WarpTrace walk(Traversal& traversal, WarpRecorder& recorder, const Ray* rays, Hit* hits) {
    recorder.clear();
    traversal.closest(~0U, traces::RayType::bounce, 1, rays, hits);
    traversal.occluded(~0U, traces::RayType::shadow, 1, rays);
    traces::WarpTrace trace;
    recorder.store(trace);
    return trace;
}

bool equal(const Hit& a, const Hit& b) { return a.triangle == b.triangle && a.t == b.t && a.u == b.u && a.v == b.v; }

/// A bvh2 whose nodes lie in two regions, of which a visit reads one element each.
struct HalvedBvh2 final : BvhLayout {
    explicit HalvedBvh2(const Bvh2& whole) : bvh(whole) {}
    static constexpr std::uint8_t region_count = 3;
    static constexpr std::array<std::uint8_t, 2> node_reads{0, 2};
    static constexpr std::array<std::uint8_t, 1> triangle_reads{1};
    std::vector<traces::Region> regions() const override {
        std::vector<traces::Region> all = bvh.regions();
        all[0].element_size = all[0].stride = 32;
        all.push_back(all[0]);
        all[2].base += std::uint64_t{1} << 36;
        all[2].degree = 0;
        all[2].links.clear();
        return all;
    }
    bool symbols_known() const override { return false; }
    using View = Bvh2View;
    using Lane = Bvh2Lane;
    View view() const { return bvh.view(); }
    std::size_t stack_entries() const { return bvh.stack_entries(); }
    const Bvh2& bvh;
};

}  // namespace

TEST_CASE("layouts: hits in every one are those of bvh2 bit by bit, and Embree's") {
    const PreparedScene bvh2 = with_holes(lit_soup());
    const EmbreeScene embree(bvh2.scene(), bvh2.texels());
    const auto rays = random_rays(cube, 20000, 2);
    const auto expected = closest_hits(bvh2, rays);
    const auto expected_any = any_hits(bvh2, rays);
    std::size_t found = 0;
    for (const BvhLayoutEntry& entry : bvh_layouts()) {
        INFO(entry.name);
        const PreparedScene scene = with_holes(lit_soup(), {}, entry.name);
        const auto hits = closest_hits(scene, rays);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            differ += !equal(hits[i], expected[i]);
            found += hits[i].found();
        }
        CHECK(differ == 0);
        CHECK(any_hits(scene, rays) == expected_any);
        check(compare_closest(scene, embree, rays, bvh2));
        check(compare_any(scene, embree, rays, bvh2));
    }
    CHECK(found > 5000 * bvh_layouts().size());
}

TEST_CASE("layouts: a trace in every one names it, holds what was traced, and is the same on any number of threads") {
    const TemporaryFolder folder;
    for (const BvhLayoutEntry& entry : bvh_layouts()) {
        INFO(entry.name);
        const PreparedScene scene = with_holes(lit_soup(), {}, entry.name);
        const Capture capture(scene, picture());
        CHECK(capture.header().provenance.layout == entry.name);
        for (const int threads : {1, 3}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(threads));
            write_capture(capture, folder / std::to_string(threads), {});
        }
        CHECK(read_file(folder / "1") == read_file(folder / "3"));
        traces::Reader reader(folder / "1");
        CHECK(reader.header() == capture.header());
        const auto worker = capture.make_worker();
        std::uint32_t warps = 0;
        for (std::uint32_t launch = 0; launch < capture.header().launches.size(); ++launch)
            traces::read_launch(reader, launch, [&](traces::WarpTrace&& read) {
                traces::WarpTrace traced;
                capture.trace_warp(*worker, launch, read.warp, traced);
                CHECK(traced == read);
                ++warps;
            });
        CHECK(warps == 2 * capture.header().warps_per_launch);
    }
}

TEST_CASE("layouts: bvh2-breadth-first keeps nodes level by level, and what is visited is what bvh2 visits") {
    const PreparedScene one(lit_soup(), {}), other(lit_soup(), {}, "bvh2-breadth-first");
    const Bvh2 &a = bvh2_of(one), &b = bvh2_of(other);
    REQUIRE(a.nodes.size() == b.nodes.size());
    std::vector<unsigned> level(b.nodes.size());
    for (std::size_t i = 0; i < b.nodes.size(); ++i) {
        for (const std::uint32_t child : b.nodes[i].child)
            if (!ChildRef::is_leaf(child)) {
                REQUIRE(child > i);
                level[child] = level[i] + 1;
            }
    }
    CHECK(std::is_sorted(level.begin(), level.end()));
    CHECK(level.back() > 5);

    WarpRecorder recorder;
    const auto in_one = make_traversal(one, recorder), in_other = make_traversal(other, recorder);
    std::map<std::uint32_t, std::uint32_t> twin;  // of a node
    const auto rays = random_rays(cube, 3200, 4);
    for (std::size_t first = 0; first < rays.size(); first += 32) {
        Hit hits[32];
        const traces::WarpTrace x = walk(*in_one, recorder, &rays[first], hits);
        const traces::WarpTrace y = walk(*in_other, recorder, &rays[first], hits);
        REQUIRE(x.records == y.records);
        std::size_t e = 0;
        for (const traces::Record& r : x.records)
            for (unsigned i = 0; r.is_access() && i < r.lanes(); ++i, ++e) {
                if (r.region == Bvh2::triangle_region)
                    REQUIRE(x.elements[e] == y.elements[e]);
                else
                    REQUIRE(twin.emplace(x.elements[e], y.elements[e]).first->second == y.elements[e]);
            }
    }
    std::size_t moved = 0;
    for (const auto& [from, to] : twin) {
        moved += from != to;
        CHECK(std::memcmp(&a.nodes[from], &b.nodes[to], sizeof(Bvh2Node::x) * 3) == 0);
    }
    CHECK(moved > twin.size() / 2);
}

TEST_CASE("layouts: orders hold every inner node once, the root first; a tree that is a leaf has none") {
    const Bvh bvh = build_bvh(lit_soup());
    for (const auto& order : {depth_first(bvh), breadth_first(bvh), van_emde_boas(bvh), treelets(bvh)}) {
        CHECK(order.front() == 0);
        std::vector<std::uint32_t> sorted = order;
        std::sort(sorted.begin(), sorted.end());
        CHECK(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
        CHECK(sorted.size() == (bvh.nodes.size() - 1) / 2);
        CHECK(std::none_of(sorted.begin(), sorted.end(), [&](std::uint32_t i) { return bvh.nodes[i].is_leaf(); }));
    }
    Bvh leaf;
    leaf.nodes.push_back({{}, 0, 1});
    CHECK(depth_first(leaf).empty());
    CHECK(breadth_first(leaf).empty());
    CHECK(van_emde_boas(leaf).empty());
    CHECK(treelets(leaf).empty());
}

TEST_CASE("layouts: one that keeps its nodes in two regions has both read, one behind the other, and textures behind") {
    const PreparedScene scene = with_holes(lit_soup());
    const HalvedBvh2 halves(bvh2_of(scene));
    WarpRecorder recorder;
    const auto whole = make_traversal(scene, recorder);
    WarpTraversal<HalvedBvh2, WarpRecorder> halved(scene.scene(), halves, scene.texels(), recorder);
    traces::Header header = Capture(scene, picture()).header();
    traces::Region texels = header.regions.back();
    header.regions = halves.regions();
    header.regions.push_back(texels);
    header.launches = {0};
    const auto rays = random_rays(cube, 640, 5);
    std::vector<traces::WarpTrace> warps;
    std::size_t nodes = 0, holes = 0;
    for (std::size_t first = 0; first < rays.size(); first += 32) {
        Hit hits[32], same[32];
        const traces::WarpTrace x = walk(*whole, recorder, &rays[first], hits);
        const traces::WarpTrace y = walk(halved, recorder, &rays[first], same);
        for (int l = 0; l < 32; ++l) REQUIRE(equal(hits[l], same[l]));
        traces::WarpTrace expected;
        const std::uint32_t* element = x.elements.data();
        for (traces::Record r : x.records) {
            const unsigned count = r.is_access() ? r.lanes() : 0;
            const bool node = r.region == Bvh2::node_region;
            if (r.region == Bvh2::region_count) {
                r.region = HalvedBvh2::region_count;
                ++holes;
            }
            for (int part = 0; part <= (node ? 1 : 0); ++part) {
                if (part == 1) r.region = 2;
                expected.records.push_back(r);
                expected.elements.insert(expected.elements.end(), element, element + count);
            }
            element += count;
            nodes += node;
        }
        REQUIRE(y.records == expected.records);
        REQUIRE(y.elements == expected.elements);
        warps.push_back(y);
        warps.back().warp = static_cast<std::uint32_t>(warps.size() - 1);
    }
    CHECK(nodes > 500);
    CHECK(holes > 50);
    header.warps_per_launch = static_cast<std::uint32_t>(warps.size());
    const TemporaryFolder folder;
    traces::Writer writer(folder / "halves.rct", header);
    writer.append(traces::encode_block(header, warps));
    writer.finish();
    std::vector<traces::WarpTrace> read;
    traces::Reader(folder / "halves.rct").read_block(0, read);
    CHECK(read == warps);
}

TEST_CASE("layouts: an unknown name is answered with the valid ones and the closest") {
    for (const BvhLayoutEntry& entry : bvh_layouts())
        CHECK_THROWS_WITH(bvh_layout_entry("bvh3"), Contains("'bvh3'") && Contains(entry.name));
    CHECK_THROWS_AS(bvh_layout_entry("bvh3"), UsageError);
    CHECK_THROWS_WITH(PreparedScene(lit_soup(), {}, "bvh2-breadth-frist"),
                      Contains("did you mean 'bvh2-breadth-first'?"));
    CHECK(bvh_layout_entry(default_layout).name == default_layout);
}
