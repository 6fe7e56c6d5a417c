#include "tools/jobs/windows/stop_rule.hpp"

#include <catch2/catch.hpp>

using namespace raycache;
using tools::Predicted;
using tools::worst_error;

namespace {

/// Two blocks of one strategy: 1000 rays, a million sectors asked of L1, so many fetched by L1 and by L2.
cachesim::Series series(const std::string& strategy, std::uint64_t l2_a, std::uint64_t l2_b, std::uint64_t dram_a,
                        std::uint64_t dram_b) {
    cachesim::Series s;
    s.strategy = strategy;
    s.thread_map = "tile";
    s.caches = {2, 32};
    s.windows.emplace();
    for (const auto& [l2, dram] : {std::pair{l2_a, dram_a}, std::pair{l2_b, dram_b}}) {
        cachesim::RayGroup group;
        group.rays = 1000;
        cachesim::Counters& c = group.by_kind[0];
        c.steps = c.lane_accesses = c.warp_accesses = 100000;
        c.requests = 1000000;
        c.levels[0] = {1000000, 1000000 - l2};
        c.levels[1] = {l2, l2 - dram};
        c.dram_sectors = dram;
        s.launches.push_back({static_cast<std::uint32_t>(s.launches.size()), {group}});
    }
    return s;
}

}  // namespace

TEST_CASE("an estimate is as uncertain as its widest ratio") {
    const Predicted now{{}, {series("a", 200000, 200000, 50000, 50000), series("b", 100000, 110000, 20000, 40000)}};
    const tools::Worst worst = worst_error(now, "a");
    CHECK(worst.of.starts_with("DRAM"));
    // 12.706 (Student t, one degree of freedom) * 10000 / 30000
    CHECK(worst.error == Approx(12.7062 / 3).epsilon(1e-4));
}

TEST_CASE("bytes that are next to nothing are not waited for") {
    const Predicted little{{}, {series("a", 200000, 200000, 9000, 5000), series("b", 100000, 110000, 1000, 9000)}};
    CHECK(worst_error(little, "a").of.starts_with("L2"));
    // Much of one strategy and little of the other is a difference that matters.
    const Predicted much{{}, {series("a", 200000, 200000, 90000, 50000), series("b", 100000, 110000, 1000, 9000)}};
    CHECK(worst_error(much, "a").of.starts_with("DRAM"));
    const Predicted none{{}, {series("a", 9000, 1000, 10, 0), series("b", 1000, 9000, 0, 10)}};
    CHECK(worst_error(none, "a").error == 0);
}

TEST_CASE("DRAM bytes are not waited for where the scene fits in the last cache") {
    Predicted now{{}, {series("a", 200000, 200000, 90000, 50000), series("b", 100000, 110000, 20000, 40000)}};
    for (cachesim::Series& s : now.traffic) s.windows->last_cache_full = false;
    CHECK(worst_error(now, "a").of.starts_with("L2"));
}

TEST_CASE("a ratio of exactly 0 in every block is certain, and nothing more is waited for") {
    const Predicted now{{}, {series("a", 200000, 200000, 90000, 90000), series("b", 100000, 100000, 0, 0)}};
    CHECK(worst_error(now, "a").error == 0);
}
