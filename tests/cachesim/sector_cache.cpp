#include "cachesim/replay/timed/sector_cache.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "cachesim/cache/registry.hpp"
#include "cachesim/replay/timed/timed_cache.hpp"

using namespace raycache::cachesim;

namespace {

/// As SectorCache says it for lru and fifo: lines of one set, the one that goes first in front.
struct NaiveSet {
    struct Line {
        std::uint32_t id;
        bool pending;
    };
    std::vector<Line> lines;

    auto find(std::uint32_t id) {
        return std::find_if(lines.begin(), lines.end(), [&](const Line& line) { return line.id == id; });
    }
};

}  // namespace

TEST_CASE("the line that goes is the oldest without a sector on its way, in few ways and in many") {
    for (const auto policy : {SectorCache::Policy::lru, SectorCache::Policy::fifo}) {
        for (const std::uint64_t ways : {1u, 3u, 16u, 100u, 256u}) {
            constexpr std::uint64_t sets = 3;
            SectorCache cache(sets, ways, policy);
            std::vector<NaiveSet> naive(sets);
            std::mt19937 random(static_cast<unsigned>(ways));
            const auto ids = static_cast<std::uint32_t>(4 * sets * ways);
            for (int step = 0; step < 20'000; ++step) {
                const std::uint32_t id = random() % ids;
                NaiveSet& set = naive[id % sets];
                const auto at = set.find(id);
                const std::uint32_t entry = cache.find(id);
                REQUIRE((entry != SectorCache::none) == (at != set.lines.end()));
                if (at != set.lines.end()) {
                    if (random() % 3 == 0) {  // its sector arrives, or sets off
                        at->pending = !at->pending;
                        cache[entry].pending = at->pending;
                    } else {
                        cache.use(entry);
                        if (policy == SectorCache::Policy::lru) std::rotate(at, at + 1, set.lines.end());
                    }
                    continue;
                }
                const std::uint32_t taken = cache.replace(id % sets, id);
                if (set.lines.size() == ways) {
                    const auto victim = std::find_if(set.lines.begin(), set.lines.end(),
                                                     [](const NaiveSet::Line& line) { return !line.pending; });
                    REQUIRE((taken == SectorCache::none) == (victim == set.lines.end()));
                    if (victim == set.lines.end()) continue;
                    REQUIRE(cache.find(victim->id) == SectorCache::none);
                    set.lines.erase(victim);
                }
                REQUIRE(cache[taken].id == id);
                REQUIRE(cache[taken].present == 0);
                set.lines.push_back({id, false});
            }
        }
    }
}

TEST_CASE("under other policies a line on its way stays, and another goes in its place") {
    for (const char* policy : {"random", "tree_plru"}) {
        CacheGeometry g;
        g.policy = policy;
        g.sets = 1;
        g.ways = 4;
        SectorCache cache(1, 4, SectorCache::Policy::ordered, make_victim_order(g, 0));
        for (std::uint32_t id = 0; id < 4; ++id) cache[cache.replace(0, id)].pending = id == 2 ? 0 : 1;
        for (std::uint32_t id = 10; id < 50; ++id) {
            REQUIRE(cache.replace(0, id) != SectorCache::none);
            for (const std::uint32_t stays : {0u, 1u, 3u}) REQUIRE(cache.find(stays) != SectorCache::none);
        }
        cache[cache.find(49)].pending = 1;
        CHECK(cache.replace(0, 99) == SectorCache::none);
    }
}
