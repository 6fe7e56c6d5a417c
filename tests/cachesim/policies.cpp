#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "cachesim/cache/policies/fifo.hpp"
#include "cachesim/cache/policies/random.hpp"
#include "cachesim/cache/policies/tree_plru.hpp"
#include "cachesim/cache/registry.hpp"
#include "look_up.hpp"
#include "naive_cache.hpp"

using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

CacheGeometry geometry(const std::string& policy, std::uint64_t sets, std::uint64_t ways) {
    CacheGeometry g;
    g.policy = policy;
    g.sets = sets;
    g.ways = ways;
    return g;
}

/// 'h' or 'm' for each line that is read.
std::string outcomes(const CacheGeometry& g, const std::vector<std::uint64_t>& read) {
    const auto level = make_level(g, 1, 100);
    std::string all;
    for (const std::uint64_t line : read) all += look_up(*level, g, static_cast<std::uint32_t>(line), 1) ? 'm' : 'h';
    return all;
}

/// Victims of a set that is used where it evicts.
template <class Order>
std::vector<std::uint64_t> victims(Order& order, std::uint64_t set, int count) {
    std::vector<std::uint64_t> all;
    for (int i = 0; i < count; ++i) {
        all.push_back(order.victim(set));
        order.use(set, all.back());
    }
    return all;
}

using Ways = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE("first in, first out, however often it was used") {
    // 0 1 fill; 0 hits; 2 takes the place of 0; 1 hits; 0 takes that of 1; 2 hits; 1 takes that of 2; 0 hits.
    CHECK(outcomes(geometry("fifo", 1, 2), {0, 1, 0, 2, 1, 0, 2, 1, 0}) == "mmhmhmhmh");
    CHECK(outcomes(geometry("lru", 1, 2), {0, 1, 0, 2, 1, 0, 2, 1, 0}) == "mmhmmmmmm");
}

TEST_CASE("a sector that comes later makes no line younger under first in, first out") {
    const CacheGeometry g = geometry("fifo", 1, 2);
    const auto level = make_level(g, 1, 10);
    CHECK(look_up(*level, g, 0, 0b0001) == 0b0001);
    CHECK(look_up(*level, g, 1, 0b0001) == 0b0001);
    CHECK(look_up(*level, g, 0, 0b0011) == 0b0010);
    CHECK(look_up(*level, g, 2, 0b0001) == 0b0001);
    CHECK(look_up(*level, g, 0, 0b0011) == 0b0011);  // had to go, with both sectors
}

TEST_CASE("the tree of four ways evicts as computed by hand") {
    TreePlruOrder order(2, 4);
    for (const std::uint64_t way : {0, 1, 2, 3}) order.use(1, way);
    CHECK(order.victim(1) == 0);
    order.use(1, 0);  // the root says right, where 3 was used last
    CHECK(victims(order, 1, 4) == Ways{2, 1, 3, 0});
    order.use(1, 0);
    order.use(1, 1);
    order.use(1, 0);  // 2 and 3 are both older than 1; of them 2
    CHECK(order.victim(1) == 2);
    CHECK(victims(order, 0, 4) == Ways{0, 2, 1, 3});  // another set knows nothing of it
}

TEST_CASE("the tree of a number of ways that is no power of two evicts as computed by hand") {
    TreePlruOrder three(1, 3);  // ((0 1) 2)
    CHECK(victims(three, 0, 8) == Ways{0, 2, 1, 2, 0, 2, 1, 2});
    TreePlruOrder five(1, 5);  // (((0 1) 2) (3 4))
    CHECK(victims(five, 0, 8) == Ways{0, 3, 2, 4, 1, 3, 2, 4});
    TreePlruOrder one(1, 1);
    CHECK(victims(one, 0, 2) == Ways{0, 0});
}

TEST_CASE("with two ways the tree is least recently used") {
    std::mt19937 random(1);
    std::vector<std::uint64_t> read(2000);
    for (auto& line : read) line = random() % 5;
    CHECK(outcomes(geometry("tree_plru", 1, 2), read) == outcomes(geometry("lru", 1, 2), read));
}

TEST_CASE("random victims are the same every time, differ by seed and set, and spread evenly") {
    RandomOrder order(3, 5, 1), again(3, 5, 1), other(3, 5, 2);
    const Ways first = victims(order, 1, 10000);
    CHECK(first == victims(again, 1, 10000));
    CHECK(first != victims(other, 1, 10000));
    CHECK(first != victims(order, 2, 10000));
    for (std::uint64_t way = 0; way < 5; ++way) {
        const auto count = std::count(first.begin(), first.end(), way);
        CHECK(std::abs(count - 2000) < 200);  // five standard deviations
    }
}

TEST_CASE("empty ways are taken before any line is evicted") {
    for (const std::string& policy : cache_policies())
        for (const std::uint64_t ways : {1, 3, 8, 11, 70})
            for (int round = 0; round < 2; ++round) {
                std::vector<std::uint64_t> read;
                for (int pass = 0; pass < 2; ++pass)
                    for (std::uint64_t line = 0; line < ways; ++line) read.push_back(line);
                CHECK(outcomes(geometry(policy, 1, ways), read) == std::string(ways, 'm') + std::string(ways, 'h'));
            }
}

TEST_CASE("every policy gives the answers of the naive cache, for any number of ways and every fill") {
    const std::vector<std::string> policies = cache_policies();
    const std::string policy = policies[GENERATE(range(0, 4))];
    const auto ways = GENERATE(1, 2, 3, 4, 5, 7, 8, 16, 17, 33, 64, 65, 100);
    const auto fill = GENERATE(0u, 32u, 64u, 128u);
    CacheGeometry g = geometry(policy, 3, static_cast<std::uint64_t>(ways));
    g.fill_bytes = fill;
    g.seed = 42;
    for (const InstructionSet instructions : instruction_sets()) {
        const auto level = make_level(g, 2, 2000, instructions);
        level->count_fills();
        std::vector<NaiveCache> naive{NaiveCache(g, 0), NaiveCache(g, 1)};
        std::mt19937 random(7);
        for (int i = 0; i < 3000; ++i) {
            const std::uint32_t line = random() % static_cast<unsigned>(3 * ways + ways / 2 + 2);
            const std::uint32_t sectors = 1 + random() % 15;
            const auto cache = static_cast<std::uint8_t>(random() % 2);
            std::set<unsigned> asked;
            for (unsigned s = 0; s < 4; ++s)
                if (sectors >> s & 1) asked.insert(s);
            std::uint32_t expected = 0;
            for (const unsigned s : naive[cache].look_up(line, asked).fetched) expected |= 1u << s;
            CAPTURE(policy, ways, fill, i);
            REQUIRE(look_up(*level, g, line, sectors, cache) == expected);
        }
        LineFills fills = naive[0].fills();
        fills += naive[1].fills();
        CHECK(level->fills() == fills);
    }
}
