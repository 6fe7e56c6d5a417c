// Other policies, and the optimum, beside a replay.
#include "cachesim/analysis/policy_caches.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "cachesim/analysis/belady.hpp"
#include "cachesim/cache/registry.hpp"
#include "cachesim/replay/replay.hpp"
#include "look_up.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

PolicyCounts counts_at(const LaunchStatistics& launch, const Gpu& gpu, std::size_t level) {
    const Counters all = launch.all();
    return {all.levels[level].sectors, all.levels[level].hits, all.fetched(level, gpu.levels.size())};
}

/// The fewest line misses of a cache of one set, trying every choice of what to evict.
unsigned fewest_misses(const std::vector<std::uint32_t>& lines, std::size_t at, std::vector<std::uint32_t> held,
                       std::size_t ways) {
    for (; at < lines.size(); ++at) {
        if (std::find(held.begin(), held.end(), lines[at]) != held.end()) continue;
        if (held.size() < ways) {
            held.push_back(lines[at]);
            return 1 + fewest_misses(lines, at + 1, held, ways);
        }
        unsigned best = ~0u;
        for (std::uint32_t& victim : held) {
            const std::uint32_t gone = std::exchange(victim, lines[at]);
            best = std::min(best, 1 + fewest_misses(lines, at + 1, held, ways));
            victim = gone;
        }
        return best;
    }
    return 0;
}

}  // namespace

TEST_CASE("caches of every policy beside a replay count what a replay with them does") {
    const Launch launch = random_launch(
        {region(ObjectKind::node, 0x200000, 64, 64, 300), region(ObjectKind::triangle, 0x800000, 48, 48, 400)}, 40, 60,
        9);
    Gpu gpu = small_gpu();
    gpu.l1_per_sm = 2;
    gpu.levels[1].slices = 3;
    gpu.levels[1].fill_bytes = 64;
    for (const std::size_t level : {0, 1}) {
        std::vector<CacheGeometry> geometries;
        for (const std::string& policy : cache_policies())
            for (const std::uint64_t ways : {1, 3, 8}) {
                geometries.push_back(gpu.levels[level]);
                geometries.back().policy = policy;
                geometries.back().ways = ways;
            }
        PolicyCaches caches(gpu, launch.regions, level, geometries);
        BeladyCaches belady(level);
        Replay replay(gpu, launch.regions, 0);
        replay.observe(caches);
        replay.observe(belady);
        for (const auto& warp : launch.warps) replay.push(warp);
        replay.finish();
        for (std::size_t i = 0; i < geometries.size(); ++i) {
            Gpu other = gpu;
            other.levels[level] = geometries[i];
            INFO(geometries[i].policy << ", " << geometries[i].ways << " ways, level " << level);
            CHECK(caches.counts()[i] == counts_at(raycache::cachesim::test::replay(other, launch), gpu, level));
            CHECK(belady.counts(geometries[i]).asked == caches.counts()[i].asked);
        }
    }
}

TEST_CASE("Belady's optimum has the fewest line misses that any choice of victims has") {
    std::mt19937 random(3);
    for (int round = 0; round < 40; ++round) {
        std::vector<std::uint32_t> lines(14);
        for (std::uint32_t& line : lines) line = random() % 5;
        const std::uint64_t ways = 2 + random() % 2;
        CacheGeometry geometry;
        geometry.sets = 1;
        geometry.ways = ways;
        BeladyCaches belady(0);
        for (const std::uint32_t line : lines) {
            const ServedRequest request = served_request(geometry, line, 1);
            belady.served(0, std::span(&request, 1));
        }
        const PolicyCounts counts = belady.counts(geometry);
        CHECK(counts.asked - counts.hits == fewest_misses(lines, 0, {}, ways));
        CHECK(counts.fetched == counts.asked - counts.hits);
    }
}

TEST_CASE("Belady's optimum keeps sectors as other policies do") {
    CacheGeometry geometry;
    geometry.sets = 1;
    geometry.ways = 2;
    geometry.fill_bytes = 64;
    BeladyCaches belady(0);
    const std::pair<std::uint32_t, std::uint32_t> asked[] = {{0, 0b0001}, {0, 0b0010}, {0, 0b0110}, {1, 0b1111},
                                                             {2, 0b0001}, {0, 0b0100}, {1, 0b1000}};
    for (const auto& [line, sectors] : asked) {
        ServedRequest request;
        request.address = std::uint64_t{line} * geometry.line_bytes;
        request.line = line;
        request.asked = sectors;
        belady.served(0, std::span(&request, 1));
    }
    // Line 0: sectors 0, 1 at once, 1 hits, then 2, 3; line 1: all; line 2 takes the place of line 1.
    CHECK(belady.counts(geometry) == PolicyCounts{11, 3, 2 + 2 + 4 + 2 + 2});
}
