// Every level of tools/bench/tradeoff on a picture of a moment, where what the levels have to agree in is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "small_jobs.hpp"
#include "tools/bench/tradeoff/ladder.hpp"

using namespace raycache;

namespace {

bench::Ladder climb(const std::vector<std::string>& strategies) {
    bench::LadderSettings settings;
    settings.launches = test::small_launches(strategies);
    settings.launches.sampling.bounces = 1;
    settings.gpu.names = {"rtx-3070"};
    settings.gpu.changes = {"sms=1", "warps_per_cta=2", "max_warps_per_sm=8", "l2.ways=1"};
    settings.sizes.indices = 1;
    settings.sizes.work_groups = settings.sizes.sm_windows = 8;
    settings.sizes.windows = settings.sizes.timed_windows = 2;
    settings.drawings = 1;
    settings.most_blocks = 8;
    settings.targets = {1e9};  // whatever comes
    test::Listener listener;
    return bench::climb(settings, listener);
}

}  // namespace

TEST_CASE("the ladder: every level answers, and equal strategies get equal answers from each") {
    const bench::Ladder ladder = climb({"micro-jitter", "micro-jitter"});
    std::map<std::string, const bench::LevelResult*> levels;
    for (const bench::LevelResult& level : ladder.levels) {
        levels[level.level] = &level;
        INFO(level.level);
        REQUIRE(level.answers.size() == 2);
        CHECK(level.seconds > 0);
        CHECK(level.answers[0].cycles_per_ray == level.answers[1].cycles_per_ray);
        CHECK(level.answers[0].l2_bytes_per_ray == level.answers[1].l2_bytes_per_ray);
        CHECK(level.answers[0].dram_bytes_per_ray == level.answers[1].dram_bytes_per_ray);
    }
    REQUIRE(levels.size() == 6);
    const auto first = [&](const char* level) { return levels.at(level)->answers[0]; };
    // No roofline is above what all latencies take.
    CHECK(first("timed exact").cycles_per_ray > first("functional exact").cycles_per_ray);
    // An L1 of the RTX 3070 is nearly fully associative; its warps run in waves there, one after the other.
    CHECK(std::fabs(first("reuse distances").l1_hit_rate - first("functional exact").l1_hit_rate) < 0.05);
    CHECK(first("functional windows").l2_bytes_per_ray ==
          Approx(first("functional exact").l2_bytes_per_ray).epsilon(0.5));
}
