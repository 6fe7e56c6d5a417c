// What is said of a predicted speed-up.
#include "cachesim/report/speed_up_text.hpp"

#include <catch2/catch.hpp>

using namespace raycache::cachesim;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

/// Of two launches; half the slots taken.
TimedStatistics times(std::uint64_t cycles, std::uint64_t warp_accesses, std::uint64_t l1_misses) {
    TimedStatistics t;
    t.cycles = cycles;
    t.rays = 100;
    t.lane_accesses = 3000;
    t.warp_accesses = warp_accesses;
    t.levels[0].line_misses = l1_misses;
    t.dram_sectors = l1_misses / 2;
    t.warp_slots = 10;
    t.warp_cycles = cycles * 8;
    return t;
}

std::vector<SpeedUp> of(const TimedStatistics& base, const TimedStatistics& other, double perfect) {
    std::vector<SpeedUp> all;
    for (const NamedIdeal& ideal : idealised_replays()) {
        SpeedUp s{ideal, base, other, {}, {}};
        const double gain =
            all.size() == 1 ? perfect * static_cast<double>(other.cycles) : static_cast<double>(base.cycles);
        s.base_cycles = {gain / 2, gain / 2};
        s.other_cycles = {static_cast<double>(other.cycles) / 2, static_cast<double>(other.cycles) / 2};
        all.push_back(s);
    }
    return all;
}

}  // namespace

TEST_CASE("a speed-up is work or divergence as far as perfect caches leave it, and locality where traffic falls") {
    const std::string text = sentence(of(times(1500, 200, 800), times(1000, 100, 400), 1.2));
    CHECK_THAT(
        text,
        StartsWith("1.50x ±0.00 predicted; 1.20x ±0.00 would remain with perfect caches (fewer divergent steps); the "
                   "other 1.25x ±0.00 is locality: L1-to-L2 traffic per ray is 50 % lower"));
    CHECK_THAT(text, EndsWith("DRAM traffic 50 % lower."));
}

TEST_CASE("what the caches add against the traffic is not called locality") {
    CHECK_THAT(sentence(of(times(1500, 100, 400), times(1000, 100, 800), 1.2)), Contains("1.25x ±0.00 is no locality"));
    CHECK_THAT(sentence(of(times(1100, 100, 400), times(1000, 100, 800), 1.3)),
               Contains("more traffic takes 1.18x ±0.00 of it back: L1-to-L2 traffic per ray is 100 % higher"));
    CHECK_THAT(sentence(of(times(1300, 100, 400), times(1000, 100, 400), 1.3)),
               Contains("the caches add nothing to it: L1-to-L2 traffic per ray is unchanged"));
}

TEST_CASE("a speed-up of launches that disagree comes with its interval, and may be none") {
    auto all = of(times(1000, 100, 400), times(1000, 100, 400), 1);
    all[0].base_cycles = {600, 400};
    all[0].other_cycles = {400, 600};
    const Estimate value = all[0].value();
    REQUIRE(value.half_width);
    CHECK(*value.half_width > 0.1);
    CHECK_THAT(sentence(all), Contains("so no certain difference in time"));
    all[0].base_cycles = {1000};
    all[0].other_cycles = {500};
    CHECK_FALSE(all[0].value().half_width);
    CHECK_THAT(sentence(all), StartsWith("2.00x predicted; "));
}

TEST_CASE("times of a GPU that is mostly empty are said to be those of the longest warps") {
    TimedStatistics few = times(1000, 100, 400);
    few.warp_cycles = few.cycles * 3;
    CHECK_THAT(sentence(of(few, few, 1)),
               EndsWith("The warps take only 30 % of the GPU's slots on average: these cycles are "
                        "those of the longest warps and no statement on throughput."));
    CHECK(few.occupancy() == 0.3);
    CHECK(sentence(of(times(10, 0, 0), times(10, 0, 0), 1)) == "No speed-up to predict: a trace has no accesses.");
}

TEST_CASE("what remains of a speed-up is put down to what points its way, and its parts have intervals") {
    // With perfect caches slower, although warps diverge less: more work, of which there is enough.
    TimedStatistics more_work = times(1000, 90, 400);
    more_work.lane_accesses = 4000;
    CHECK_THAT(sentence(of(times(1000, 100, 400), more_work, 0.8)), Contains("(more work per ray)"));
    CHECK_THAT(sentence(of(times(1000, 100, 400), times(1000, 100, 400), 0.8)), Contains("neither work nor SIMT"));

    auto all = of(times(1500, 200, 800), times(1000, 100, 400), 1.2);
    all[0].base_cycles = {800, 700};
    const Estimate part = locality_part(all);
    CHECK(part.mean == Approx(1.25));
    REQUIRE(part.half_width);
    CHECK(*part.half_width > 0.05);
    CHECK_THAT(sentence(all), Contains("what the caches add, 1.25x ±"));
    CHECK(all[0].value().mean == Approx(part.mean * all[1].value().mean).epsilon(1e-12));
    SpeedUp modelled = all[0], ideal = all[1];
    modelled.base_cycles = modelled.other_cycles = {200, 300};
    ideal.base_cycles = {100, 150};
    ideal.other_cycles = {100, 200};
    CHECK(ideal.base_gain(modelled).mean == 2);
    CHECK(*ideal.base_gain(modelled).half_width == Approx(0).margin(1e-12));
    const double width = *ideal.other_gain(modelled).half_width;
    CHECK(width > 0.1);
    ideal.widening = 1.5;
    CHECK(*ideal.other_gain(modelled).half_width == Approx(1.5 * width));
}
