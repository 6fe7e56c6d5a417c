#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <utility>
#include <vector>

#include "cachesim/cache/policies/lru_buckets.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"
#include "cachesim/cache/registry.hpp"
#include "look_up.hpp"
#include "oracle.hpp"
#include "traces/error.hpp"

using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

CacheGeometry geometry(std::uint64_t sets, std::uint64_t ways, SetIndex index = SetIndex::modulo) {
    CacheGeometry g;
    g.sets = sets;
    g.ways = ways;
    g.index = index;
    return g;
}

void fills_and_evicts_by_hand(Level&& level) {
    const CacheGeometry g = geometry(1, 2);
    level.count_fills();
    CHECK(look_up(level, g, 0, 0b0011) == 0b0011);  // a miss fetches what is wanted
    CHECK(look_up(level, g, 0, 0b0011) == 0);
    CHECK(look_up(level, g, 0, 0b1110) == 0b1100);  // a sector miss fetches what is missing
    CHECK(look_up(level, g, 0, 0b1111) == 0);
    CHECK(look_up(level, g, 7, 0b0001) == 0b0001);
    CHECK(look_up(level, g, 0, 0b0001) == 0);       // 7 is now the older
    CHECK(look_up(level, g, 9, 0b0001) == 0b0001);  // evicts 7
    CHECK(look_up(level, g, 0, 0b1111) == 0);
    CHECK(look_up(level, g, 7, 0b0001) == 0b0001);  // evicts 9
    CHECK(look_up(level, g, 9, 0b0001) == 0b0001);  // evicts 0 with all its sectors
    CHECK(look_up(level, g, 0, 0b1000) == 0b1000);
    CHECK(look_up(level, g, 0, 0b0001) == 0b0001);
    CHECK(level.fills() == LineFills{6, 2});  // 0 and 7 found an empty way; 9, 7, 9 and 0 did not
}

/// Those of this machine that have vectors.
std::vector<InstructionSet> vector_sets() {
    auto sets = instruction_sets();
    std::erase(sets, InstructionSet::scalar);
    return sets;
}

}  // namespace

TEST_CASE("a tiny cache fills and evicts as computed by hand") {
    fills_and_evicts_by_hand(LevelWith<LruManyWays<std::uint16_t>>(geometry(1, 2), 1));
    fills_and_evicts_by_hand(LevelWith<LruManyWays<std::uint32_t>>(geometry(1, 2), 1));
}

TEST_CASE("a tiny cache fills and evicts as computed by hand, in vectors") {
    for (const InstructionSet instructions : vector_sets()) {
        CAPTURE(name_of(instructions));
        fills_and_evicts_by_hand(std::move(*make_lru_few_ways(geometry(1, 2), 1, instructions)));
        fills_and_evicts_by_hand(std::move(*make_lru_buckets(geometry(1, 2), 1, instructions)));
    }
}

TEST_CASE("caches of a level share nothing") {
    const CacheGeometry g = geometry(2, 2);
    const auto level = make_level(g, 3, 100);
    CHECK(look_up(*level, g, 5, 1, 0) == 1);
    CHECK(look_up(*level, g, 5, 1, 2) == 1);
    CHECK(look_up(*level, g, 5, 1, 2) == 0);
    CHECK(look_up(*level, g, 5, 1, 1) == 1);
}

TEST_CASE("a batch is the same as one look-up after the other") {
    for (const std::uint64_t ways : {5, 100})
        for (const InstructionSet instructions : instruction_sets()) {
            const CacheGeometry g = geometry(3, ways);
            const auto one = make_level(g, 4, 2000, instructions), batch = make_level(g, 4, 2000, instructions);
            std::mt19937 random(3);
            std::vector<std::uint32_t> sets, lines, sectors, expected;
            for (int i = 0; i < 10000; ++i) {
                const std::uint32_t cache = 2 + random() % 2, line = random() % static_cast<unsigned>(8 * ways);
                lines.push_back(line);
                sets.push_back(cache * 3 + line % 3);
                sectors.push_back(1 + random() % 15);
                expected.push_back(look_up(*one, g, line, sectors.back(), cache));
            }
            batch->process(sets.data(), lines.data(), sectors.data(), lines.size());
            CHECK(sectors == expected);
        }
}

TEST_CASE("with the same sets, more ways never miss more under LRU") {
    std::mt19937 random(9);
    std::vector<std::uint32_t> sets, lines, wanted;
    for (int i = 0; i < 20000; ++i) {
        lines.push_back(random() % (random() % 2 ? 40 : 600));
        sets.push_back(lines.back() % 4);
        wanted.push_back(1u << random() % 4);
    }
    std::ptrdiff_t before = 20000;
    for (const std::uint64_t ways : {1, 2, 3, 4, 6, 8, 12, 16, 33, 64, 65, 128, 300}) {
        std::vector<std::uint32_t> fetched = wanted;
        make_level(geometry(4, ways), 1, 600)->process(sets.data(), lines.data(), fetched.data(), lines.size());
        const auto missed = std::count_if(fetched.begin(), fetched.end(), [](std::uint32_t f) { return f != 0; });
        CAPTURE(ways);
        CHECK(missed <= before);
        before = missed;
    }
}

/// By lists: the look-ups of a set, newest first.
std::uint32_t naive_lru(std::vector<std::pair<std::uint32_t, std::uint32_t>>& set, std::size_t ways, std::uint32_t line,
                        std::uint32_t wanted) {
    std::uint32_t present = 0;
    const auto at = std::find_if(set.begin(), set.end(), [&](const auto& l) { return l.first == line; });
    if (at != set.end()) {
        present = at->second;
        set.erase(at);
    } else if (set.size() == ways) {
        set.pop_back();
    }
    set.insert(set.begin(), {line, present | wanted});
    return wanted & ~present;
}

TEST_CASE("a cache of many ways forgets what was used least recently, over more look-ups than its clock counts",
          "[slow]") {
    const CacheGeometry g = geometry(2, 70);
    const auto level = make_lru_buckets(g, 1, vector_sets().back());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> naive[2];
    std::mt19937 random(5);
    std::vector<std::uint32_t> sets(1 << 16), lines(sets.size()), sectors(sets.size()), expected(sets.size());
    for (int batch = 0; batch < 300; ++batch) {  // 2^24 look-ups, and then some
        for (std::size_t i = 0; i < sets.size(); ++i) {
            // One set is asked seldom, so its lines grow old.
            lines[i] = random() % 64 == 0 ? 2 * (random() % 80) + 1 : 2 * (random() % 90);
            sets[i] = lines[i] % 2;
            sectors[i] = 1 + random() % 15;
            expected[i] = naive_lru(naive[sets[i]], 70, lines[i], sectors[i]);
        }
        level->process(sets.data(), lines.data(), sectors.data(), sets.size());
        REQUIRE(sectors == expected);
    }
}

TEST_CASE("an unknown replacement policy is refused by name") {
    CacheGeometry g = geometry(1, 1);
    g.policy = "clairvoyant";
    CHECK_THROWS_WITH(make_level(g, 1, 1), Catch::Contains("lru") && Catch::Contains("clairvoyant"));
}
