// Speed-ups in two phases: cycles of few units, work of many.
#include "cachesim/analysis/double_sampling.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace raycache::cachesim;

namespace {

/// Of so many units the first n have cycles: work scatters by 10 %, time over work by 1 %; the second is 1.25 times
/// faster by work, 1.2 by time.
struct Drawn {
    TwoPhases base, own;
};
Drawn drawn(std::size_t n, std::size_t units, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Drawn all;
    for (std::size_t i = 0; i < units; ++i) {
        const double base = 100 + 10 * normal(random), own = 80 + 8 * normal(random);
        all.base.work.push_back(base);
        all.own.work.push_back(own);
        const double base_cycles = 3 * base * (1 + 0.01 * normal(random));
        const double own_cycles = 3 * own / 0.96 * (1 + 0.01 * normal(random));
        if (i >= n) continue;
        all.base.cycles.push_back(base_cycles);
        all.own.cycles.push_back(own_cycles);
    }
    return all;
}

}  // namespace

TEST_CASE("where all units have cycles, work is not asked for") {
    const Drawn d = drawn(8, 8, 1);
    const TwoPhaseSpeedUp s = two_phase_speed_up(d.base, d.own, 1.5);
    const std::vector<double> ones(8, 1.0);
    const Estimate plain = widened(ratio_to_baseline({d.base.cycles, ones}, {d.own.cycles, ones}), 1.5);
    CHECK(s.value.mean == Approx(plain.mean).epsilon(1e-12));
    CHECK(*s.value.half_width == Approx(*plain.half_width).epsilon(1e-12));
    Drawn nothing = d;
    for (double& w : nothing.base.work) w = 0;
    const TwoPhaseSpeedUp without = two_phase_speed_up(nothing.base, d.own, 1.5);
    CHECK(without.value.mean == Approx(plain.mean));
    CHECK(*without.value.half_width == Approx(*plain.half_width));
}

TEST_CASE("time that is work times a number takes its interval from work alone") {
    Drawn d = drawn(4, 64, 2);
    for (std::size_t i = 0; i < 4; ++i) {
        d.base.cycles[i] = 3 * d.base.work[i];
        d.own.cycles[i] = 4 * d.own.work[i];
    }
    const TwoPhaseSpeedUp s = two_phase_speed_up(d.base, d.own, 1);
    CHECK(s.difference.mean == Approx(0.75));
    CHECK(*s.difference.half_width == Approx(0).margin(1e-9));
    CHECK(s.value.mean == Approx(0.75 * s.by_work.mean));
    CHECK(*s.value.half_width > 0);
}

TEST_CASE("units that do not differ leave an interval of nothing, and one unit none") {
    const TwoPhases base{{300, 300}, {100, 100, 100}}, own{{200, 200}, {80, 80, 80}};
    const TwoPhaseSpeedUp s = two_phase_speed_up(base, own, 2);
    CHECK(s.value.mean == Approx(1.5));
    CHECK(*s.value.half_width == Approx(0).margin(1e-12));
    CHECK(expected_error(s, 2, 2, 2) == Approx(0).margin(1e-12));

    const TwoPhaseSpeedUp one = two_phase_speed_up({{300}, {100}}, {{200}, {80}}, 1);
    CHECK(one.value.mean == Approx(1.5));
    CHECK_FALSE(one.value.half_width);
    CHECK_FALSE(one.difference.half_width);
    CHECK(std::isinf(expected_error(one, 1, 8, 1)));
}

TEST_CASE("what more units bring is expected as it comes") {
    const Drawn d = drawn(8, 8, 3);
    const TwoPhaseSpeedUp s = two_phase_speed_up(d.base, d.own, 1);
    CHECK(expected_error(s, 8, 8, 1) == Approx(*s.value.half_width / s.value.mean).epsilon(1e-9));
    CHECK(expected_error(s, 8, 64, 1) < expected_error(s, 8, 16, 1));
    CHECK(expected_error(s, 16, 64, 1) < expected_error(s, 8, 64, 1));
    // Cycles scatter ten times as much as their quotient by work: work is worth most of the units.
    CHECK(expected_error(s, 8, 512, 1) < 0.4 * expected_error(s, 8, 8, 1));
}

TEST_CASE("intervals in two phases hold the value in 95 % of all cases") {
    constexpr int cases = 2000;
    for (const auto& [n, units] : {std::pair{4, 64}, std::pair{8, 32}, std::pair{8, 8}}) {
        int held = 0;
        double off = 0;
        for (std::uint32_t seed = 0; seed < cases; ++seed) {
            const Drawn d = drawn(static_cast<std::size_t>(n), static_cast<std::size_t>(units), 1000 + seed);
            const Estimate value = two_phase_speed_up(d.base, d.own, 1).value;
            held += std::fabs(value.mean - 1.2) <= *value.half_width;
            off += (value.mean / 1.2 - 1) / cases;
        }
        CAPTURE(n, units);
        CHECK(held > 0.92 * cases);
        CHECK(held < 0.98 * cases);
        CHECK(std::fabs(off) < 0.005);
    }
}
