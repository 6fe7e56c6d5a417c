// One replay against as many as there are sizes.
#include "cachesim/analysis/lru_surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "cachesim/replay/replay.hpp"
#include "look_up.hpp"
#include "naive_cache.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"
#include "tests/real_data.hpp"
#include "traces/memory_budget.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

Launch some_launch(std::uint64_t seed) {
    return random_launch(
        {region(ObjectKind::node, 0x200000, 64, 64, 300), region(ObjectKind::triangle, 0x800000, 48, 48, 400)}, 40, 60,
        seed);
}

std::vector<WaysCurve> surface_of(const Gpu& gpu, const Launch& launch, std::size_t level,
                                  const std::vector<CacheGeometry>& rows) {
    LruSurface surface(level, rows);
    Replay replay(gpu, launch.regions, 0);
    replay.observe(surface);
    for (const auto& warp : launch.warps) replay.push(warp);
    replay.finish();
    CHECK(surface.bytes() > 0);
    return surface.curves();
}

/// Whether a replay with caches of this size counts what the curve says of so many ways.
bool equals_replay(const WaysCurve& curve, Gpu gpu, const Launch& launch, std::size_t level, CacheGeometry geometry,
                   std::uint64_t ways) {
    geometry.ways = ways;
    gpu.levels[level] = geometry;
    const Counters all = replay(gpu, launch).all();
    return curve.asked == all.levels[level].sectors && curve.hits_of(ways) == all.levels[level].hits &&
           curve.fetched_of(ways) == all.fetched(level, gpu.levels.size());
}

Gpu gpu_with_hashes() {
    Gpu gpu = small_gpu();
    gpu.l1_per_sm = 2;
    gpu.l1().index = SetIndex::xor_fold;
    gpu.levels[1].slices = 3;
    gpu.levels[1].slice_hash = SliceHash::xor_fold;
    gpu.levels[1].sets = 16;
    gpu.levels[1].index = SetIndex::ipoly;
    gpu.levels[1].ways = 2;
    gpu.levels[1].fill_bytes = 64;
    return gpu;
}

Gpu gpu_of_three_levels() {
    Gpu gpu = small_gpu();
    gpu.levels[0].fill_bytes = 64;
    gpu.levels.push_back(gpu.levels[1]);
    gpu.levels[1].sets = 3;
    gpu.levels[2].sets = 5;
    gpu.levels[2].fill_bytes = 128;
    return gpu;
}

}  // namespace

TEST_CASE("a surface from one replay is what separate replays count, at every number of sets and ways") {
    const Gpu gpu = GENERATE(small_gpu(), gpu_with_hashes(), gpu_of_three_levels());
    const Launch launch = some_launch(gpu.levels.size() + gpu.l1_per_sm);
    for (std::size_t level = 0; level < gpu.levels.size(); ++level) {
        const CacheGeometry& own = gpu.levels[level];
        const std::vector<CacheGeometry> rows{own, fully_associative(own), with_sets(own, 1), with_sets(own, 7),
                                              with_sets(own, 16)};
        const auto curves = surface_of(gpu, launch, level, rows);
        REQUIRE(curves.size() == rows.size());
        for (std::size_t r = 0; r < rows.size(); ++r) {
            bool equal = true;
            for (const std::uint64_t ways : {1, 2, 3, 4, 6, 9, 17, 40, 500})
                equal &= equals_replay(curves[r], gpu, launch, level, rows[r], ways);
            INFO("level " << level << ", row " << r);
            CHECK(equal);
            CHECK(curves[r].hits_of(0) == 0);
            CHECK(curves[r].hits_of(500) > curves[r].hits_of(1));
            CHECK(curves[r].hits_of(curves[r].most_useful_ways()) == curves[r].hits_of(100000));
            CHECK(curves[r].hits_of(curves[r].most_useful_ways() - 1) < curves[r].hits_of(100000));
        }
    }
}

TEST_CASE("a surface agrees with the naive cache") {
    struct Recorder final : RequestSink {
        bool wants(std::size_t level, std::uint32_t) const override { return level == 0; }
        void served(std::size_t, std::span<const ServedRequest> batch) override {
            all.insert(all.end(), batch.begin(), batch.end());
        }
        std::vector<ServedRequest> all;
    } recorder;
    const Launch launch = some_launch(5);
    const Gpu gpu = small_gpu();
    const std::vector<CacheGeometry> rows{with_sets(gpu.l1(), 3)};
    LruSurface surface(0, rows);
    Replay replay(gpu, launch.regions, 0);
    replay.observe(recorder);
    replay.observe(surface);
    for (const auto& warp : launch.warps) replay.push(warp);
    replay.finish();
    REQUIRE(recorder.all.size() == surface.look_ups());
    for (const std::uint64_t ways : {1, 2, 5, 30}) {
        CacheGeometry geometry = rows[0];
        geometry.ways = ways;
        std::map<std::uint32_t, NaiveCache> caches;
        std::uint64_t asked = 0, missing = 0;
        for (const ServedRequest& r : recorder.all) {
            std::set<unsigned> sectors;
            for (unsigned s = 0; s < 4; ++s)
                if (r.asked >> s & 1) sectors.insert(s);
            asked += sectors.size();
            auto& cache = caches.try_emplace(r.sm, geometry, r.sm).first->second;
            missing += cache.look_up(r.address / geometry.line_bytes, sectors).missing.size();
        }
        CHECK(surface.curves()[0].asked == asked);
        CHECK(surface.curves()[0].hits_of(ways) == asked - missing);
    }
}

TEST_CASE("a line in a replay has one number, other lines have others") {
    struct Numbers final : RequestSink {
        bool wants(std::size_t, std::uint32_t) const override { return true; }
        void served(std::size_t, std::span<const ServedRequest> batch) override {
            for (const ServedRequest& r : batch) {
                CHECK(numbers.emplace(r.address, r.line).first->second == r.line);
                CHECK(addresses.emplace(r.line, r.address).first->second == r.address);
            }
        }
        std::map<std::uint64_t, std::uint32_t> numbers;
        std::map<std::uint32_t, std::uint64_t> addresses;
    } numbers;
    const Launch launch = some_launch(6);
    Replay replay(small_gpu(), launch.regions, 0);
    replay.observe(numbers);
    for (const auto& warp : launch.warps) replay.push(warp);
    replay.finish();
    CHECK(numbers.numbers.size() > 100);
}

TEST_CASE("surfaces of one look-up, of equal and of distinct look-ups") {
    const CacheGeometry geometry = with_sets(small_gpu().l1(), 2);
    const auto curve_of = [&](const std::vector<std::uint32_t>& lines) {
        LruSurface surface(0, std::span(&geometry, 1));
        for (const std::uint32_t line : lines) {
            const ServedRequest request = served_request(geometry, line, 0b0110);
            surface.served(0, std::span(&request, 1));
        }
        return surface.curves()[0];
    };
    const WaysCurve none = curve_of({}), one = curve_of({7}), equal = curve_of(std::vector<std::uint32_t>(50, 7));
    CHECK(none.asked == 0);
    CHECK(none.hits_of(3) == 0);
    CHECK(one.asked == 2);
    CHECK(one.hits_of(1000) == 0);
    CHECK(one.most_useful_ways() == 0);
    CHECK(equal.hits_of(0) == 0);
    CHECK(equal.hits_of(1) == 98);
    CHECK(equal.most_useful_ways() == 1);
    std::vector<std::uint32_t> cycle;  // ten lines in two sets: all or nothing
    for (std::uint32_t i = 0; i < 100; ++i) cycle.push_back(i % 10);
    CHECK(curve_of(cycle).hits_of(4) == 0);
    CHECK(curve_of(cycle).hits_of(5) == 2 * 90);
    for (std::uint32_t i = 0; i < 100; ++i) cycle[i] = i;
    CHECK(curve_of(cycle).hits_of(1000) == 0);
    CHECK(curve_of(cycle).fetched_of(1000) == 200);
}

TEST_CASE("a surface that takes more memory than an input may is refused in one line") {
    const std::uint64_t before = memory_limit();
    set_memory_limit(1 << 20);
    const CacheGeometry geometry = small_gpu().l1();
    LruSurface surface(0, std::span(&geometry, 1));
    std::vector<ServedRequest> requests(200000);
    for (std::uint32_t i = 0; i < requests.size(); ++i) {
        requests[i].line = i;
        requests[i].address = std::uint64_t{i} * geometry.line_bytes;
        requests[i].asked = 1;
    }
    const auto ask = [&] {
        surface.served(0, std::span(requests).first(100000));
        surface.served(0, std::span(requests).subspan(100000));
    };
    CHECK_THROWS_WITH(ask(), Catch::Contains("at most 1 MiB") && Catch::Contains("--sampled"));
    set_memory_limit(before);
}

TEST_CASE("a way to find a set that works for some numbers of sets gives way to xor_fold for others") {
    CacheGeometry cache;
    cache.sets = 32;
    cache.index = SetIndex::ipoly;
    CHECK(with_sets(cache, 64).index == SetIndex::ipoly);
    CHECK(with_sets(cache, 8).index == SetIndex::xor_fold);
    cache.index = SetIndex::parity;
    cache.index_masks = {1 << 7, 1 << 8};
    CHECK(with_sets(cache, 4).index == SetIndex::parity);
    CHECK(with_sets(cache, 5).index == SetIndex::xor_fold);
    CHECK(with_sets(cache, 5).sets == 5);
}

TEST_CASE("a sampled curve is close to the exact one, and exact in what was asked") {
    CacheGeometry geometry = fully_associative(small_gpu().l1());
    geometry.fill_bytes = GENERATE(0u, 64u);
    LruSurface exact(0, std::span(&geometry, 1)), sampled(0, std::span(&geometry, 1), 0.1);
    std::mt19937 random(4);
    std::vector<ServedRequest> requests(4000);
    for (int call = 0; call < 150; ++call) {
        for (ServedRequest& request : requests) {
            const std::uint32_t range = 1u << (10 + random() % 7);  // some lines often, most hardly ever
            request.line = static_cast<std::uint32_t>(random() % range);
            request.address = std::uint64_t{request.line} * geometry.line_bytes;
            request.asked = 1 + random() % 15;
        }
        exact.served(0, requests);
        sampled.served(0, requests);
    }
    const WaysCurve a = exact.curves()[0], b = sampled.curves()[0];
    CHECK(b.asked == a.asked);
    CHECK(sampled.look_ups() == exact.look_ups());
    CHECK(sampled.lines() < exact.lines() / 8);
    CHECK(sampled.bytes() < exact.bytes() / 3);
    CHECK(b.least_ways() == 2048);
    double sum = 0, fetched = 0;
    int sizes = 0;
    for (std::uint64_t ways = b.least_ways(); ways < a.most_useful_ways(); ways += ways / 4, ++sizes) {
        const auto asked = static_cast<double>(a.asked);
        sum += std::abs(static_cast<double>(a.hits_of(ways)) - static_cast<double>(b.hits_of(ways))) / asked;
        fetched += std::abs(static_cast<double>(a.fetched_of(ways)) - static_cast<double>(b.fetched_of(ways))) / asked;
    }
    REQUIRE(sizes > 10);
    CHECK(sum / sizes < 0.03);  // where lines are alike and 6000 are followed, 0.014
    CHECK(fetched / sizes < 0.04);
}

TEST_CASE("the surface of a real trace is what separate replays count", "[data]") {
    const auto path = raycache::test::reference_trace("hr_cp");
    if (!path) return;
    const Launch launch = read_rtwarp(*path);
    Gpu gpu = load_gpu("rtx-3070");
    gpu.sms = 4;
    for (const std::size_t level : {0, 1}) {
        const CacheGeometry& own = gpu.levels[level];
        const std::vector<CacheGeometry> rows{own, with_sets(own, 16)};
        const auto curves = surface_of(gpu, launch, level, rows);
        for (std::size_t r = 0; r < rows.size(); ++r)
            for (const std::uint64_t ways : {1, 5, 16, 100, 256})
                CHECK(equals_replay(curves[r], gpu, launch, level, rows[r], ways));
    }
}
