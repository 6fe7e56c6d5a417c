// The time left of a command, against commands whose end is known: a clock that the test turns.
#include "tools/program/time_left.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

using namespace raycache::tools;

namespace {

/// A stage as it will turn out to be.
struct TrueStage {
    Work work;
    double expected, seconds;
    double first_half = 0.5;  ///< the share of its time that the first half of its work takes
};

double done_of(const TrueStage& stage, double seconds) {
    const double half = stage.first_half * stage.seconds;
    return seconds < half ? 0.5 * seconds / half : 0.5 + 0.5 * (seconds - half) / (stage.seconds - half);
}

/// What Progress knows after so many seconds.
std::vector<StageState> states_at(const std::vector<TrueStage>& stages, double now) {
    std::vector<StageState> states;
    double begin = 0;
    for (const TrueStage& stage : stages) {
        const double spent = std::clamp(now - begin, 0.0, stage.seconds);
        const bool over = now >= begin + stage.seconds, running = !over && now >= begin;
        double done = over ? 1 : running ? done_of(stage, spent) : 0;
        if (stage.work == Work::prepare && !over) done = 0;
        states.push_back({stage.work, stage.expected, done, spent, running});
        begin += stage.seconds;
    }
    return states;
}

/// The worst ratio, one way or the other, of the time said and the time that is left, from a tenth of the time to nine
/// tenths: nearer to the end both are next to nothing.
double worst_ratio(const std::vector<TrueStage>& stages) {
    double total = 0, worst = 1;
    for (const TrueStage& stage : stages) total += stage.seconds;
    for (double share = 0.1; share < 0.9; share += 0.01) {
        const double left = total * (1 - share), said = time_left(states_at(stages, total * share));
        worst = std::max({worst, said / left, left / said});
    }
    return worst;
}

std::vector<TrueStage> quality_on(double machine, double scene_renders, double scene_replays) {
    return {{Work::prepare, 1, 1 * machine},
            {Work::render, 40, 40 * machine * scene_renders},
            {Work::render, 10, 10 * machine * scene_renders},
            {Work::timed_replay, 30, 30 * machine * scene_replays},
            {Work::render, 8, 8 * machine * scene_renders}};
}

}  // namespace

TEST_CASE("the time left is right where everything goes as expected") {
    CHECK(worst_ratio({{Work::trace, 10, 10}}) < 1.001);
    CHECK(worst_ratio(quality_on(1, 1, 1)) < 1.001);
    CHECK(time_left({}) == 0);
    CHECK(time_left(states_at(quality_on(1, 1, 1), 1000)) == 0);
    CHECK(time_left(states_at(quality_on(1, 1, 1), 0)) == Approx(89));
}

TEST_CASE("after a tenth of the work the time left is within a factor of two on machines of any speed") {
    for (const double machine : {0.01, 0.1, 0.5, 3.0, 20.0, 500.0}) {
        INFO(machine);
        CHECK(worst_ratio({{Work::prepare, 1, 1 * machine}, {Work::replay, 50, 50 * machine}}) < 2);
        CHECK(worst_ratio(quality_on(machine, 1, 1)) < 2);
    }
}

TEST_CASE("and of scenes that make one kind of work up to twice as dear as another") {
    for (const double renders : {0.7, 1.0, 1.4})
        for (const double replays : {0.7, 1.0, 1.4}) {
            INFO(renders << " " << replays);
            CHECK(worst_ratio(quality_on(4, renders, replays)) < 2);
        }
}

TEST_CASE("a picture whose first half is the cheaper one does not mislead by more than that") {
    CHECK(worst_ratio({{Work::render, 10, 10, 0.4}}) < 2);
    CHECK(worst_ratio({{Work::render, 10, 10, 0.6}}) < 2);
}

TEST_CASE("a scene that takes long to load is said to take half as long again") {
    const std::vector<TrueStage> stages{{Work::prepare, 1, 60}, {Work::trace, 5, 5}};
    CHECK(time_left(states_at(stages, 40)) == Approx(20 + 5));
    CHECK(time_left(states_at(stages, 0.4)) == Approx(0.6 + 5));
    CHECK(time_left(states_at(stages, 62.5)) == Approx(2.5));  // and its pace says nothing of the tracing
}

TEST_CASE("work that shows nothing for long is believed to take as long as expected, then half as long again") {
    CHECK(time_left(std::vector<StageState>{{Work::timed_replay, 10, 0, 4, true}}) == Approx(6));
    CHECK(time_left(std::vector<StageState>{{Work::timed_replay, 10, 0, 30, true}}) == Approx(15));
    CHECK(time_left(std::vector<StageState>{{Work::timed_replay, 10, 0.5, 30, true}}) == Approx(30));
}

TEST_CASE("a stage that turns out not to be needed takes no time") {
    std::vector<StageState> states{{Work::render, 0, 0, 0, false}, {Work::render, 10, 0, 0, false}};
    CHECK(time_left(states) == Approx(10));
    states[0].done = 1;
    CHECK(time_left(states) == Approx(10));
}
