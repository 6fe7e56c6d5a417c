#include <catch2/catch.hpp>
#include <random>

#include "cachesim/cache/policies/lru.hpp"
#include "cachesim/cache/registry.hpp"
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

/// The sectors that were missing.
std::uint32_t look_up(Level& level, std::uint64_t line, std::uint32_t sectors, std::uint16_t cache = 0) {
    const Request request{line, static_cast<std::uint32_t>(line), sectors, cache, 0};
    Request miss;
    return level.process({&request, 1}, &miss) ? miss.sectors : 0;
}

template <class Policy>
void fills_and_evicts_by_hand() {
    LevelWith<Policy> level(geometry(1, 2), 1);
    CHECK(look_up(level, 0, 0b0011) == 0b0011);  // a miss fetches what is wanted
    CHECK(look_up(level, 0, 0b0011) == 0);
    CHECK(look_up(level, 0, 0b1110) == 0b1100);  // a sector miss fetches what is missing
    CHECK(look_up(level, 0, 0b1111) == 0);
    CHECK(look_up(level, 7, 0b0001) == 0b0001);
    CHECK(look_up(level, 0, 0b0001) == 0);       // 7 is now the older
    CHECK(look_up(level, 9, 0b0001) == 0b0001);  // evicts 7
    CHECK(look_up(level, 0, 0b1111) == 0);
    CHECK(look_up(level, 7, 0b0001) == 0b0001);  // evicts 9
    CHECK(look_up(level, 9, 0b0001) == 0b0001);  // evicts 0 with all its sectors
    CHECK(look_up(level, 0, 0b1000) == 0b1000);
    CHECK(look_up(level, 0, 0b0001) == 0b0001);
}

}  // namespace

TEST_CASE("a tiny cache fills and evicts as computed by hand") {
    fills_and_evicts_by_hand<LruFewWays>();
    fills_and_evicts_by_hand<LruManyWays>();
}

TEST_CASE("caches of a level share nothing") {
    const auto level = make_level(geometry(2, 2), 3, 100);
    CHECK(look_up(*level, 5, 1, 0) == 1);
    CHECK(look_up(*level, 5, 1, 2) == 1);
    CHECK(look_up(*level, 5, 1, 2) == 0);
    CHECK(look_up(*level, 5, 1, 1) == 1);
}

TEST_CASE("a batch is the same as one look-up after the other, also in place") {
    const auto one = make_level(geometry(3, 5), 2, 200), batch = make_level(geometry(3, 5), 2, 200);
    std::mt19937 random(3);
    std::vector<Request> requests(1000), expected;
    for (Request& r : requests) {
        r.line = r.id = random() % 200;
        r.sectors = 1 + random() % 15;
        r.cache = random() % 2;
    }
    for (const Request& r : requests)
        if (const std::uint32_t missing = look_up(*one, r.line, r.sectors, r.cache))
            expected.push_back({r.line, r.id, missing, r.cache, 0});
    requests.resize(batch->process(requests, requests.data()));
    REQUIRE(requests.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(requests[i].line == expected[i].line);
        CHECK(requests[i].sectors == expected[i].sectors);
    }
}

TEST_CASE("with the same sets, more ways never miss more under LRU") {
    std::mt19937 random(9);
    std::vector<Request> requests(20000);
    for (Request& r : requests) {
        r.line = r.id = random() % (random() % 2 ? 40 : 600);
        r.sectors = 1u << random() % 4;
    }
    std::size_t before = requests.size();
    for (const std::uint64_t ways : {1, 2, 3, 4, 6, 8, 12, 16, 33, 64, 65, 128, 300}) {
        std::vector<Request> misses(requests.size());
        const std::size_t count = make_level(geometry(4, ways), 1, 600)->process(requests, misses.data());
        CAPTURE(ways);
        CHECK(count <= before);
        before = count;
    }
}

TEST_CASE("the set is the documented one for every number of sets and every line") {
    std::mt19937_64 random(5);
    for (const std::uint64_t sets :
         {1ull, 2ull, 3ull, 4ull, 36ull, 48ull, 80ull, 1536ull, 20480ull, 65536ull, (1ull << 32) - 5, (1ull << 33)})
        for (const auto index : {SetIndex::modulo, SetIndex::xor_fold}) {
            const SetIndexer indexer(sets, index);
            CacheGeometry g = geometry(sets, 1, index);
            for (int i = 0; i < 300; ++i) {
                const std::uint64_t line = random() >> random() % 64;
                REQUIRE(indexer(line) == naive_set(g, line));
            }
            for (const std::uint64_t line : {std::uint64_t{0}, sets - 1, sets, ~std::uint64_t{0}})
                REQUIRE(indexer(line) == naive_set(g, line));
        }
}

TEST_CASE("the folded index spreads lines of equal low bits over all sets") {
    const SetIndexer fold(64, SetIndex::xor_fold), modulo(64, SetIndex::modulo);
    std::vector<int> uses(64);
    for (std::uint64_t i = 0; i < 64; ++i) {
        ++uses[fold(i * 64)];
        CHECK(modulo(i * 64) == 0);
    }
    CHECK(std::all_of(uses.begin(), uses.end(), [](int n) { return n == 1; }));
}

TEST_CASE("an unknown replacement policy is refused by name") {
    CacheGeometry g = geometry(1, 1);
    g.policy = "clairvoyant";
    CHECK_THROWS_WITH(make_level(g, 1, 1), Catch::Contains("lru") && Catch::Contains("clairvoyant"));
}
