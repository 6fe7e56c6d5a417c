// What is written in vectors, on every instruction set of this machine, against the same without vectors. Caches,
// coalescing and whole replays: cache_level.cpp, policies.cpp, coalesce.cpp, replay_oracle.cpp.
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "cachesim/cache/lookups.hpp"
#include "cachesim/frontend/distinct.hpp"
#include "cachesim/replay/quick_check.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

TEST_CASE("every instruction set of the machine has a name of its own, and the best is one of them") {
    const auto sets = instruction_sets();
    std::set<std::string> names;
    for (const InstructionSet set : sets) CHECK(names.insert(name_of(set)).second);
    CHECK(names.contains("scalar"));
    CHECK(sets.size() > 1);  // x86-64-v2 has SSE4, every 64-bit ARM has Neon
    CHECK(names.contains(name_of(best_instruction_set())));
}

TEST_CASE("every instruction set keeps the look-ups that fetched something, in their order") {
    std::mt19937 random(3);
    for (const InstructionSet set : instruction_sets())
        for (std::size_t count = 0; count < 70; ++count) {
            CAPTURE(name_of(set), count);
            Lookups lookups;
            lookups.reserve(count);
            std::vector<std::array<std::uint32_t, 3>> expected;
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t line = random(), sectors = random() % 3, access = random();
                lookups.add(line, sectors, access);
                if (sectors) expected.push_back({line, sectors, access});
            }
            lookups.drop_answered(set);
            REQUIRE(lookups.count == expected.size());
            for (std::size_t i = 0; i < expected.size(); ++i)
                REQUIRE(std::array{lookups.lines[i], lookups.sectors[i], lookups.accesses[i]} == expected[i]);
        }
}

TEST_CASE("every instruction set counts as many distinct elements") {
    std::mt19937 random(4);
    for (unsigned count = 1; count <= traces::warp_lanes; ++count)
        for (int round = 0; round < 50; ++round) {
            std::vector<std::uint32_t> elements(count);  // no more than there are: reading beyond is seen by sanitizers
            for (auto& e : elements) e = random() % (round % 2 ? 6u : 1000u) << (round % 3 * 6);
            const auto expected = std::set(elements.begin(), elements.end()).size();
            for (const InstructionSet set : instruction_sets()) {
                CAPTURE(name_of(set), count);
                REQUIRE(count_distinct(set)(elements.data(), count) == expected);
            }
        }
}

TEST_CASE("every instruction set finds the one element that its region does not have") {
    std::mt19937 random(5);
    const auto launch = random_launch({region(traces::ObjectKind::node, 0, 64, 64, 1000),
                                       region(traces::ObjectKind::triangle, 1 << 20, 48, 48, 0xffffffff)},
                                      20, 12, 7);
    for (const InstructionSet set : instruction_sets()) {
        IsRight* const is_right = quick_check(set);
        CHECK((is_right == nullptr) == (set == InstructionSet::scalar));
        if (!is_right) continue;
        CAPTURE(name_of(set));
        for (const auto& warp : launch.warps) {
            REQUIRE(is_right(*warp, launch.regions));
            traces::WarpTrace wrong = *warp;
            std::size_t next = 0;
            for (const traces::Record& record : warp->records) {
                if (!record.is_access()) continue;
                const std::size_t at = next + random() % record.lanes();
                const std::uint32_t before = wrong.elements[at];
                wrong.elements[at] = launch.regions[record.region].count;
                REQUIRE(!is_right(wrong, launch.regions));
                wrong.elements[at] = before;
                next += record.lanes();
            }
            wrong.elements.push_back(0);
            REQUIRE(!is_right(wrong, launch.regions));
        }
    }
}
