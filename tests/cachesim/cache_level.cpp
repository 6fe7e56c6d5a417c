#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "cachesim/cache/policies/lru_avx512.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"
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

/// Ids of the first lines of the address space.
LineIds lines(std::uint32_t count) {
    return LineIds({{raycache::traces::ObjectKind::node, 0, 128, 128, count, 0, {}}}, 128);
}

/// The sectors that were missing.
std::uint32_t look_up(Level& level, std::uint64_t line, std::uint32_t sectors, std::uint32_t cache = 0) {
    Request request{line, sectors, 0, 0, 0};
    level.process({&request, 1}, cache);
    return request.sectors;
}

void fills_and_evicts_by_hand(Level&& level) {
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
    fills_and_evicts_by_hand(LevelWith<LruFewWays>(geometry(1, 2), 1, lines(10)));
    fills_and_evicts_by_hand(LevelWith<LruManyWays<std::uint32_t, std::uint16_t>>(geometry(1, 2), 1, lines(10)));
    fills_and_evicts_by_hand(LevelWith<LruManyWays<std::uint64_t, std::uint32_t>>(geometry(1, 2), 1, lines(10)));
    if (best_instruction_set() >= InstructionSet::avx512)
        fills_and_evicts_by_hand(std::move(*make_lru_avx512(geometry(1, 2), 1, lines(10))));
}

TEST_CASE("caches of a level share nothing") {
    const auto level = make_level(geometry(2, 2), 3, lines(100));
    CHECK(look_up(*level, 5, 1, 0) == 1);
    CHECK(look_up(*level, 5, 1, 2) == 1);
    CHECK(look_up(*level, 5, 1, 2) == 0);
    CHECK(look_up(*level, 5, 1, 1) == 1);
}

TEST_CASE("a batch is the same as one look-up after the other") {
    for (const InstructionSet instructions : instruction_sets()) {
        const auto one = make_level(geometry(3, 5), 4, lines(200), instructions);
        const auto batch = make_level(geometry(3, 5), 4, lines(200), instructions);
        std::mt19937 random(3);
        std::vector<Request> requests(1000);
        std::vector<std::uint32_t> expected;
        for (Request& r : requests) {
            r.line = random() % 200;
            r.sectors = 1 + random() % 15;
            r.cache = random() % 2;
            expected.push_back(look_up(*one, r.line, r.sectors, 2 + r.cache));
        }
        batch->process(requests, 2);
        for (std::size_t i = 0; i < expected.size(); ++i) CHECK(requests[i].sectors == expected[i]);
    }
}

TEST_CASE("with the same sets, more ways never miss more under LRU") {
    std::mt19937 random(9);
    std::vector<Request> requests(20000);
    for (Request& r : requests) {
        r.line = random() % (random() % 2 ? 40 : 600);
        r.sectors = 1u << random() % 4;
    }
    std::size_t before = requests.size();
    for (const std::uint64_t ways : {1, 2, 3, 4, 6, 8, 12, 16, 33, 64, 65, 128, 300}) {
        std::vector<Request> answers = requests;
        make_level(geometry(4, ways), 1, lines(600))->process(answers, 0);
        const auto count = static_cast<std::size_t>(
            std::count_if(answers.begin(), answers.end(), [](const Request& r) { return r.sectors != 0; }));
        CAPTURE(ways);
        CHECK(count <= before);
        before = count;
    }
}

TEST_CASE("an unknown replacement policy is refused by name") {
    CacheGeometry g = geometry(1, 1);
    g.policy = "clairvoyant";
    CHECK_THROWS_WITH(make_level(g, 1, lines(1)), Catch::Contains("lru") && Catch::Contains("clairvoyant"));
}
